//! The explicit solution of bars and plane bodies, compiled with this crate.

use super::{Simulation, SimulationError, central_difference, critical_step, evaluation};
use crate::history::{Checkpoint, SinkError, StateSink, StepSource};
use crate::observer::Observer;
use crate::problem::Problem;
use crate::simplex::{Shape, instance};
use crate::time::TimeGrid;

type Simulate<const D: usize, const N: usize> = fn(
    &Problem<D, N>,
    &TimeGrid,
    Option<usize>,
    Option<&Checkpoint<D>>,
    &mut dyn StateSink<D>,
    &mut dyn Observer,
) -> Result<Simulation, SimulationError>;

/// Its functions for one element.
struct Functions<const D: usize, const N: usize> {
    simulate: Simulate<D, N>,
    replay: fn(&Problem<D, N>, &dyn StepSource<D>, &mut dyn StateSink<D>) -> Result<(), SinkError>,
    critical_time_step: fn(&Problem<D, N>) -> f64,
}

static BAR: Functions<1, 2> = Functions::NEW;
static TRIANGLE: Functions<2, 3> = Functions::NEW;

impl<const D: usize, const N: usize> Functions<D, N> {
    const NEW: Self = Self {
        simulate: central_difference::simulate,
        replay: evaluation::replay,
        critical_time_step: critical_step::critical_time_step,
    };

    fn of(problem: &Problem<D, N>) -> &'static Self {
        instance(match problem.mesh().simplex().shape() {
            Shape::Bar => &BAR,
            Shape::Triangle => &TRIANGLE,
        })
    }
}

/// Runs a problem over a time grid and hands every step n = 0 … N to `sink`.
///
/// The observer is asked after each step; if it breaks, the run ends cleanly there.
///
/// # Errors
/// [`SimulationError`]: an unstable run, a start too near to an obstacle, a sink that fails.
pub fn simulate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    sink: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    simulate_threaded(problem, times, Some(1), sink, observer)
}

/// The same on so many threads, by default one for each core. The result does not depend on their number. A mesh that
/// is too small for threads to pay runs on one, and so does one whose order has no strips, or if threads cannot be
/// started.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_threaded<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    threads: Option<usize>,
    sink: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    (Functions::of(problem).simulate)(problem, times, threads, None, sink, observer)
}

/// Goes on from a checkpoint of a run of the same problem over the same instants. `sink` gets the steps after it, bit
/// by bit those of a run that was not interrupted.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// If the fields do not have one value for each node.
pub fn resume<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    threads: Option<usize>,
    checkpoint: &Checkpoint<D>,
    sink: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    (Functions::of(problem).simulate)(problem, times, threads, Some(checkpoint), sink, observer)
}

/// Hands the states of all steps of a history to `sink`.
///
/// # Errors
/// A step that cannot be read or does not fit, or what the sink fails to take.
pub fn replay<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    sink: &mut dyn StateSink<D>,
) -> Result<(), SinkError> {
    (Functions::of(problem).replay)(problem, source, sink)
}

/// Δt_c (s) from the largest eigenvalue of M⁻¹K by a matrix-free Lanczos iteration.
///
/// The Ritz value approaches ω²_max from below; its residual is added and the element-wise bound
/// caps the sum. At least 10 ln n vectors are used: with a random start the expected relative
/// error of the Ritz value is then below 0.103 (ln n/(k−1))² ≈ 1e-3 for any spectrum
/// (Kuczyński and Woźniakowski, 1992), half of it for ω, and in practice far smaller. The problem keeps it.
#[must_use]
pub fn critical_time_step<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    problem.critical_step(|| (Functions::of(problem).critical_time_step)(problem))
}
