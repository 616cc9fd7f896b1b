//! From steps to an estimate: steps are prepared one after the other ([`prepare`]), gathered in
//! windows, worked on in parallel ([`window`]), and summed in a fixed order ([`totals`]).

mod backlog;
mod far;
#[cfg(test)]
mod fixture;
mod maps;
mod near;
mod near_elements;
mod non_matching;
mod prepare;
mod sampled_interval;
mod sampled_levels;
mod sampling;
mod schedule;
mod separation;
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
use percute_core::cell::CellKind;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::observer::StopFlag;
use percute_core::problem::{Problem, ProblemRef};
use percute_core::time::TimeGrid;
use prepare::Preparation;
use rayon::ThreadPool;
use std::fmt::Debug;
use window::LevelWindow;
pub(crate) use window::memory;

/// From so many elements on, a step takes much longer than to hand it to the threads, some 10 µs.
const THREADED: usize = 20_000;

/// From so many elements on a stop is looked for within a window. A smaller one takes some 0.1 s, and is not given up.
const STOPPED: usize = 100_000;

/// From steps to an estimate, for any element of a dimension.
pub(crate) trait Steps: StateSink + Debug + Send {
    /// [`Estimator::keeping`](crate::Estimator::keeping).
    fn keep(&mut self, request: &Request) -> Result<(), EstimateError>;

    /// [`Estimator::stopping`](crate::Estimator::stopping).
    fn stop_at(&mut self, flag: StopFlag);

    /// [`Estimator::finish`](crate::Estimator::finish).
    fn finish(self: Box<Self>) -> Result<Estimate, EstimateError>;
}

/// Begins an estimate, before the first step.
pub(crate) fn begin<'p>(
    problem: ProblemRef<'p>,
    times: &'p TimeGrid,
    options: Options,
) -> Result<Box<dyn Steps + 'p>, EstimateError> {
    Ok(match problem {
        ProblemRef::D1(bar) => Box::new(Pipeline::<1, 2>::new(bar, times, options)?),
        ProblemRef::D2(plane) => Box::new(Pipeline::<2, 3>::new(plane, times, options)?),
        ProblemRef::D3(solid) => Box::new(Pipeline::<3, 4>::new(solid, times, options)?),
    })
}

/// The work of an [`Estimator`](crate::Estimator).
#[derive(Debug)]
pub(crate) struct Pipeline<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    every: Sampling,
    pool: ThreadPool,
    preparation: Preparation<'p, D, N>,
    window: LevelWindow<'p, D, N>,
}

impl<'p, const D: usize, const N: usize> Pipeline<'p, D, N> {
    /// Before the first step.
    pub(crate) fn new(problem: &'p Problem<D>, times: &'p TimeGrid, options: Options) -> Result<Self, EstimateError> {
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
        if problem.mesh().kind() == CellKind::Tetrahedron && options.reconstruction != Reconstruction::Corrected {
            return Err(EstimateError::SolidReconstruction);
        }
        if problem.is_finite() && !options.balances_turning(D) {
            return Err(EstimateError::Finite);
        }
        let non_matching = problem.conditions().interfaces.iter().find(|interface| !interface.is_matching());
        if let Some(interface) = non_matching.filter(|_| options.reconstruction != Reconstruction::Corrected) {
            return Err(EstimateError::NotMatching { groups: interface.groups().map(str::to_string) });
        }
        // A pool of its own: a process forked later must not wait for threads it does not have.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads.unwrap_or(0)).build();
        let pool = pool.map_err(|e| EstimateError::Threads { cause: e.to_string() })?;
        let spacing = options.spacing(problem, times);
        if may_need_a_file::<D, N>(problem, times.step_count() / spacing + 1, spacing) {
            ScratchFile::check()?;
        }
        let mut window = LevelWindow::new(problem, times, &options, Maps::new(Request::default(), problem)?);
        pool.install(|| window.make_room());
        let mut preparation = Preparation::new(problem, times, &options);
        preparation.prepare(&window.equilibration.elements);
        Ok(Self { problem, times, every: options.every, pool, preparation, window })
    }

    /// Hands the levels that are ready to the window.
    fn pass_on(&mut self) -> Result<(), EstimateError> {
        while let Some(level) = self.preparation.next_ready() {
            self.window.push(&self.pool, level, &mut self.preparation)?;
        }
        Ok(())
    }
}

impl<const D: usize, const N: usize> Steps for Pipeline<'_, D, N> {
    fn keep(&mut self, request: &Request) -> Result<(), EstimateError> {
        request.check(self.times, self.every.stride())?;
        if self.every == Sampling::Auto {
            self.preparation.request(&request.steps);
        }
        self.window.maps = Maps::new(request.clone(), self.problem)?;
        Ok(())
    }

    fn stop_at(&mut self, flag: StopFlag) {
        if self.problem.mesh().element_count() >= STOPPED {
            self.window.stop_at(flag);
        }
    }

    fn finish(mut self: Box<Self>) -> Result<Estimate, EstimateError> {
        if self.preparation.count() < 2 {
            return Err(EstimateError::TooFewSteps { count: self.preparation.count() });
        }
        self.preparation.finish()?;
        self.pass_on()?;
        let Self { pool, mut preparation, window, .. } = *self;
        let estimate = window.finish(&pool, &mut preparation)?;
        if estimate.is_finite() { Ok(estimate) } else { Err(EstimateError::Overflow) }
    }
}

impl<const D: usize, const N: usize> StateSink for Pipeline<'_, D, N> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
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
