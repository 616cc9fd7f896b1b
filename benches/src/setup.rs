//! All that precedes the first step of a run.

use crate::block::problem;
use crate::run::steps;
use crate::{Block, Failure, Motion, Order};
use percute_core::dynamics::{Dynamics, critical_time_step};
use percute_estimator::{Estimator, Options};
use std::hint::black_box;

/// Steps of the run that is set up.
const STEPS: usize = 1000;

/// Does again what a run of this block does before its first step: mesh, problem, critical step, local order, operators
/// of the integrator and, with options, the estimator.
///
/// # Errors
/// A mesh or options that are refused.
pub fn setup(cells: [usize; 2], order: Order, block: &Block, options: Option<Options>) -> Result<(), Failure> {
    let stated = problem(order.mesh(cells)?, Motion::Impact, block.gap)?;
    black_box(critical_time_step(&stated));
    let local = stated.mesh().local_numbering().map(|numbering| stated.renumbered(&numbering));
    let problem = local.as_ref().unwrap_or(&stated);
    let times = steps(block.step, STEPS)?;
    black_box(Dynamics::new(problem, &times));
    if let Some(options) = options {
        black_box(Estimator::new(problem, &times, options)?);
    }
    Ok(())
}
