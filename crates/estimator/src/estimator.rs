//! The estimate of bars and plane bodies, compiled with this crate.

use crate::error::{EstimateError, RunError};
use crate::estimate::Estimate;
use crate::options::Options;
use crate::pipeline::{self, Pipeline, Steps};
use crate::replay;
use crate::request::Request;
use percute_core::dynamics::Simulation;
use percute_core::history::{SinkError, State, StateSink, StepSource};
use percute_core::observer::{Observer, StopFlag};
use percute_core::problem::Problem;
use percute_core::simplex::{Shape, instance};
use percute_core::time::TimeGrid;

type Begin<const D: usize, const N: usize> =
    for<'p> fn(&'p Problem<D, N>, &'p TimeGrid, Options) -> Result<Box<dyn Steps<D> + 'p>, EstimateError>;
type Replay<const D: usize, const N: usize> = fn(
    &Problem<D, N>,
    &dyn StepSource<D>,
    Options,
    &Request,
    &mut dyn StateSink<D>,
    &mut dyn Observer,
) -> Result<(Simulation, Estimate<D>), RunError>;

/// Its functions for one element.
struct Functions<const D: usize, const N: usize> {
    begin: Begin<D, N>,
    estimate: Replay<D, N>,
    memory: fn(&Problem<D, N>, &TimeGrid, &Options) -> usize,
}

static BAR: Functions<1, 2> = Functions::NEW;
static TRIANGLE: Functions<2, 3> = Functions::NEW;

impl<const D: usize, const N: usize> Functions<D, N> {
    const NEW: Self = Self { begin, estimate: replay::estimate, memory: pipeline::memory };

    fn of(problem: &Problem<D, N>) -> &'static Self {
        instance(match problem.mesh().simplex().shape() {
            Shape::Bar => &BAR,
            Shape::Triangle => &TRIANGLE,
        })
    }
}

fn begin<'p, const D: usize, const N: usize>(
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    options: Options,
) -> Result<Box<dyn Steps<D> + 'p>, EstimateError> {
    Ok(Box::new(Pipeline::new(problem, times, options)?))
}

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
pub struct Estimator<'p, const D: usize>(Box<dyn Steps<D> + 'p>);

impl<'p, const D: usize> Estimator<'p, D> {
    /// Prepares the estimate of a problem over a time grid.
    ///
    /// # Errors
    /// Options out of range, threads that cannot be started, or no folder for a temporary file that may be needed.
    pub fn new<const N: usize>(
        problem: &'p Problem<D, N>,
        times: &'p TimeGrid,
        options: Options,
    ) -> Result<Self, EstimateError> {
        (Functions::of(problem).begin)(problem, times, options).map(Self)
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
    pub fn finish(self) -> Result<Estimate<D>, EstimateError> {
        self.0.finish()
    }
}

impl<const D: usize> StateSink<D> for Estimator<'_, D> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.0.accept(state)
    }
}

/// About how much memory (bytes) an estimate takes beside its problem: its levels and the data that it keeps of
/// each element and sample.
#[must_use]
pub fn memory<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid, options: &Options) -> usize {
    (Functions::of(problem).memory)(problem, times, options)
}

/// Estimates a history: from the same steps, the same bits as beside the run that made them. If the observer breaks,
/// the steps taken so far are estimated, on a large mesh as far as [`Estimator::stopping`] says. The simulation is
/// summed up from the steps. `beside` takes every step that is estimated too, so that they need not be read again.
///
/// # Errors
/// [`RunError`]: a history that cannot be read or does not fit the problem, options out of range, maps
/// that cannot be kept.
pub fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    options: Options,
    request: &Request,
    beside: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<(Simulation, Estimate<D>), RunError> {
    (Functions::of(problem).estimate)(problem, source, options, request, beside, observer)
}
