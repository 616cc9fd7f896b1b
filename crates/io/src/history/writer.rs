//! Writes the steps of a run during the run.

use super::checkpoints::is_due;
use super::kept::Kept;
use super::recover::{give_back_room, set_steps};
use super::rows::{Places, Row};
use crate::error::{FileCause, FileError};
use crate::held::Held;
use crate::unfinished::Unfinished;
use percute_core::history::{Checkpoint, SinkError, State, StateSink, Step, StepError};
use percute_system::write_all_at;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::JoinHandle;

/// Number of steps that may wait for the disk during the run.
const WAITING: usize = 2;

/// Writes steps into a history file in a separate thread. Written steps survive if the process is killed
/// later. Such a file has all complete steps and is not marked complete.
#[derive(Debug)]
pub struct Writer<const D: usize> {
    path: PathBuf,
    held: Held,
    places: Places,
    last: usize,
    next: usize,
    /// Number of instants in the file.
    stored: usize,
    given: [bool; 2],
    kept: Option<Kept>,
    /// Until there is a step, the file is of no use.
    unfinished: Option<Unfinished>,
    rows: Option<SyncSender<Entry<D>>>,
    used: Receiver<Row<D>>,
    thread: Option<JoinHandle<Result<(), Failure>>>,
    failed: Option<Failure>,
}

/// A copy of what is to be written.
enum Entry<const D: usize> {
    Row(Row<D>),
    Checkpoint(Checkpoint<D>),
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
    pub(super) given: [bool; 2],
    /// The part of the run that the file keeps; all without one.
    pub(super) kept: Option<Kept>,
}

/// The step that could not be written.
#[derive(Debug)]
struct Failure {
    step: usize,
    kind: io::ErrorKind,
    code: Option<i32>,
}

impl Failure {
    fn cause(&self) -> FileCause {
        let source = self.code.map_or_else(|| self.kind.into(), io::Error::from_raw_os_error);
        FileCause::Write { step: self.step, source }
    }
}

impl<const D: usize> Writer<D> {
    pub(super) fn new(path: &Path, held: Held, places: Places, begun: Begun) -> io::Result<Self> {
        let Begun { last, next, stored, given, kept } = begun;
        let (rows, taken) = sync_channel(WAITING);
        let (back, used) = channel();
        let own = held.file().try_clone()?;
        let work = move || write_all(&own, &places, &taken, &back);
        let thread = std::thread::Builder::new().name("percute-history".to_string()).spawn(work)?;
        let (rows, thread) = (Some(rows), Some(thread));
        let unfinished = (places.had == 0).then(|| Unfinished::new(path));
        let (path, failed) = (path.to_path_buf(), None);
        Ok(Self { path, held, places, last, next, stored, given, kept, unfinished, rows, used, thread, failed })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of instants taken so far.
    #[must_use]
    pub fn count(&self) -> usize {
        self.next
    }

    /// The part of the run that the file keeps; all without one.
    #[must_use]
    pub fn kept(&self) -> Option<&Kept> {
        self.kept.as_ref()
    }

    /// Waits for the last step, writes the number of steps for VTK, marks the file complete and waits for
    /// the disk. A run that was stopped cleanly ends in the same way. A file that was moved is completed in its new
    /// place.
    ///
    /// # Errors
    /// A step that could not be written, or a file that was moved or removed.
    pub fn finish(mut self) -> Result<(), FileError> {
        self.stop();
        let finished = match &self.failed {
            Some(failure) => Err(failure.cause()),
            None => self.complete(),
        };
        finished.map_err(|cause| cause.at(&self.path))
    }

    fn complete(&self) -> Result<(), FileCause> {
        let stored = self.stored.max(self.places.had);
        let failed = |detail: String| FileCause::Finish { detail, steps: stored };
        let told = |error: io::Error| failed(error.to_string());
        self.held.file().sync_data().map_err(told)?;
        let place = self.held.place(&self.path);
        let Some(now) = place else { return Err(FileCause::Lost { now: None }) };
        set_steps(&now, stored).map_err(failed)?;
        let planned = self.kept.as_ref().map_or(self.last + 1, |kept| kept.steps.len());
        give_back_room(self.held.file(), self.places.rooms(D as u64), planned, stored);
        if let Some(checkpoints) = self.places.checkpoints.filter(|_| self.next > self.last) {
            checkpoints.give_back(self.held.file());
        }
        // The last write: a file that is complete is the same, byte by byte, wherever its run was killed.
        write_all_at(self.held.file(), &[1], self.places.complete).map_err(told)?;
        self.held.file().sync_all().map_err(told)?;
        if now == self.path { Ok(()) } else { Err(FileCause::Lost { now: Some(now) }) }
    }

    /// Completes the pending writes and ends the thread.
    fn stop(&mut self) {
        self.rows = None;
        let ended = self.thread.take().map(JoinHandle::join);
        match ended {
            Some(Ok(Err(failure))) => self.failed = Some(failure),
            Some(Err(_)) => self.failed = Some(Failure { step: self.next, kind: io::ErrorKind::Other, code: None }),
            Some(Ok(Ok(()))) | None => {}
        }
    }

    fn check_order(&self, step: &Step<'_, D>) -> Result<(), StepError> {
        let (given, expected, last) = (step.index, self.next, self.last);
        if given != expected || given > last { Err(StepError::Order { given, expected, last }) } else { Ok(()) }
    }

    fn check(&self, step: &Step<'_, D>) -> Result<(), StepError> {
        let n = step.index;
        for (had, (field, there)) in self
            .given
            .into_iter()
            .zip([("velocity", step.velocity.is_some()), ("acceleration", step.acceleration.is_some())])
        {
            if had != there {
                return Err(StepError::Partly { step: n, field, there });
            }
        }
        let Places { nodes, contact_nodes, .. } = self.places;
        let lengths = [
            ("displacement", step.displacement.len(), nodes),
            ("reaction", step.reaction.len(), contact_nodes),
            ("touching", step.touching.len(), contact_nodes),
            ("velocity", step.velocity.map_or(nodes, <[_]>::len), nodes),
            ("acceleration", step.acceleration.map_or(nodes, <[_]>::len), nodes),
        ];
        match lengths.into_iter().find(|(_, given, needed)| given != needed) {
            Some((field, given, needed)) => Err(StepError::Length { step: n, field, given, needed }),
            None => Ok(()),
        }
    }

    fn send(&mut self, step: &Step<'_, D>) -> Result<(), FileCause> {
        if let Some(failure) = &self.failed {
            return Err(failure.cause());
        }
        self.check_order(step)?;
        let Some(place) = self.kept.as_ref().map_or(Some(step.index), |kept| kept.row_of(step.index)) else {
            self.next += 1;
            return Ok(());
        };
        self.check(step)?;
        let mut row = self.used.try_recv().unwrap_or_default();
        row.take(step, place);
        self.pass_on(Entry::Row(row))?;
        (self.next, self.stored) = (self.next + 1, place + 1);
        self.unfinished = None;
        Ok(())
    }

    /// Hands an entry to the thread that writes.
    fn pass_on(&mut self, entry: Entry<D>) -> Result<(), FileCause> {
        if self.rows.as_ref().is_some_and(|rows| rows.send(entry).is_ok()) {
            return Ok(());
        }
        self.stop();
        let failure = self.failed.get_or_insert(Failure { step: self.next, kind: io::ErrorKind::Other, code: None });
        Err(failure.cause())
    }

    /// Keeps the state of the step appended last, if it is one from which the run can go on. `restated` gives the state
    /// the numbers of the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn keep(
        &mut self,
        state: &State<'_, D>,
        restated: impl FnOnce(Checkpoint<D>) -> Checkpoint<D>,
    ) -> Result<(), SinkError> {
        if self.places.checkpoints.is_none() || !is_due(state.step().index) {
            return Ok(());
        }
        let Some(checkpoint) = state.checkpoint() else { return Ok(()) };
        let kept = self.pass_on(Entry::Checkpoint(restated(checkpoint)));
        Ok(kept.map_err(|cause| cause.at(&self.path))?)
    }

    /// Appends a step; one that the file does not keep is only counted.
    ///
    /// # Errors
    /// A step that does not fit, or a file that cannot be written.
    pub fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        Ok(self.send(step).map_err(|cause| cause.at(&self.path))?)
    }
}

impl<const D: usize> StateSink<D> for Writer<D> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.push(state.step())?;
        self.keep(state, |checkpoint| checkpoint)
    }
}

impl<const D: usize> Drop for Writer<D> {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Writes entries in order, until the last one or a failure.
fn write_all<const D: usize>(
    file: &File,
    places: &Places,
    taken: &Receiver<Entry<D>>,
    back: &Sender<Row<D>>,
) -> Result<(), Failure> {
    for entry in taken {
        let failure = |step| move |error: io::Error| Failure { step, kind: error.kind(), code: error.raw_os_error() };
        match entry {
            Entry::Row(row) => {
                row.write(file, places).map_err(failure(row.index))?;
                // There is no receiver once the run has ended.
                let _ = back.send(row);
            }
            Entry::Checkpoint(checkpoint) => {
                let written = places.checkpoints.map_or(Ok(()), |places| places.write(file, &checkpoint));
                written.map_err(failure(checkpoint.step))?;
            }
        }
    }
    Ok(())
}
