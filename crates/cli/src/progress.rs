//! Progress with time left, and interruption.

use crate::stop::Stop;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use percute_core::observer::{Observer, Progress, StopFlag};
use std::ops::ControlFlow;

/// Shows progress on a terminal and asks whether to stop.
pub(crate) struct Watch<'a> {
    bar: ProgressBar,
    stop: &'a Stop,
}

impl<'a> Watch<'a> {
    /// Watches, with a bar on standard error if `visible`.
    pub(crate) fn new(visible: bool, stop: &'a Stop) -> Self {
        let target = if visible { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:32} {pos} of {len}, {eta} left") {
            bar.set_style(style);
        }
        Self { bar, stop }
    }

    /// The steps are done: takes the bar off the terminal.
    pub(crate) fn clear(&self) {
        self.stop.at_steps(false);
        self.bar.finish_and_clear();
    }
}

impl Observer for Watch<'_> {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        self.stop.at_steps(true);
        if !self.bar.is_hidden() {
            if self.bar.message() != progress.stage {
                self.bar.reset();
                self.bar.set_message(progress.stage);
            }
            self.bar.set_length(progress.total as u64);
            self.bar.set_position(progress.done as u64);
        }
        if self.stop.is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn flag(&self) -> StopFlag {
        self.stop.flag()
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
    use crate::stop::Answer;
    use std::time::Duration;

    #[test]
    fn a_watch_breaks_when_asked() {
        let (stop, progress) = (Stop::new(), Progress { stage: "simulating", done: 1, total: 2 });
        assert_eq!(Watch::new(false, &stop).observe(progress), ControlFlow::Continue(()));
        let flag = Watch::new(false, &stop).flag();
        assert!(!flag.is_up());
        stop.ask();
        assert!(flag.is_up(), "within a step");
        assert_eq!(Watch::new(false, &stop).observe(progress), ControlFlow::Break(()));
    }

    #[test]
    fn a_watch_is_at_steps_from_the_first_to_its_end() {
        let (stop, progress) = (Stop::new(), Progress { stage: "estimating", done: 0, total: 2 });
        let mut watch = Watch::new(false, &stop);
        assert_eq!(stop.answer(Duration::ZERO), Answer::None, "before the first step");
        let _ = watch.observe(progress);
        assert_eq!(stop.answer(Duration::ZERO), Answer::Later);
        drop(watch);
        assert_eq!(stop.answer(Duration::ZERO), Answer::None, "after the last");
    }
}
