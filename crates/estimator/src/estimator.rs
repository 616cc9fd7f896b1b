//! The estimate of bars, plane bodies and solids, compiled with this crate.

use crate::error::{EstimateError, RunError};
use crate::estimate::Estimate;
use crate::options::Options;
use crate::pipeline::{self, Steps};
use crate::replay;
use crate::request::Request;
use percute_core::dynamics::Simulation;
use percute_core::history::{SinkError, State, StateSink, StepSource};
use percute_core::observer::{Observer, StopFlag};
use percute_core::problem::ProblemRef;
use percute_core::time::TimeGrid;

/// Takes in the steps of a history and estimates its constitutive relation error.
///
/// Steps may come from the integrator as it runs or from a stored history. They are worked on in
/// windows, and memory does not grow with their number, but for some 150 bytes of each step, 300 of each sample and the
/// maps that were requested.
/// Elements around candidate nodes of contact wait until the next contact of all these nodes is known, which may be the
/// end of the run. Some kilobytes for each node wait in memory, and the rest in a temporary file, in the folder that
/// `TMPDIR` names or in `/var/tmp`. Once it cannot be written, steps are refused with [`EstimateError::Scratch`].
///
/// A state that fills a window of 8 sampled levels makes [`accept`](StateSink::accept) work on all of it before it
/// returns, and so does [`finish`](Estimator::finish) on the last one: about a second on one core for a million
/// elements. [`stopping`](Estimator::stopping) ends it before.
#[derive(Debug)]
pub struct Estimator<'p>(Box<dyn Steps + 'p>);

impl<'p> Estimator<'p> {
    /// Prepares the estimate of a problem over a time grid.
    ///
    /// # Errors
    /// Options out of range, threads that cannot be started, or no folder for a temporary file that may be needed.
    pub fn new(
        problem: impl Into<ProblemRef<'p>>,
        times: &'p TimeGrid,
        options: Options,
    ) -> Result<Self, EstimateError> {
        pipeline::begin(problem.into(), times, options).map(Self)
    }

    /// Keeps the maps requested as well, from the first step on. Only [`Sampling::Auto`](crate::Sampling::Auto) samples
    /// them for this: its sums then have more samples. Otherwise no other number of the estimate changes.
    ///
    /// # Errors
    /// Steps out of order, beyond the last or not sampled; more maps than memory can hold.
    pub fn keeping(mut self, request: &Request) -> Result<Self, EstimateError> {
        self.0.keep(request)?;
        Ok(self)
    }

    /// Leaves the work on a large mesh in its middle once a flag is up. The estimate then covers the steps before that
    /// work, and those that follow are not estimated: [`Estimate::steps`] tells how many are.
    #[must_use]
    pub fn stopping(mut self, flag: StopFlag) -> Self {
        self.0.stop_at(flag);
        self
    }

    /// Ends with the steps taken so far and sums up.
    ///
    /// # Errors
    /// Fewer than two steps, none estimated before a [stop](Estimator::stopping), or numbers out of range.
    pub fn finish(self) -> Result<Estimate, EstimateError> {
        self.0.finish()
    }
}

impl StateSink for Estimator<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.0.accept(state)
    }
}

/// About how much memory (bytes) an estimate takes beside its problem: its levels and the data that it keeps of
/// each element and sample.
#[must_use]
pub fn memory<'p>(problem: impl Into<ProblemRef<'p>>, times: &TimeGrid, options: &Options) -> usize {
    fn of(problem: ProblemRef<'_>, times: &TimeGrid, options: &Options) -> usize {
        match problem {
            ProblemRef::D1(bar) => pipeline::memory::<1, 2>(bar, times, options),
            ProblemRef::D2(plane) => pipeline::memory::<2, 3>(plane, times, options),
            ProblemRef::D3(solid) => pipeline::memory::<3, 4>(solid, times, options),
        }
    }
    of(problem.into(), times, options)
}

/// Estimates a history: from the same steps, the same bits as beside the run that made them. If the observer breaks,
/// the steps taken so far are estimated, on a large mesh as far as [`Estimator::stopping`] says. The simulation is
/// summed up from the steps. `beside` takes every step that is estimated too, so that they need not be read again.
///
/// # Errors
/// [`RunError`]: a history that cannot be read or does not fit the problem, options out of range, maps
/// that cannot be kept.
pub fn estimate<'p>(
    problem: impl Into<ProblemRef<'p>>,
    source: &dyn StepSource,
    options: Options,
    request: &Request,
    beside: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<(Simulation, Estimate), RunError> {
    replay::estimate(problem.into(), source, options, request, beside, observer)
}
