//! A simulation with its estimate beside it.

use percute_core::dynamics::{Simulation, simulate};
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, Estimator, Options, Request};

/// Simulates and estimates; if the observer breaks, the steps done are estimated.
pub(crate) fn run<const D: usize>(
    problem: &Problem<D>,
    times: &TimeGrid,
    options: Options,
    request: &Request,
    observer: &mut dyn Observer,
) -> (Simulation, Estimate) {
    let mut estimator = Estimator::new(problem, times, options).unwrap().keeping(request).unwrap();
    let simulation = simulate(problem, times, &mut estimator, observer).unwrap();
    (simulation, estimator.finish().unwrap())
}
