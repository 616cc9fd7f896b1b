//! The estimate of a history that is there already.

use crate::error::{EstimateError, RunError};
use crate::estimate::Estimate;
use crate::options::Options;
use crate::pipeline::Estimator;
use crate::request::Request;
use percute_core::dynamics::{Balancing, Evaluation, Simulation};
use percute_core::history::{SinkError, Step, StepSink, StepSource};
use percute_core::observer::{Observer, Progress};
use percute_core::problem::Problem;
use std::ops::ControlFlow;
use thiserror::Error;

/// Estimates a history: from the same steps, the same bits as beside the run that made them. If the
/// observer breaks, the steps taken so far are estimated. The simulation is summed up from the steps.
/// `beside` takes every step that is estimated too, so that they need not be read again.
///
/// # Errors
/// [`RunError`]: a history that cannot be read or does not fit the problem, options out of range, maps
/// that cannot be kept.
pub fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    options: Options,
    request: &Request,
    beside: &mut dyn StepSink<D>,
    observer: &mut dyn Observer,
) -> Result<(Simulation, Estimate<D>), RunError> {
    let mut replay = Replay {
        evaluation: Evaluation::new(problem, source.times()),
        estimator: Estimator::new(problem, source.times(), options)?.keeping(request)?,
        balancing: Balancing::new(problem, source.times()),
        beside,
        observer,
        last: source.count().saturating_sub(1),
    };
    let interrupted = match source.replay(&mut replay) {
        Ok(()) => false,
        Err(error) if error.is::<Stopped>() => true,
        Err(error) => return Err(failed(error)),
    };
    let balance_over_time = replay.balancing.finish();
    let balance = balance_over_time.last().copied().unwrap_or_default();
    let steps = balance_over_time.len().saturating_sub(1);
    let estimate = replay.estimator.finish()?;
    Ok((Simulation { balance, balance_over_time, steps, interrupted }, estimate))
}

/// Takes the steps of a history.
struct Replay<'a, 'p, const D: usize, const N: usize> {
    evaluation: Evaluation<'p, D, N>,
    estimator: Estimator<'p, D, N>,
    balancing: Balancing<'p, D, N>,
    beside: &'a mut dyn StepSink<D>,
    observer: &'a mut dyn Observer,
    /// The last step that will come.
    last: usize,
}

/// The observer broke.
#[derive(Debug, Error)]
#[error("stopped")]
struct Stopped;

impl<const D: usize, const N: usize> StepSink<D> for Replay<'_, '_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        let state = self.evaluation.advance(step).map_err(EstimateError::from)?;
        self.estimator.push_state(&state)?;
        self.balancing.push_state(&state)?;
        self.beside.push_state(&state)?;
        let progress = Progress { stage: "estimating", done: step.index, total: self.last };
        if self.observer.observe(progress) == ControlFlow::Break(()) && step.index < self.last {
            return Err(Stopped.into());
        }
        Ok(())
    }
}

fn failed(error: SinkError) -> RunError {
    match error.downcast::<EstimateError>() {
        Ok(error) => RunError::Estimate(*error),
        Err(error) => RunError::Source(error),
    }
}
