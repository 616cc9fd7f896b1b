//! Progress and cancellation, in one hook.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// How far a computation is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub stage: &'static str,
    /// Steps done.
    pub done: usize,
    /// Steps in all.
    pub total: usize,
}

/// Whether a computation was asked to stop, for those who work within a step. Copies of a flag are one.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Arc<AtomicBool>);

impl StopFlag {
    /// Raises the flag, or takes it down again. Returns whether it was up.
    pub fn set(&self, up: bool) -> bool {
        self.0.swap(up, Relaxed)
    }

    /// Whether it is up.
    #[inline]
    #[must_use]
    pub fn is_up(&self) -> bool {
        self.0.load(Relaxed)
    }
}

/// Receives the progress at every step; a break stops the computation cleanly.
pub trait Observer: Send {
    /// Called between steps, from a thread that computes.
    fn observe(&mut self, progress: Progress) -> ControlFlow<()>;

    /// A flag that tells within long steps that the next call will break. This one is never up.
    fn flag(&self) -> StopFlag {
        StopFlag::default()
    }
}

/// Ignores the progress and never stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {
    fn observe(&mut self, _: Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: FnMut(Progress) -> ControlFlow<()> + Send> Observer for F {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        self(progress)
    }
}
