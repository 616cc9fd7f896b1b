//! Writes the steps of a run during the run.

use super::PLASTIC;
use super::checkpoints::is_due;
use super::queue::Queue;
use super::recover::{give_back_room, set_steps};
use super::rows::Places;
use super::stored_part::StoredPart;
use crate::create::Unnamed;
use crate::error::{FileCause, FileError};
use crate::lock::LockedFile;
use crate::unfinished::Unfinished;
use percute_core::history::{Checkpoint, SinkError, State, StateSink, Step, StepError};
use percute_system::write_all_at;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// Writes steps into a history file in a separate thread. Written steps survive if the process is killed
/// later, unless the file is given its name at the end. Such a file has all complete steps and is not marked complete.
#[derive(Debug)]
pub struct Writer {
    // Dropped first: the file is written until then.
    queue: Queue,
    target: Target,
    places: Places,
    last: usize,
    next: usize,
    /// Number of instants in the file.
    stored: usize,
    supplied: [bool; 2],
    kept: Option<StoredPart>,
    /// Until there is a step, the file is of no use.
    unfinished: Option<Unfinished>,
}

/// The file that is written.
#[derive(Debug)]
pub(super) enum Target {
    /// It has its name.
    Named(LockedFile, PathBuf),
    /// It is given its name once it is complete.
    Unnamed(Unnamed),
}

impl Target {
    fn file(&self) -> &File {
        match self {
            Self::Named(lock, _) => lock.file(),
            Self::Unnamed(unnamed) => unnamed.file(),
        }
    }

    /// Its name, now or in the end.
    fn path(&self) -> &Path {
        match self {
            Self::Named(_, path) => path,
            Self::Unnamed(unnamed) => unnamed.path(),
        }
    }

    /// Where it is now.
    fn place(&self) -> Option<PathBuf> {
        match self {
            Self::Named(lock, path) => lock.place(path),
            Self::Unnamed(unnamed) => Some(unnamed.temporary().to_path_buf()),
        }
    }

    /// What is removed if the process ends before the file has a step.
    fn unfinished(&self) -> Option<Unfinished> {
        match self {
            Self::Named(_, path) => Some(Unfinished::new(path)),
            Self::Unnamed(_) => None,
        }
    }

    /// Gives the complete file its name; `now` is its place.
    fn put(self, now: PathBuf) -> Result<(), FileCause> {
        match self {
            Self::Named(_, path) if path == now => Ok(()),
            Self::Named(..) => Err(FileCause::Lost { now: Some(now) }),
            Self::Unnamed(unnamed) => unnamed.put().map(drop),
        }
    }
}

/// The part of a run that its file is to hold, and that is there already.
#[derive(Debug)]
pub(super) struct Begun {
    /// Number of the last step.
    pub(super) last: usize,
    /// The next step to be taken.
    pub(super) next: usize,
    /// Number of instants in the file.
    pub(super) stored: usize,
    /// Whether the steps have their own velocities and accelerations.
    pub(super) supplied: [bool; 2],
    /// The part of the run that the file keeps; all without one.
    pub(super) kept: Option<StoredPart>,
}

impl Writer {
    pub(super) fn new(target: Target, places: Places, begun: Begun) -> io::Result<Self> {
        let Begun { last, next, stored, supplied, kept } = begun;
        let queue = Queue::new(target.file().try_clone()?, places)?;
        let unfinished = if places.had == 0 { target.unfinished() } else { None };
        Ok(Self { queue, target, places, last, next, stored, supplied, kept, unfinished })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        self.target.path()
    }

    /// Number of instants taken so far.
    #[must_use]
    pub fn count(&self) -> usize {
        self.next
    }

    /// The part of the run that the file keeps; all without one.
    #[must_use]
    pub fn stored_part(&self) -> Option<&StoredPart> {
        self.kept.as_ref()
    }

    /// Waits for the last step, writes the number of steps for VTK, marks the file complete and waits for
    /// the disk. A run that was stopped cleanly ends in the same way. A file that was moved is completed in its new
    /// place.
    ///
    /// # Errors
    /// A step that could not be written, or a file that was moved or removed.
    pub fn finish(mut self) -> Result<(), FileError> {
        let completed = self.queue.end(self.next).and_then(|()| self.complete());
        let path = self.path().to_path_buf();
        completed.and_then(|place| self.target.put(place)).map_err(|cause| cause.at(&path))
    }

    /// Completes the file and returns its place.
    fn complete(&self) -> Result<PathBuf, FileCause> {
        let stored = self.stored.max(self.places.had);
        let failed = |detail: String| FileCause::Finish { detail, steps: stored };
        let told = |error: io::Error| failed(error.to_string());
        let file = self.target.file();
        file.sync_data().map_err(told)?;
        let Some(place) = self.target.place() else { return Err(FileCause::Lost { now: None }) };
        set_steps(file, stored).map_err(failed)?;
        let planned = self.kept.as_ref().map_or(self.last + 1, |kept| kept.steps.len());
        give_back_room(file, self.places.rooms(), planned, stored);
        if let Some(checkpoints) = self.places.checkpoints.filter(|_| self.next > self.last) {
            checkpoints.give_back(file);
        }
        // The last write: a file that is complete is the same, byte by byte, wherever its run was killed.
        write_all_at(file, &[1], self.places.complete).map_err(told)?;
        file.sync_all().map_err(told)?;
        Ok(place)
    }

    fn check_order(&self, step: &Step<'_>) -> Result<(), StepError> {
        let (given, expected, last) = (step.index, self.next, self.last);
        if given != expected || given > last { Err(StepError::Order { given, expected, last }) } else { Ok(()) }
    }

    fn check(&self, step: &Step<'_>) -> Result<(), StepError> {
        let n = step.index;
        for (had, (field, there)) in self
            .supplied
            .into_iter()
            .zip([("velocity", step.velocity.is_some()), ("acceleration", step.acceleration.is_some())])
        {
            if had != there {
                return Err(StepError::Partly { step: n, field, there });
            }
        }
        let Places { dimension, contact_nodes, .. } = self.places;
        let [nodal, reaction] = [self.places.nodes, contact_nodes].map(|nodes| dimension * nodes);
        let lengths = [
            ("displacement", step.displacement.len(), nodal),
            ("reaction", step.reaction.len(), reaction),
            ("touching", step.touching.len(), contact_nodes),
            (PLASTIC, step.internal.len(), self.places.plastic.map_or(0, |(_, count)| count)),
            ("velocity", step.velocity.map_or(nodal, <[_]>::len), nodal),
            ("acceleration", step.acceleration.map_or(nodal, <[_]>::len), nodal),
        ];
        match lengths.into_iter().find(|(_, given, needed)| given != needed) {
            Some((field, given, needed)) => Err(StepError::Length { step: n, field, given, needed }),
            None => Ok(()),
        }
    }

    fn send(&mut self, step: &Step<'_>) -> Result<(), FileCause> {
        self.queue.check()?;
        self.check_order(step)?;
        let Some(place) = self.kept.as_ref().map_or(Some(step.index), |kept| kept.row_of(step.index)) else {
            self.next += 1;
            return Ok(());
        };
        self.check(step)?;
        self.queue.row(step, place)?;
        (self.next, self.stored) = (self.next + 1, place + 1);
        self.unfinished = None;
        Ok(())
    }

    /// Keeps the state of the step appended last, if it is one from which the run can go on. `restated` gives the state
    /// the numbers of the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn keep(
        &mut self,
        state: &State<'_>,
        restated: impl FnOnce(Checkpoint) -> Checkpoint,
    ) -> Result<(), SinkError> {
        if self.places.checkpoints.is_none() || !is_due(state.step().index) {
            return Ok(());
        }
        let Some(checkpoint) = state.checkpoint() else { return Ok(()) };
        let kept = self.queue.checkpoint(restated(checkpoint));
        Ok(kept.map_err(|cause| cause.at(self.path()))?)
    }

    /// Appends a step; one that the file does not keep is only counted.
    ///
    /// # Errors
    /// A step that does not fit, or a file that cannot be written.
    pub fn push(&mut self, step: &Step<'_>) -> Result<(), SinkError> {
        Ok(self.send(step).map_err(|cause| cause.at(self.path()))?)
    }
}

impl StateSink for Writer {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.push(state.step())?;
        self.keep(state, |checkpoint| checkpoint)
    }
}
