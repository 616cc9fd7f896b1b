//! Timed runs on one problem: the clock starts with the first state, after the setup.

use crate::{Block, Failure};
use percute_core::dynamics::simulate;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::observer::Unobserved;
use percute_core::time::{TimeError, TimeGrid};
use percute_estimator::{Estimate, Estimator, Options};
use std::time::{Duration, Instant};

/// Hands states on, and notes when the first came.
#[derive(Clone, Debug)]
pub struct Timed<S> {
    /// The sink that takes the states.
    pub inner: S,
    first: Option<Instant>,
}

impl<S> Timed<S> {
    /// Before the first state.
    #[must_use]
    pub fn new(inner: S) -> Self {
        Self { inner, first: None }
    }

    /// Time since the first state.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.first.map_or(Duration::ZERO, |first| first.elapsed())
    }
}

impl<S: StateSink<2>> StateSink<2> for Timed<S> {
    fn accept(&mut self, state: &State<'_, 2>) -> Result<(), SinkError> {
        self.first.get_or_insert_with(Instant::now);
        self.inner.accept(state)
    }
}

/// Keeps the displacement of the last step only.
#[derive(Clone, Debug)]
pub struct Last {
    step: usize,
    displacement: Vec<[f64; 2]>,
}

impl StateSink<2> for Last {
    fn accept(&mut self, state: &State<'_, 2>) -> Result<(), SinkError> {
        if state.step().index == self.step {
            self.displacement = state.step().displacement.to_vec();
        }
        Ok(())
    }
}

/// `count` steps of this length (s).
///
/// # Errors
/// No steps.
pub fn steps(step: f64, count: usize) -> Result<TimeGrid, TimeError> {
    TimeGrid::uniform(step * count as f64, count)
}

/// The time of a simulation of so many steps, and the displacement after them (m).
///
/// # Errors
/// A simulation that fails.
pub fn simulated(block: &Block, count: usize) -> Result<(Duration, Vec<[f64; 2]>), Failure> {
    let mut sink = Timed::new(Last { step: count, displacement: Vec::new() });
    simulate(&block.problem, &steps(block.step, count)?, &mut sink, &mut Unobserved)?;
    Ok((sink.elapsed(), sink.inner.displacement))
}

/// The time of a simulation of so many steps with its estimate, and the estimate.
///
/// # Errors
/// A simulation or an estimate that fails.
pub fn estimated(block: &Block, count: usize, options: Options) -> Result<(Duration, Estimate<2>), Failure> {
    let times = steps(block.step, count)?;
    let estimator = Estimator::new(&block.problem, &times, options)?;
    let mut sink = Timed::new(estimator);
    simulate(&block.problem, &times, &mut sink, &mut Unobserved)?;
    let start = sink.first;
    let estimate = sink.inner.finish()?;
    Ok((start.map_or(Duration::ZERO, |first| first.elapsed()), estimate))
}
