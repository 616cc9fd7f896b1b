//! Timed runs on one problem: the clock starts with the first state, after the setup.

use crate::{Block, Failure};
use percute_core::dynamics::simulate_threaded;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::observer::Unobserved;
use percute_core::time::{TimeError, TimeGrid};
use percute_estimator::{Estimate, Estimator, Options};
use rustix::time::{ClockId, clock_gettime};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// A clock: the time since a fixed instant.
pub type Clock = fn() -> Duration;

/// Time on the wall.
#[must_use]
pub fn wall() -> Duration {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// Processor time of all threads. On one thread of a quiet machine it is the time on the wall; on a busy one it does
/// not contain the time of others.
#[must_use]
pub fn processor() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.unsigned_abs() as u32)
}

/// Hands states on, and notes when the first came.
#[derive(Clone, Debug)]
struct Timed<S> {
    /// The sink that takes the states.
    inner: S,
    clock: Clock,
    first: Option<Duration>,
}

impl<S> Timed<S> {
    fn new(inner: S, clock: Clock) -> Self {
        Self { inner, clock, first: None }
    }
}

impl<S: StateSink> StateSink for Timed<S> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.first.get_or_insert_with(self.clock);
        self.inner.accept(state)
    }
}

/// Keeps the displacement of the last step only.
#[derive(Clone, Debug)]
struct Last {
    step: usize,
    displacement: Vec<f64>,
}

impl StateSink for Last {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
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

/// The time of a simulation of so many steps on so many threads, and the displacement after them (m).
///
/// # Errors
/// A simulation that fails.
pub fn simulated(
    block: &Block,
    count: usize,
    threads: Option<usize>,
    clock: Clock,
) -> Result<(Duration, Vec<f64>), Failure> {
    let mut sink = Timed::new(Last { step: count, displacement: Vec::new() }, clock);
    simulate_threaded(&block.problem, &steps(block.step, count)?, threads, &mut sink, &mut Unobserved)?;
    let end = clock();
    Ok((end - sink.first.unwrap_or(end), sink.inner.displacement))
}

/// The time of a simulation of so many steps with its estimate, both on the threads of the options, and the estimate.
///
/// # Errors
/// A simulation or an estimate that fails.
pub fn estimated(block: &Block, count: usize, options: Options, clock: Clock) -> Result<(Duration, Estimate), Failure> {
    let times = steps(block.step, count)?;
    let estimator = Estimator::new(&block.problem, &times, options)?;
    let mut sink = Timed::new(estimator, clock);
    simulate_threaded(&block.problem, &times, options.threads, &mut sink, &mut Unobserved)?;
    let start = sink.first;
    let estimate = sink.inner.finish()?;
    let end = clock();
    Ok((end - start.unwrap_or(end), estimate))
}
