//! A case simulated and estimated.

use crate::case::{Case, CaseOf};
use crate::failure::Failure;
use crate::report::Report;
use percute_core::observer::Observer;
use percute_estimator::{Options, Request, RunError};
use std::time::Instant;

/// What a run takes from its caller rather than from the case: nothing of it changes the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Number of threads; one for each core by default.
    pub threads: Option<usize>,
    /// How many steps are estimated at once.
    pub window: Option<usize>,
}

/// Simulates a case and estimates its error. If the observer breaks, the report is that of the
/// steps done.
///
/// # Errors
/// A start that the simulation refuses (the input's fault), an unstable run, a failed estimate.
pub fn run(case: &Case, settings: Settings, observer: &mut dyn Observer) -> Result<Report, Failure> {
    match case {
        Case::Bar(case) => run_one(case, settings, observer),
        Case::Plane(case) => run_one(case, settings, observer),
    }
}

fn run_one<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    settings: Settings,
    observer: &mut dyn Observer,
) -> Result<Report, Failure> {
    let options = Options { threads: settings.threads, window: settings.window, ..case.options };
    let start = Instant::now();
    let ended = percute_estimator::run(&case.problem, &case.times, options, &Request::default(), observer);
    let (simulation, estimate) = ended.map_err(|error| match &error {
        RunError::Simulation(cause) => case.refused_start(cause).map_or(Failure::Run(error), Failure::Case),
        RunError::Estimate(_) | RunError::Source(_) => Failure::Run(error),
    })?;
    Ok(Report::new(&case.subject(), options, &simulation, estimate, start.elapsed().as_secs_f64()))
}
