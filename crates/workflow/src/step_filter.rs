//! The steps of a history, changed or watched on their way.

use percute_core::history::{SinkError, Step, StepSource};
use percute_core::time::TimeGrid;

/// Takes the steps of a history.
pub(crate) type Take<'t> = dyn FnMut(&Step<'_>) -> Result<(), SinkError> + 't;

/// A history whose steps go through a function, which hands them on.
pub(crate) struct StepFilter<'s, F> {
    source: &'s dyn StepSource,
    with: F,
}

impl<'s, F> StepFilter<'s, F>
where
    F: Fn(&Step<'_>, &mut Take<'_>) -> Result<(), SinkError>,
{
    pub(crate) fn new(source: &'s dyn StepSource, with: F) -> Self {
        Self { source, with }
    }
}

impl<F> StepSource for StepFilter<'_, F>
where
    F: Fn(&Step<'_>, &mut Take<'_>) -> Result<(), SinkError>,
{
    fn times(&self) -> &TimeGrid {
        self.source.times()
    }

    fn count(&self) -> usize {
        self.source.count()
    }

    fn replay(&self, take: &mut Take<'_>) -> Result<(), SinkError> {
        self.source.replay(&mut |step| (self.with)(step, take))
    }
}
