//! A case simulated, and estimated beside the run.

use crate::case::CaseOf;
use crate::failure::Failure;
use percute_core::dynamics::{Simulation, SimulationError, simulate};
use percute_core::history::StepSink;
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Estimator, Options, Request};
use percute_io::history::Writer;

/// Simulates a case, stores its history if there is a file for it, and estimates its error. `beside` takes the
/// steps too. If the observer breaks, the file holds the steps done and the estimate is theirs.
///
/// # Errors
/// A start that the simulation refuses (the input's fault; its history file is removed), an unstable
/// run, a history that cannot be written, a failed estimate.
pub fn run<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    options: Options,
    request: &Request,
    history: Option<Writer<D>>,
    beside: &mut dyn StepSink<D>,
    observer: &mut dyn Observer,
) -> Result<(Simulation, Estimate<D>), Failure> {
    let estimator = Estimator::new(&case.problem, &case.times, options).and_then(|e| e.keeping(request));
    let mut estimator = estimator.map_err(percute_estimator::RunError::from)?;
    let simulation = stored(case, history, &mut (&mut estimator, beside), observer)?;
    Ok((simulation, estimator.finish().map_err(percute_estimator::RunError::from)?))
}

/// Simulates a case and stores its history. If the observer breaks, the file holds the steps done.
///
/// # Errors
/// As [`run`].
pub fn simulate_only<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    history: Writer<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, Failure> {
    stored(case, Some(history), &mut percute_core::history::Discard, observer)
}

/// Hands every step to the file, if there is one, and to `sink`.
fn stored<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    history: Option<Writer<D>>,
    sink: &mut dyn StepSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, Failure> {
    simulate_into(&case.problem, &case.times, history, sink, observer)
        .map_err(|error| case.refused_start(&error).map_or_else(|| error.into(), Failure::from))
}

/// Simulates a problem, and hands every step to the file of its history, if there is one, and then to `sink`. A run that
/// was stopped is finished like one that came to its end; a start that is refused leaves no file behind; after any other
/// error the file is left as it is.
///
/// # Errors
/// As [`simulate`]; what is wrong with the file comes as [`SimulationError::Sink`].
pub fn simulate_into<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    history: Option<Writer<D>>,
    sink: &mut dyn StepSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    // The file first: a step that cannot be estimated is still worth having.
    let mut sinks = (history, sink);
    let simulation = simulate(problem, times, &mut sinks, observer);
    match (simulation, sinks.0) {
        (Ok(simulation), Some(history)) => {
            let steps = simulation.steps;
            history.finish().map_err(|cause| SimulationError::Sink { step: steps, cause: cause.into() })?;
            Ok(simulation)
        }
        (Err(error @ SimulationError::StartsTooNear { .. }), Some(history)) => {
            let file = history.path().to_path_buf();
            drop(history);
            // What cannot be removed does no harm: it says itself how few steps it holds.
            let _ = std::fs::remove_file(file);
            Err(error)
        }
        (simulation, _) => simulation,
    }
}
