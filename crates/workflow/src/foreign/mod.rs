//! Histories of other programs: what they lack is derived, and their consistency is checked.

mod balance;
mod causes;
mod complete;
mod limits;
mod measure;
mod samples;
mod window;

pub use complete::{Completed, Derived, Lacks};
pub use measure::Consistency;
pub(crate) use samples::Between;
pub use samples::Samples;

use crate::message::percent;
use causes::Suspect;
use limits::BALANCE;
pub(crate) use limits::exceeded;
use measure::{Trial, measure};
use percute_core::history::{SinkError, StepSource};
use percute_core::problem::Problem;
use percute_core::time::is_stable;
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
    /// Its samples, if they are farther apart than the steps of a solver.
    pub samples: Option<Samples>,
}

/// Why a history cannot be graded.
pub(crate) enum Refusal {
    Unread(SinkError),
    /// A figure over its limit, with the likely cause.
    Inconsistent {
        figure: String,
        cause: Option<String>,
    },
}

impl From<SinkError> for Refusal {
    fn from(error: SinkError) -> Self {
        Self::Unread(error)
    }
}

/// The samples, if the steps of the solver were shorter: beyond the critical step (s), or by the accelerations.
fn samples<const D: usize>(
    source: &dyn StepSource<D>,
    found: &Consistency,
    critical: f64,
    origin: &Origin,
) -> Result<Option<Samples>, Refusal> {
    let (count, distance) = (source.count(), source.times().longest_step());
    let differs = found.acceleration.filter(|differs| *differs > BALANCE);
    if differs.is_none() && is_stable(distance, critical) {
        return Ok(None);
    }
    let samples = Samples { count, distance, critical_steps: distance / critical };
    match (found.velocity, found.acceleration) {
        (Some(_), Some(_)) => Ok(Some(samples)),
        (None, Some(differs)) if found.balance <= BALANCE && !origin.accept => Err(Refusal::Inconsistent {
            figure: format!("its accelerations differ from those of the displacements by {}", percent(differs)),
            cause: Some("the instants are samples, not the steps of the solver; give velocities too".to_string()),
        }),
        _ => Ok(None),
    }
}

/// The figures of a history but for its energy; figures over their limits are an error, with the likely cause.
pub(crate) fn check<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    critical: f64,
    origin: &Origin,
) -> Result<(Consistency, Option<Samples>), Refusal> {
    let (found, evidence) = measure(problem, source, Trial::default())?;
    let samples = samples(source, &found, critical, origin)?;
    let sampled = samples.is_some();
    let mut exceeded = exceeded(&found);
    // These compare an instant with the next step of the solver, which a sample does not have.
    let of_steps = ["velocity", "touching", "gap_under_force"];
    exceeded.retain(|excess| !sampled || !of_steps.contains(&excess.name));
    if let (Some(first), false) = (exceeded.first(), origin.accept) {
        let suspect = Suspect { problem, source, found: &found, evidence: &evidence };
        let cause = suspect.cause(&exceeded)?;
        let figure = exceeded.iter().find(|excess| excess.name == "balance").unwrap_or(first).what.clone();
        return Err(Refusal::Inconsistent { figure, cause });
    }
    Ok((found, samples))
}
