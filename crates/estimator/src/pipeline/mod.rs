//! From steps to an estimate: steps are prepared one after the other ([`prepare`]), gathered in
//! windows, worked on in parallel ([`window`]), and summed in a fixed order ([`totals`]).

mod backlog;
mod far;
#[cfg(test)]
mod fixture;
mod maps;
mod near;
mod near_elements;
mod prepare;
mod sampled_interval;
mod sampled_levels;
mod sampling;
mod schedule;
mod separation;
mod sliding;
#[cfg(test)]
mod tests;
mod totals;
mod waiting;
mod window;

use crate::error::EstimateError;
use crate::estimate::Estimate;
use crate::options::{MOST_THREADS, Options, Reconstruction};
use crate::request::Request;
use crate::sampling::Sampling;
use crate::scratch_file::ScratchFile;
use maps::Maps;
use near_elements::may_need_a_file;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::observer::StopFlag;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use prepare::Preparation;
use rayon::ThreadPool;
use window::LevelWindow;
pub use window::memory;

/// From so many elements on, a step takes much longer than to hand it to the threads, some 10 µs.
const THREADED: usize = 20_000;

/// From so many elements on a stop is looked for within a window. A smaller one takes some 0.1 s, and is not given up.
const STOPPED: usize = 100_000;

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
pub struct Estimator<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    every: Sampling,
    pool: ThreadPool,
    preparation: Preparation<'p, D, N>,
    window: LevelWindow<'p, D, N>,
}

impl<'p, const D: usize, const N: usize> Estimator<'p, D, N> {
    /// Prepares the estimate of a problem over a time grid.
    ///
    /// # Errors
    /// Options out of range, threads that cannot be started, or no folder for a temporary file that may be needed.
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: Options) -> Result<Self, EstimateError> {
        let every = match options.every {
            Sampling::Auto => None,
            Sampling::Every(steps) => Some(steps),
        };
        for (name, value) in [("every", every), ("window", options.window), ("threads", options.threads)] {
            if value == Some(0) {
                return Err(EstimateError::Zero { name });
            }
        }
        if let Some(threads) = options.threads.filter(|&threads| threads > MOST_THREADS) {
            return Err(EstimateError::TooManyThreads { threads });
        }
        options.acceleration(D).check(options.reconstruction)?;
        let sliding = problem.statement().interfaces.iter().find(|interface| !interface.is_matching());
        if let Some(interface) = sliding.filter(|_| options.reconstruction != Reconstruction::Corrected) {
            return Err(EstimateError::NotMatching { groups: interface.groups().map(str::to_string) });
        }
        // A pool of its own: a process forked later must not wait for threads it does not have.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads.unwrap_or(0)).build();
        let pool = pool.map_err(|e| EstimateError::Threads { cause: e.to_string() })?;
        let spacing = options.spacing(problem, times);
        if may_need_a_file(problem, times.step_count() / spacing + 1, spacing) {
            ScratchFile::check()?;
        }
        let mut window = LevelWindow::new(problem, times, &options, Maps::new(Request::default(), problem)?);
        pool.install(|| window.make_room());
        let mut preparation = Preparation::new(problem, times, &options);
        preparation.prepare(&window.equilibration.elements);
        Ok(Self { problem, times, every: options.every, pool, preparation, window })
    }

    /// Keeps the maps requested as well, from the first step on. Only [`Sampling::Auto`] samples them for this: its
    /// sums then have more samples. Otherwise no other number of the estimate changes.
    ///
    /// # Errors
    /// Steps out of order, beyond the last or not sampled; more maps than memory can hold.
    pub fn keeping(mut self, request: &Request) -> Result<Self, EstimateError> {
        request.check(self.times, self.every.stride())?;
        if self.every == Sampling::Auto {
            self.preparation.request(&request.steps);
        }
        self.window.maps = Maps::new(request.clone(), self.problem)?;
        Ok(self)
    }

    /// Leaves the work on a large mesh in its middle once a flag is up. The estimate then covers the steps before that
    /// work, and those that follow are not estimated: [`Estimate::steps`] tells how many are.
    #[must_use]
    pub fn stopping(mut self, flag: StopFlag) -> Self {
        if self.problem.mesh().element_count() >= STOPPED {
            self.window.stop_at(flag);
        }
        self
    }

    /// Ends with the steps taken so far and sums up.
    ///
    /// # Errors
    /// Fewer than two steps, none estimated before a [stop](Estimator::stopping), or numbers out of range.
    pub fn finish(mut self) -> Result<Estimate<D>, EstimateError> {
        if self.preparation.count() < 2 {
            return Err(EstimateError::TooFewSteps { count: self.preparation.count() });
        }
        self.preparation.finish()?;
        self.pass_on()?;
        let estimate = self.window.finish(&self.pool, &mut self.preparation)?;
        if estimate.is_finite() { Ok(estimate) } else { Err(EstimateError::Overflow) }
    }

    /// Hands the levels that are ready to the window.
    fn pass_on(&mut self) -> Result<(), EstimateError> {
        while let Some(level) = self.preparation.next_ready() {
            self.window.push(&self.pool, level, &mut self.preparation)?;
        }
        Ok(())
    }
}

impl<const D: usize, const N: usize> StateSink<D> for Estimator<'_, D, N> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.preparation.check(state.step())?;
        let preparation = &mut self.preparation;
        if self.pool.current_num_threads() > 1 && self.problem.mesh().element_count() >= THREADED {
            self.pool.install(|| preparation.push(state)).map_err(EstimateError::from)?;
        } else {
            preparation.push(state).map_err(EstimateError::from)?;
        }
        Ok(self.pass_on()?)
    }
}
