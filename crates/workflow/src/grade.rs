//! The estimate of a history of another program: what it lacks is derived, its consistency is checked, its samples are
//! filled.

use crate::failure::Failure;
use crate::foreign::{Between, CheckResult, Checked, Completed, Lacks, Origin, Refusal, check, first_look, started};
use crate::run::{self, Analysis, Results};
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, StepSource};
use percute_core::observer::Observer;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::{Request, RunError};

/// The results for a history.
#[derive(Clone, Debug)]
pub struct Graded {
    /// Those of the estimate.
    pub results: Results,
    /// The instants that were estimated.
    pub times: TimeGrid,
    /// What was found before; none for a history of percute.
    pub checked: Option<Checked>,
}

/// Derives the missing parts of a history of another program, checks its consistency, and analyses its steps. A history
/// that is not consistent is refused, unless it is to be accepted.
///
/// # Errors
/// An inconsistent history; as [`run::estimate`].
pub fn estimate(
    problem: &AnyProblem,
    source: &dyn StepSource,
    origin: &Origin,
    analysis: &Analysis,
    observer: &mut dyn Observer,
) -> Result<Graded, Failure> {
    let critical = critical_time_step(problem);
    let refuse = |refusal| refused(refusal, origin);
    let unfit = first_look(problem, source, critical, origin).map_err(refuse)?;
    let complete = Completed::new(problem, source, origin.lacks).map_err(unread)?;
    let derived = [complete.derived(), &origin.derived].concat();
    let CheckResult { consistency, samples, shifted, contradiction } =
        check(problem, &complete, critical, &derived, origin.accept).map_err(refuse)?;
    let contradiction = unfit.or(contradiction);
    let program = origin.program.clone();
    let mut checked =
        Checked { program, derived, left_out: complete.left_out(), consistency, samples, shifted, contradiction };
    let last = complete.times().step_count();
    let between = samples.map(|_| Between::new(&complete, problem.dimension(), critical)).transpose();
    let between = between.map_err(|error| unread(error.into()))?.filter(|all| all.times().step_count() > last);
    let Some(between) = between else {
        let analysis = &requested(analysis, |step| step.min(last));
        let results = run::estimate(problem, &started(problem, &complete), analysis, observer)?;
        return Ok(Graded { results, times: complete.times().clone(), checked: Some(checked) });
    };
    let filled = Completed::new(problem, &between, Lacks { reaction: true, touching: true }).map_err(unread)?;
    checked.derived = filled.derived().to_vec();
    let analysis = &requested(analysis, |step| between.starts[step.min(between.starts.len() - 1)]);
    let results = run::estimate(problem, &started(problem, &filled), analysis, observer)?;
    checked.consistency.energy = results.simulation.balance.energy_drift;
    Ok(Graded { results, times: filled.times().clone(), checked: Some(checked) })
}

/// The analysis with its maps at other steps.
fn requested(analysis: &Analysis, step: impl Fn(usize) -> usize) -> Analysis {
    let Request { steps, fields } = &analysis.request;
    let mut steps: Vec<usize> = steps.iter().map(|&n| step(n)).collect();
    steps.dedup();
    Analysis { request: Request { steps, fields: *fields }, ..analysis.clone() }
}

fn refused(refusal: Refusal, origin: &Origin) -> Failure {
    match refusal {
        Refusal::Unread(cause) => unread(cause),
        Refusal::Inconsistent(contradiction) => Failure::Inconsistent { file: origin.file.clone(), contradiction },
    }
}

fn unread(cause: SinkError) -> Failure {
    Failure::from_sink(cause, RunError::Source)
}
