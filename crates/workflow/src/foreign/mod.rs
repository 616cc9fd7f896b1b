//! Histories of other programs: what they lack is derived, and their consistency is checked.

mod balance;
mod causes;
mod complete;
mod limits;
mod measure;
mod window;

pub use complete::{Completed, Derived, Lacks};
pub use measure::Consistency;

use crate::failure::Failure;
use crate::run::{self, Analysis, Results};
use causes::Suspect;
use limits::exceeded;
use measure::{Trial, measure};
use percute_core::history::{SinkError, StepSource};
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::RunError;
use std::path::PathBuf;

/// What is known of the origin of a history of another program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// Its file, if it is in one.
    pub file: Option<PathBuf>,
    /// The parts that it lacks.
    pub lacks: Lacks,
    /// The parts that were derived before.
    pub derived: Vec<Derived>,
    /// Whether it is estimated although it is not consistent.
    pub accept: bool,
}

/// What was found about a history of another program before its estimate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked {
    /// The parts that were derived.
    pub derived: Vec<Derived>,
    /// The last instant (s), if it was left out because its contact forces are not known.
    pub left_out: Option<f64>,
    /// How consistent it is.
    pub consistency: Consistency,
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

/// Derives the missing parts of a history of another program, checks its consistency, and analyses its steps. A history that
/// is not consistent is refused, unless it is to be accepted.
///
/// # Errors
/// An inconsistent history; as [`run::estimate`].
pub fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    origin: &Origin,
    analysis: &Analysis,
    observer: &mut dyn Observer,
) -> Result<Graded<D>, Failure> {
    let complete = Completed::new(problem, source, origin.lacks).map_err(unread)?;
    let derived = [complete.derived(), &origin.derived].concat();
    let consistency = check(problem, &complete, origin)?;
    let checked = Checked { derived, left_out: complete.left_out(), consistency };
    let results = run::estimate(problem, &complete, analysis, observer)?;
    Ok(Graded { results, times: complete.times().clone(), checked: Some(checked) })
}

/// The figures of a history; figures over their limits are an error, with the likely cause.
fn check<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    origin: &Origin,
) -> Result<Consistency, Failure> {
    let (mut found, evidence) = measure(problem, source, Trial::default()).map_err(unread)?;
    let exceeded = exceeded(&found);
    if let (Some(first), false) = (exceeded.first(), origin.accept) {
        let suspect = Suspect { problem, source, found: &found, evidence: &evidence };
        let cause = suspect.cause(&exceeded).map_err(unread)?;
        let figure = exceeded.iter().find(|excess| excess.name == "balance").unwrap_or(first).what.clone();
        return Err(Failure::Inconsistent { file: origin.file.clone(), figure, cause });
    }
    let balance = run::balance(problem, source).map_err(unread)?;
    found.energy = balance.last().map_or(0.0, |last| last.energy_drift);
    Ok(found)
}

fn unread(cause: SinkError) -> Failure {
    Failure::from_sink(cause, RunError::Source)
}
