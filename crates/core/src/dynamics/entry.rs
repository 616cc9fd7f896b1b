//! The explicit solution of a problem of either dimension, compiled with this crate.

use super::{MissedContact, Simulation, SimulationError, central_difference, critical_step, evaluation, start};
use crate::history::{Checkpoint, SinkError, StateSink, StepSource};
use crate::ids::ElementId;
use crate::observer::Observer;
use crate::on_problem;
use crate::problem::ProblemRef;
use crate::time::TimeGrid;

/// Runs a problem over a time grid and hands every step n = 0 … N to `sink`.
///
/// The observer is asked after each step; if it breaks, the run ends cleanly there.
///
/// # Errors
/// [`SimulationError`]: an unstable run, a start too near to an obstacle, a sink that fails.
pub fn simulate<'p>(
    problem: impl Into<ProblemRef<'p>>,
    times: &TimeGrid,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    run(problem.into(), times, Some(1), None, sink, observer)
}

/// The same on so many threads, by default one for each core. The result does not depend on their number. A mesh that
/// is too small for threads to pay runs on one, and so does one whose order has no strips, or if threads cannot be
/// started.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_threaded<'p>(
    problem: impl Into<ProblemRef<'p>>,
    times: &TimeGrid,
    threads: Option<usize>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    run(problem.into(), times, threads, None, sink, observer)
}

/// Goes on from a checkpoint of a run of the same problem over the same instants. `sink` gets the steps after it, bit
/// by bit those of a run that was not interrupted.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// If the fields do not have one value for each node.
pub fn resume<'p>(
    problem: impl Into<ProblemRef<'p>>,
    times: &TimeGrid,
    threads: Option<usize>,
    checkpoint: &Checkpoint,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    run(problem.into(), times, threads, Some(checkpoint), sink, observer)
}

fn run(
    problem: ProblemRef<'_>,
    times: &TimeGrid,
    threads: Option<usize>,
    checkpoint: Option<&Checkpoint>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    on_problem!(problem, problem => {
        central_difference::simulate(problem, times, threads, checkpoint, sink, observer)
    })
}

/// Hands the states of all steps of a history to `sink`.
///
/// # Errors
/// A step that cannot be read or does not fit, or what the sink fails to take.
pub fn replay<'p>(
    problem: impl Into<ProblemRef<'p>>,
    source: &dyn StepSource,
    sink: &mut dyn StateSink,
) -> Result<(), SinkError> {
    evaluation::replay(problem.into(), source, sink)
}

/// Δt_c (s) from the largest eigenvalue of M⁻¹K by a matrix-free Lanczos iteration.
///
/// The Ritz value approaches ω²_max from below; its residual is added and the element-wise bound
/// caps the sum. At least 10 ln n vectors are used: with a random start the expected relative
/// error of the Ritz value is then below 0.103 (ln n/(k−1))² ≈ 1e-3 for any spectrum
/// (Kuczyński and Woźniakowski, 1992), half of it for ω, and in practice far smaller. The problem keeps it.
#[must_use]
pub fn critical_time_step<'p>(problem: impl Into<ProblemRef<'p>>) -> f64 {
    fn of(problem: ProblemRef<'_>) -> f64 {
        on_problem!(problem, problem => problem.critical_step(|| critical_step::critical_time_step(problem)))
    }
    of(problem.into())
}

/// Δt_c of one element alone with its lumped mass (s).
#[must_use]
pub fn time_step_of_element<'p>(problem: impl Into<ProblemRef<'p>>, element: ElementId) -> f64 {
    fn of(problem: ProblemRef<'_>, element: ElementId) -> f64 {
        on_problem!(problem, problem => critical_step::time_step_of_element(problem, element))
    }
    of(problem.into(), element)
}

/// Refuses a start that a simulation refuses, before anything is made for it.
///
/// # Errors
/// [`SimulationError::StartsTooNear`].
pub fn check_start<'p>(problem: impl Into<ProblemRef<'p>>, times: &TimeGrid) -> Result<(), SimulationError> {
    fn of(problem: ProblemRef<'_>, times: &TimeGrid) -> Result<(), SimulationError> {
        on_problem!(problem, problem => start::check_start(problem, times))
    }
    of(problem.into(), times)
}

/// A sink that looks for nodes inside other bodies, in a run of so many steps.
///
/// Its error is [`SimulationError::Missed`].
#[must_use]
pub fn missed_contact<'p>(problem: impl Into<ProblemRef<'p>>, steps: usize) -> Box<dyn StateSink + 'p> {
    fn of(problem: ProblemRef<'_>, steps: usize) -> Box<dyn StateSink + '_> {
        on_problem!(problem, problem => Box::new(MissedContact::new(problem, steps)))
    }
    of(problem.into(), steps)
}
