//! Runs that were killed or stopped, and go on from their histories.

mod difference;

use crate::case::{CaseOf, statement};
use crate::failure::Failure;
use crate::history::Stored;
use crate::numbering::Ordered;
use crate::storing::{Outcome, Storage, drive};
use percute_core::dynamics::Simulation;
use percute_core::history::Discard;
use percute_core::mesh::Mesh;
use percute_core::observer::Observer;
use percute_core::simplex::{Element, Simplex};
use percute_core::time::TimeGrid;
use percute_io::history::{HistoryFile, Kept, Unended};
use std::any::Any;
use std::path::Path;

impl<const D: usize, const N: usize> Stored<D, N>
where
    Element<D, N>: Simplex<D, N>,
{
    /// Opens the history of the run of a case, which is to go on; `estimated` if the error is estimated then.
    ///
    /// # Errors
    /// As [`open`](crate::history::open), and the history of another case.
    pub fn of_case(case: &CaseOf<D, N>, file: &Path, estimated: bool) -> Result<Self, Failure> {
        let stored = Self::new(HistoryFile::of(file)?, file)?;
        match stored.difference(case, estimated)? {
            None => Ok(stored),
            Some(what) => Err(Failure::Argument(format!(
                "--resume: {} is the history of another case: {what}; give that case, another file, or --force without \
                 --resume to begin again",
                file.display()
            ))),
        }
    }

    /// The first difference between the run of this history and that of a case.
    fn difference(&self, case: &CaseOf<D, N>, estimated: bool) -> Result<Option<String>, Failure> {
        let (file, times) = (&self.file, self.file.run_times());
        let problem = &case.problem;
        let kept = |kept: Option<Kept>| {
            let kept = kept.unwrap_or_else(|| all(times));
            let reaction = kept.reaction || problem.surface().nodes().is_empty();
            Kept { reaction, ..kept }
        };
        let same_start = file.initial_displacement() == problem.initial_displacement()
            && file.initial_velocity() == problem.initial_velocity();
        let stated = difference::of_statements(&statement(problem, Some(&case.options))?, file.statement(), estimated);
        let differs = if file.is_foreign() {
            Some("another program has simulated it")
        } else if !same_mesh(problem.mesh(), file.mesh()) {
            Some("its mesh differs")
        } else if !same_start {
            Some("its initial displacement or velocity differs")
        } else if stated.is_some() {
            return Ok(stated);
        } else if !self.same_time(case) {
            Some("its end or its steps differ")
        } else if kept(case.output.keep.of(times)) != kept(file.keeps()) {
            Some("`every`, `times` or `fields` of its [output] differ")
        } else {
            None
        };
        Ok(differs.map(str::to_string))
    }

    /// Whether the case asks for the instants of the file. Those of a run that ends with the rebound follow from its
    /// simulation: its statement must be that of the case in the file.
    fn same_time(&self, case: &CaseOf<D, N>) -> bool {
        if case.until.is_none() {
            return case.times.instants() == self.file.run_times().instants();
        }
        let time = |text: &str| text.parse::<toml::Table>().ok()?.remove("time");
        let stored = self.file.case().and_then(|case| time(&case.text));
        stored.is_some() && stored == time(case.source.text())
    }

    /// Lets the run go on to its end, on so many threads, by default one for each core. The file then is, byte by byte,
    /// that of a run that was not interrupted. `open` is dropped as soon as the file is closed.
    ///
    /// # Errors
    /// A history whose run cannot go on, a step that cannot be stored, an unstable run.
    pub fn resume(
        &self,
        threads: Option<usize>,
        open: Option<Box<dyn Any + Send>>,
        observer: &mut dyn Observer,
    ) -> Result<Outcome<Simulation>, Failure> {
        let Unended { checkpoint, writer } = self.file.resume(&self.problem)?;
        let (ordered, storage) = (Ordered::new(&self.problem), Storage { file: Some(writer), memory: None, open });
        let checkpoint = checkpoint.map(|checkpoint| ordered.local(checkpoint));
        drive(&ordered, self.file.run_times(), (threads, checkpoint.as_ref()), storage, &mut Discard, observer)
    }
}

fn same_mesh<const D: usize, const N: usize>(one: &Mesh<D, N>, other: &Mesh<D, N>) -> bool {
    one.points() == other.points()
        && one.cells() == other.cells()
        && one.facet_groups() == other.facet_groups()
        && one.element_groups() == other.element_groups()
}

/// All steps with their reactions.
fn all(times: &TimeGrid) -> Kept {
    Kept { steps: (0..=times.step_count()).collect(), velocity: false, acceleration: false, reaction: true }
}
