//! The estimate of a history that is there already.

use crate::error::{EstimateError, RunError};
use crate::estimate::Estimate;
use crate::options::Options;
use crate::pipeline::begin;
use crate::request::Request;
use percute_core::dynamics::{Balancing, Evaluation, Simulation};
use percute_core::history::{SinkError, StateSink, StepError, StepSource};
use percute_core::observer::{Observer, Progress};
use percute_core::problem::ProblemRef;
use std::ops::ControlFlow;
use thiserror::Error;

/// Estimates a history, [`estimate`](crate::estimate()).
pub(crate) fn estimate(
    problem: ProblemRef<'_>,
    source: &dyn StepSource,
    options: Options,
    request: &Request,
    beside: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<(Simulation, Estimate), RunError> {
    let mut pipeline = begin(problem, source.times(), options)?;
    pipeline.keep(request)?;
    pipeline.stop_at(observer.flag());
    let mut sinks = (pipeline, (Balancing::new(problem, source.times()), beside));
    let mut evaluation = Evaluation::new(problem, source.times());
    let last = source.count().saturating_sub(1);
    let replayed = source.replay(&mut |step| {
        sinks.accept(&evaluation.advance(step)?)?;
        let progress = Progress { stage: "estimating", done: step.index, total: last };
        if observer.observe(progress) == ControlFlow::Break(()) && step.index < last {
            return Err(ObserverBreak.into());
        }
        Ok(())
    });
    let (pipeline, (balancing, _)) = sinks;
    let interrupted = match replayed {
        Ok(()) => false,
        Err(error) if error.is::<ObserverBreak>() => true,
        Err(error) => return Err(failed(error)),
    };
    let balance_over_time = balancing.finish();
    let balance = balance_over_time.last().copied().unwrap_or_default();
    let steps = balance_over_time.len().saturating_sub(1);
    let estimate = pipeline.finish()?;
    Ok((Simulation { balance, balance_over_time, steps, interrupted }, estimate))
}

/// The observer broke.
#[derive(Debug, Error)]
#[error("stopped")]
struct ObserverBreak;

fn failed(error: SinkError) -> RunError {
    let error = match error.downcast::<StepError>() {
        Ok(error) => return RunError::Estimate((*error).into()),
        Err(error) => error,
    };
    match error.downcast::<EstimateError>() {
        Ok(error) => RunError::Estimate(*error),
        Err(error) => RunError::Source(error),
    }
}
