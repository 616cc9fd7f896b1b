//! The thread that writes the steps of a run, and the steps that wait for it.

use super::rows::{Places, Row};
use crate::error::FileCause;
use percute_core::history::{Checkpoint, Step};
use std::fs::File;
use std::io;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::JoinHandle;

/// Number of steps that may wait for the disk during the run.
const WAITING: usize = 2;

/// A queue of what is to be written, in order.
#[derive(Debug)]
pub(super) struct Queue {
    entries: Option<SyncSender<QueueEntry>>,
    used: Receiver<Row>,
    thread: Option<JoinHandle<Result<(), Failure>>>,
    failed: Option<Failure>,
}

/// A copy of what is to be written.
enum QueueEntry {
    Row(Row),
    Checkpoint(Checkpoint),
}

/// The step that could not be written.
#[derive(Debug)]
struct Failure {
    step: usize,
    kind: io::ErrorKind,
    code: Option<i32>,
}

impl Failure {
    fn of(step: usize) -> impl FnOnce(io::Error) -> Self {
        move |error| Self { step, kind: error.kind(), code: error.raw_os_error() }
    }

    fn cause(&self) -> FileCause {
        let source = self.code.map_or_else(|| self.kind.into(), io::Error::from_raw_os_error);
        FileCause::Write { step: self.step, source }
    }
}

impl Queue {
    /// Starts the thread, which writes to `file`.
    ///
    /// # Errors
    /// A thread that cannot be started.
    pub(super) fn new(file: File, places: Places) -> io::Result<Self> {
        let (entries, taken) = sync_channel(WAITING);
        let (back, used) = channel();
        let work = move || write_all(&file, &places, &taken, &back);
        let thread = std::thread::Builder::new().name("percute-history".to_string()).spawn(work)?;
        Ok(Self { entries: Some(entries), used, thread: Some(thread), failed: None })
    }

    /// Takes a step in, for a row of the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn row(&mut self, step: &Step<'_>, place: usize) -> Result<(), FileCause> {
        let mut row = self.used.try_recv().unwrap_or_default();
        row.take(step, place);
        self.pass_on(QueueEntry::Row(row), step.index)
    }

    /// Takes a checkpoint in.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn checkpoint(&mut self, checkpoint: Checkpoint) -> Result<(), FileCause> {
        let step = checkpoint.step;
        self.pass_on(QueueEntry::Checkpoint(checkpoint), step)
    }

    fn pass_on(&mut self, entry: QueueEntry, step: usize) -> Result<(), FileCause> {
        self.check()?;
        if self.entries.as_ref().is_some_and(|entries| entries.send(entry).is_ok()) {
            return Ok(());
        }
        // The thread has ended, by a failure or a panic.
        let _ = self.stop();
        let failure = self.failed.get_or_insert(Failure { step, kind: io::ErrorKind::Other, code: None });
        Err(failure.cause())
    }

    /// Whether all could be written so far.
    ///
    /// # Errors
    /// The step that could not.
    pub(super) fn check(&self) -> Result<(), FileCause> {
        self.failed.as_ref().map_or(Ok(()), |failure| Err(failure.cause()))
    }

    /// Waits until all is written, and ends the thread. `next` is the step that would follow.
    ///
    /// # Errors
    /// A step that could not be written.
    pub(super) fn end(&mut self, next: usize) -> Result<(), FileCause> {
        if self.stop().is_err() {
            self.failed = Some(Failure { step: next, kind: io::ErrorKind::Other, code: None });
        }
        self.check()
    }

    /// Ends the thread; an error if it has panicked.
    fn stop(&mut self) -> std::thread::Result<()> {
        self.entries = None;
        if let Err(failure) = self.thread.take().map_or(Ok(Ok(())), JoinHandle::join)? {
            self.failed = Some(failure);
        }
        Ok(())
    }
}

impl Drop for Queue {
    fn drop(&mut self) {
        let _ = self.stop();
    }
}

/// Writes entries in order, until the last one or a failure.
fn write_all(file: &File, places: &Places, taken: &Receiver<QueueEntry>, back: &Sender<Row>) -> Result<(), Failure> {
    for entry in taken {
        match entry {
            QueueEntry::Row(row) => {
                row.write(file, places).map_err(Failure::of(row.index))?;
                // There is no receiver once the run has ended.
                let _ = back.send(row);
            }
            QueueEntry::Checkpoint(checkpoint) => {
                let written = places.checkpoints.map_or(Ok(()), |places| places.write(file, &checkpoint));
                written.map_err(Failure::of(checkpoint.step))?;
            }
        }
    }
    Ok(())
}
