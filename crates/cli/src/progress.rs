//! Progress with time left, and interruption.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use percute_core::observer::{Observer, Progress};
use std::ops::ControlFlow;

/// Shows progress on a terminal and asks whether to stop.
pub(crate) struct Watch<'a> {
    bar: ProgressBar,
    interrupted: &'a (dyn Fn() -> bool + Sync),
}

impl<'a> Watch<'a> {
    /// Watches, with a bar on standard error if `visible`.
    pub(crate) fn new(visible: bool, interrupted: &'a (dyn Fn() -> bool + Sync)) -> Self {
        let target = if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:32} {pos} of {len}, {eta} left") {
            bar.set_style(style);
        }
        Self { bar, interrupted }
    }

    /// Takes the bar off the terminal.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Watch<'_> {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        if !self.bar.is_hidden() {
            if self.bar.message() != progress.stage {
                self.bar.reset();
                self.bar.set_message(progress.stage);
            }
            self.bar.set_length(progress.total as u64);
            self.bar.set_position(progress.done as u64);
        }
        if (self.interrupted)() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl Drop for Watch<'_> {
    /// Leaves a clean line, whatever ended the run.
    fn drop(&mut self) {
        self.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_watch_breaks_when_asked() {
        let progress = Progress { stage: "simulating", done: 1, total: 2 };
        assert_eq!(Watch::new(false, &|| false).observe(progress), ControlFlow::Continue(()));
        assert_eq!(Watch::new(false, &|| true).observe(progress), ControlFlow::Break(()));
    }
}
