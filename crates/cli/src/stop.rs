//! A request to stop the command: from a signal to the place where it is heard.

use percute_core::observer::StopFlag;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

const PAUSE: Duration = Duration::from_millis(10);

/// Whether the command was asked to stop, and where it is.
#[derive(Debug, Default)]
pub struct Stop {
    asked: StopFlag,
    /// The command has seen it, or has ended.
    heard: AtomicBool,
    /// The command is at steps: it looks between them, and its results so far are worth the wait.
    at_steps: AtomicBool,
}

/// What becomes of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// The command ends in order.
    Heard,
    /// The command will see it after the steps in work.
    Later,
    /// The command does not look, as in the set-up of a large mesh or at a pipe without a writer.
    None,
}

impl Stop {
    /// Before any request.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// For those who work within a step.
    pub(crate) fn flag(&self) -> StopFlag {
        self.asked.clone()
    }

    /// Whether to stop. The command looks here between its steps.
    pub fn is_asked(&self) -> bool {
        let asked = self.asked.is_up();
        if asked {
            self.heard.store(true, Relaxed);
        }
        asked
    }

    /// Asks. Returns whether that was done before.
    pub fn ask(&self) -> bool {
        self.asked.set(true)
    }

    /// The command begins or ends its steps.
    pub(crate) fn at_steps(&self, at: bool) {
        self.at_steps.store(at, Relaxed);
    }

    /// A command begins.
    pub(crate) fn begin(&self) {
        self.asked.set(false);
        self.heard.store(false, Relaxed);
        self.at_steps.store(false, Relaxed);
    }

    /// The command has ended: there is nothing to wait for.
    pub(crate) fn end(&self) {
        self.heard.store(true, Relaxed);
    }

    /// Waits until the request is heard, at most so long.
    pub(crate) fn answer(&self, patience: Duration) -> Answer {
        let start = Instant::now();
        loop {
            if self.heard.load(Relaxed) {
                return Answer::Heard;
            }
            if start.elapsed() >= patience {
                return if self.at_steps.load(Relaxed) { Answer::Later } else { Answer::None };
            }
            std::thread::sleep(PAUSE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_waits_for_steps_and_for_nothing_else() {
        let (stop, patience) = (Stop::new(), Duration::from_millis(20));
        assert!(!stop.is_asked() && !stop.ask() && stop.ask(), "the second request is told from the first");
        assert_eq!(stop.answer(patience), Answer::None, "set-up");
        stop.at_steps(true);
        assert_eq!(stop.answer(patience), Answer::Later, "a window takes longer than the patience");
        stop.at_steps(false);
        assert_eq!(stop.answer(patience), Answer::None, "a result is written");
        assert!(stop.is_asked());
        assert_eq!(stop.answer(patience), Answer::Heard);
        stop.begin();
        assert!(!stop.is_asked());
        stop.end();
        assert_eq!(stop.answer(patience), Answer::Heard, "the command is at its end");
    }
}
