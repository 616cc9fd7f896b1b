//! Opens the file of a run that was killed or stopped, so that the run goes on.

use super::PLASTIC;
use super::checkpoints;
use super::file::{HistoryFile, Identity};
use super::open::contents;
use super::rows::Places;
use super::stored_part::StoredPart;
use super::writer::{Begun, Target, Writer};
use crate::create::reserve;
use crate::error::{FileCause, FileError};
use crate::lock::LockedFile;
use crate::read::{Data, Opened};
use crate::write::Provenance;
use percute_core::history::Checkpoint;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_system::{occupied, write_all_at};
use std::fs::File;

/// A history to which its run goes on to add steps.
#[derive(Debug)]
pub struct Unended {
    /// The state from which the run goes on; without one, it begins again at its first step.
    pub checkpoint: Option<Checkpoint>,
    /// Writes the steps after it.
    pub writer: Writer,
}

impl HistoryFile {
    /// All planned instants of the run (s), those that a thinned history does not keep included.
    #[must_use]
    pub fn run_times(&self) -> &TimeGrid {
        self.thinned_steps().map_or(self.times(), |kept| &kept.times)
    }

    /// Whether the file holds all that its run was to give.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.is_complete() && self.count() == self.times().instants().len()
    }

    /// The part of the run that the file keeps; none for one with all steps and without velocities and accelerations.
    #[must_use]
    pub fn keeps(&self) -> Option<StoredPart> {
        let [velocity, acceleration] = self.stored();
        let whole = self.thinned_steps().is_none() && !self.lacks_reactions();
        let all = || (0..self.times().instants().len()).collect();
        let steps = || self.thinned_steps().map_or_else(all, |kept| kept.steps.clone());
        let reaction = !self.lacks_reactions();
        (!whole || velocity || acceleration).then(|| StoredPart { steps: steps(), velocity, acceleration, reaction })
    }

    /// Number of instants in a file with all steps of the run until this one.
    fn rows_until(&self, step: usize) -> usize {
        self.thinned_steps().map_or(step + 1, |kept| kept.steps.partition_point(|kept| *kept <= step))
    }

    /// Lets the run of this problem go on, after it was killed or stopped. Other writers are refused from then on;
    /// readers see the steps written so far.
    ///
    /// # Errors
    /// A file of another program, version or machine, whose numbers would be others, or one with velocities and
    /// accelerations of its own; one without checksums, or that is damaged; one that is being written or cannot be
    /// written to; a disk without enough space.
    pub fn resume(&self, problem: &AnyProblem) -> Result<Unended, FileError> {
        self.go_on(problem).map_err(|cause| cause.at(self.path()))
    }

    fn go_on(&self, problem: &AnyProblem) -> Result<Unended, FileCause> {
        let (writer, here) = (self.provenance(), Provenance::here());
        if *writer != here {
            let told = |by: &Provenance| format!("{} on {} {}", by.program, by.architecture, by.system);
            return Err(FileCause::Other { written: told(writer), here: told(&here) });
        }
        if self.is_foreign() {
            return Err(FileCause::Elsewhere);
        }
        if self.supplied() != [false; 2] {
            return Err(FileCause::GivenMotion);
        }
        if !self.has_checksums() {
            return Err(FileCause::Unsummed);
        }
        let path = self.path();
        let create = |source| FileCause::Create { source };
        let lock = LockedFile::alone(File::options().read(true).write(true).open(path).map_err(create)?)?.share()?;
        // Another run may have gone on with the file since it was opened.
        let opened = Opened::new(path)?;
        let now: Self = contents(path, Identity::of(path)?, &opened)?;
        let places = now.places(&opened, problem)?;
        let fits = |step: usize| step <= now.run_times().step_count() && now.rows_until(step) <= now.count();
        let checkpoint = checkpoints::newest(&opened.root().group("percute")?, now.checkpoint_fields(), fits)?;
        let bytes = opened.bytes();
        drop(opened);
        let next = checkpoint.as_ref().map_or(0, |checkpoint: &Checkpoint| checkpoint.step + 1);
        let stored = next.checked_sub(1).map_or(0, |step| now.rows_until(step));
        now.check_rows(stored).map_err(|error| error.cause)?;
        let missing = bytes.saturating_sub(occupied(lock.file()));
        reserve(lock.file(), path, bytes).map_err(|cause| match cause {
            FileCause::NoSpace { free, .. } => FileCause::NoSpace { needed: missing, free },
            other => other,
        })?;
        write_all_at(lock.file(), &[0], places.complete).map_err(create)?;
        let (kept, supplied) = (now.keeps(), now.stored());
        let begun = Begun { last: now.run_times().step_count(), next, stored, supplied, kept };
        Ok(Unended {
            checkpoint,
            writer: Writer::new(Target::Named(lock, path.to_path_buf()), places, begun).map_err(create)?,
        })
    }

    /// Nodes, dimension and number of internal variables.
    fn checkpoint_fields(&self) -> [usize; 3] {
        let elements = self.mesh().element_count();
        [self.mesh().node_count(), self.dimension(), self.contents.plastic * elements]
    }

    /// Compares the first instants with their checksums: damage there would stay.
    fn check_rows(&self, count: usize) -> Result<(), FileError> {
        for steps in self.blocks(count) {
            self.displacement(steps.clone())?;
            self.velocity(steps.clone())?;
            self.acceleration(steps.clone())?;
            self.reaction(steps.clone())?;
            self.plastic(steps.clone())?;
            self.touching(steps)?;
        }
        Ok(())
    }

    /// The places of all that a run writes.
    fn places(&self, opened: &Opened, problem: &AnyProblem) -> Result<Places, FileCause> {
        let root = opened.root();
        let (ours, fields) = (root.group("percute")?, root.group("VTKHDF")?.group("PointData")?);
        let [velocity, acceleration] = ["velocity", "acceleration"].map(|name| fields.optional(name));
        let nodal = |data: Option<Data<'_>>| data.map(|data| place(data.native_offset::<f64>()?, &data)).transpose();
        let displacement = fields.data("displacement")?;
        let contact = ours.optional_group("contact")?;
        let of_contact = |name: &str| contact.as_ref().map(|contact| contact.data(name)).transpose();
        let reaction = of_contact("reaction")?.map(|data| place(data.native_offset::<f64>()?, &data)).transpose()?;
        let touching = of_contact("touching")?.map(|data| place(data.native_offset::<u8>()?, &data)).transpose()?;
        let counter = ours.data("steps_written")?;
        let (complete, checksums) = (ours.data("complete")?, ours.data("checksums")?);
        let of_elements = root.group("VTKHDF")?.optional_group("CellData")?;
        let of_elements = of_elements.map(|fields| fields.optional(PLASTIC)).transpose()?.flatten();
        let [.., internal] = self.checkpoint_fields();
        let of_elements = of_elements.map(|data| place(data.native_offset::<f64>()?, &data)).transpose()?;
        Ok(Places {
            displacement: place(displacement.native_offset::<f64>()?, &displacement)?,
            velocity: nodal(velocity?)?,
            acceleration: nodal(acceleration?)?,
            reaction: reaction.unwrap_or_default(),
            touching: touching.unwrap_or_default(),
            plastic: of_elements.map(|place| (place, internal)),
            steps_written: place(counter.native_offset::<i64>()?, &counter)?,
            complete: place(complete.native_offset::<u8>()?, &complete)?,
            checksums: place(checksums.native_offset::<i64>()?, &checksums)?,
            checkpoints: checkpoints::places(&ours)?,
            dimension: self.dimension(),
            nodes: self.mesh().node_count(),
            contact_nodes: problem.contact_nodes().len(),
            has_contact: contact.is_some(),
            had: self.count(),
        })
    }
}

/// The place of an array, which must be as percute writes it.
fn place(offset: Option<u64>, data: &Data<'_>) -> Result<u64, FileCause> {
    let given = || "numbers in pieces or of another type".to_string();
    let needed = "numbers in one piece, as percute writes them";
    offset.ok_or_else(|| FileCause::Type { name: data.name.clone(), given: given(), needed })
}
