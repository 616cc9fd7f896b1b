//! Histories of other programs: what they lack is derived.

mod balance;
mod complete;
mod window;

pub use complete::{Completed, Derived, Lacks};

use crate::failure::Failure;
use crate::run::{self, Analysis, Results};
use percute_core::history::{SinkError, StepSource};
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::RunError;

/// What is known of the origin of a history of another program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// The parts that it lacks.
    pub lacks: Lacks,
    /// The parts that were derived before.
    pub derived: Vec<Derived>,
}

/// What was found about a history of another program before its estimate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked {
    /// The parts that were derived.
    pub derived: Vec<Derived>,
    /// The last instant (s), if it was left out because its contact forces are not known.
    pub left_out: Option<f64>,
}

/// The results for a history.
#[derive(Clone, Debug)]
pub struct Graded<const D: usize> {
    /// Those of the estimate.
    pub results: Results<D>,
    /// The instants that were estimated.
    pub times: TimeGrid,
    /// What was found before; none for a history of percute.
    pub checked: Option<Checked>,
}

/// Derives the missing parts of a history of another program, and analyses its steps.
///
/// # Errors
/// As [`run::estimate`].
pub fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    origin: &Origin,
    analysis: &Analysis,
    observer: &mut dyn Observer,
) -> Result<Graded<D>, Failure> {
    let complete = Completed::new(problem, source, origin.lacks).map_err(unread)?;
    let derived = [complete.derived(), &origin.derived].concat();
    let checked = Checked { derived, left_out: complete.left_out() };
    let results = run::estimate(problem, &complete, analysis, observer)?;
    Ok(Graded { results, times: complete.times().clone(), checked: Some(checked) })
}

fn unread(cause: SinkError) -> Failure {
    Failure::from_sink(cause, RunError::Source)
}
