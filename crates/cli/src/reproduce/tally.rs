//! Progress over the many runs of a part.

use super::error::ReproduceError;
use percute_core::dynamics::{Simulation, simulate};
use percute_core::history::StepSink;
use percute_core::observer::{Observer, Progress};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Options, Request};
use std::ops::ControlFlow;

/// Tells the progress of a part that is made of many runs, each of some weight, and hears whether to stop.
pub struct Tally<'a> {
    observer: &'a mut dyn Observer,
    part: &'static str,
    total: f64,
    done: f64,
    now: f64,
}

/// Progress is told in whole numbers.
const PARTS_PER_RUN: f64 = 1000.0;

impl<'a> Tally<'a> {
    /// A tally of the part of this name; `total` is the sum of the weights of all its runs, in any unit.
    pub fn new(part: &'static str, total: f64, observer: &'a mut dyn Observer) -> Self {
        Self { observer, part, total, done: 0.0, now: 0.0 }
    }

    /// Begins the next run, of this weight; what was begun before is done.
    ///
    /// # Errors
    /// [`ReproduceError::Interrupted`].
    pub fn begin(&mut self, weight: f64) -> Result<(), ReproduceError> {
        self.done += self.now;
        self.now = weight;
        self.tell(0.0)
    }

    /// Simulates and estimates as the next run.
    ///
    /// # Errors
    /// [`ReproduceError::Interrupted`], and what simulation and estimate refuse.
    pub fn estimate<const D: usize, const N: usize>(
        &mut self,
        weight: f64,
        problem: &Problem<D, N>,
        times: &TimeGrid,
        options: Options,
        request: &Request,
    ) -> Result<(Simulation, Estimate<D>), ReproduceError> {
        self.begin(weight)?;
        let run = percute_estimator::run(problem, times, options, request, self);
        // A run that was stopped at its very start is refused, not estimated: asked first.
        self.tell(1.0)?;
        Ok(run?)
    }

    /// Simulates as the next run and hands all steps to `sink`.
    ///
    /// # Errors
    /// [`ReproduceError::Interrupted`], and what the simulation refuses.
    pub fn simulate<const D: usize, const N: usize>(
        &mut self,
        weight: f64,
        problem: &Problem<D, N>,
        times: &TimeGrid,
        sink: &mut dyn StepSink<D>,
    ) -> Result<Simulation, ReproduceError> {
        self.begin(weight)?;
        let simulation = simulate(problem, times, sink, self);
        self.tell(1.0)?;
        Ok(simulation?)
    }

    /// Tells that a fraction of the run that was begun is done.
    ///
    /// # Errors
    /// [`ReproduceError::Interrupted`].
    pub fn tell(&mut self, fraction: f64) -> Result<(), ReproduceError> {
        let done = ((self.done + self.now * fraction) / self.total.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let progress =
            Progress { stage: self.part, done: (PARTS_PER_RUN * done).round() as usize, total: PARTS_PER_RUN as usize };
        match self.observer.observe(progress) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(ReproduceError::Interrupted),
        }
    }
}

impl Observer for Tally<'_> {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        let fraction = progress.done as f64 / progress.total.max(1) as f64;
        if self.tell(fraction).is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

/// The weight of a run: steps times elements.
#[must_use]
pub fn weight<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid) -> f64 {
    (problem.mesh().element_count() * times.step_count()) as f64
}
