//! When a body touches its plane, and with how many nodes.

use percute_core::history::{SinkError, Step, StepSink};

/// What is told of the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Touch {
    /// First and last instant at which a node touches (s).
    pub(super) during: Option<[f64; 2]>,
    /// The most nodes that touch at one instant.
    pub(super) most: usize,
    /// How many touch at the end.
    pub(super) last: usize,
}

/// Takes the steps and looks at the touching status alone.
#[derive(Debug, Default)]
pub(super) struct Touching(Touch);

impl Touching {
    pub(super) fn finish(self) -> Touch {
        self.0
    }
}

impl StepSink<2> for Touching {
    fn push(&mut self, step: &Step<'_, 2>) -> Result<(), SinkError> {
        let touch = &mut self.0;
        touch.last = step.touching.iter().filter(|touching| **touching).count();
        touch.most = touch.most.max(touch.last);
        if touch.last > 0 {
            touch.during = Some([touch.during.map_or(step.time, |during| during[0]), step.time]);
        }
        Ok(())
    }
}
