//! The steps of a history, changed or watched on their way.

use percute_core::history::{SinkError, Step, StepSource};
use percute_core::time::TimeGrid;

/// Takes the steps of a history.
pub(crate) type Take<'t, const D: usize> = dyn FnMut(&Step<'_, D>) -> Result<(), SinkError> + 't;

/// A history whose steps go through a function, which hands them on.
pub(crate) struct Through<'s, F, const D: usize> {
    source: &'s dyn StepSource<D>,
    with: F,
}

impl<'s, F, const D: usize> Through<'s, F, D>
where
    F: Fn(&Step<'_, D>, &mut Take<'_, D>) -> Result<(), SinkError>,
{
    pub(crate) fn new(source: &'s dyn StepSource<D>, with: F) -> Self {
        Self { source, with }
    }
}

impl<F, const D: usize> StepSource<D> for Through<'_, F, D>
where
    F: Fn(&Step<'_, D>, &mut Take<'_, D>) -> Result<(), SinkError>,
{
    fn times(&self) -> &TimeGrid {
        self.source.times()
    }

    fn count(&self) -> usize {
        self.source.count()
    }

    fn replay(&self, take: &mut Take<'_, D>) -> Result<(), SinkError> {
        self.source.replay(&mut |step| (self.with)(step, take))
    }
}
