//! Histories of other programs: what they lack is derived, and their consistency is checked.

mod attempt;
mod axes;
mod balance;
mod causes;
mod complete;
mod conditions;
mod contact;
mod derive;
mod diagnosis;
mod ends;
mod figures;
mod gaps;
mod holding;
mod instants;
mod interface_balance;
mod limits;
mod long_steps;
mod mass;
mod measure;
mod missing_instants;
mod moduli;
mod nearness;
mod of_balance;
mod orders;
mod pairs;
mod penalty;
mod planes;
mod quantity;
mod residual;
mod rounded;
mod samples;
mod skipped;
mod start;
mod surface;
mod systems;
mod travel;
mod units;
mod velocities;
mod window;

pub use complete::{Completed, Derived, Lacks};
pub use figures::Consistency;
pub(crate) use samples::Between;
pub use samples::Samples;
use samples::{lacking, too_far};
pub(crate) use start::started;

use crate::step_filter::StepFilter;
pub(crate) use causes::REVERSED;
use diagnosis::Diagnosis;
pub(crate) use ends::runs_backwards;
use limits::{BALANCE, Excess, exceeded, through_planes};
pub(crate) use limits::{by_a_penalty, is_off_contact, off_contact};
use measure::measure;
use percute_core::dynamics::{Balancing, Evaluation};
use percute_core::history::{SinkError, StateSink, StepSource};
use percute_core::problem::AnyProblem;
use std::cell::RefCell;
use std::path::PathBuf;

/// What is known of the origin of a history of another program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// The program that simulated it, if its name is known.
    pub program: Option<String>,
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
    /// The program that simulated it, if its name is known.
    pub program: Option<String>,
    /// The parts that were derived.
    pub derived: Vec<Derived>,
    /// The last instant (s), if it was left out because its contact forces are not known.
    pub left_out: Option<f64>,
    /// How consistent it is.
    pub consistency: Consistency,
    /// Its samples, if they are farther apart than the steps of a solver.
    pub samples: Option<Samples>,
    /// That its contact forces fit another step better, if they do.
    pub shifted: Option<String>,
    /// Why it would have been refused if it had not been accepted as it is.
    pub contradiction: Option<Contradiction>,
}

/// A history that contradicts itself or its problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Contradiction {
    /// The figure over its limit.
    pub figure: String,
    /// Its likely cause.
    pub cause: Option<String>,
    /// Whether it can be estimated as it is: it starts from the displacement of its problem.
    pub can_be_accepted: bool,
}

/// What a check found.
pub(crate) struct CheckResult {
    pub(crate) consistency: Consistency,
    pub(crate) samples: Option<Samples>,
    /// That contact forces fit another step better, if they do.
    pub(crate) shifted: Option<String>,
    /// Why it is refused, unless it is to be accepted.
    pub(crate) contradiction: Option<Contradiction>,
}

/// Why a history cannot be graded.
pub(crate) enum Refusal {
    Unread(SinkError),
    Inconsistent(Contradiction),
}

impl From<SinkError> for Refusal {
    fn from(error: SinkError) -> Self {
        Self::Unread(error)
    }
}

/// What can be told before any work: displacements that do not fit the velocities, and samples that are too far apart
/// for an estimate, with the likely cause.
pub(crate) fn first_look(
    problem: &AnyProblem,
    source: &dyn StepSource,
    critical: f64,
    origin: &Origin,
) -> Result<Option<Contradiction>, Refusal> {
    let unfit = travel::contradiction(problem, source)?;
    if let Some(contradiction) = unfit.clone().filter(|_| !origin.accept) {
        return Err(Refusal::Inconsistent(contradiction));
    }
    let lacks = [(origin.lacks.reaction, Derived::Reaction), (origin.lacks.touching, Derived::Touching)];
    let lacks = lacks.into_iter().filter(|(lacks, _)| *lacks).map(|(_, part)| part);
    let derived: Vec<Derived> = origin.derived.iter().copied().chain(lacks).collect();
    if let Some((figure, way_out)) = too_far(source.times(), critical) {
        let (found, evidence) = measure(problem, source, &derived, 0)?;
        if evidence.given == [true; 2] {
            let diagnosis = Diagnosis { problem, source, derived: &derived, found: &found, evidence: &evidence };
            let cause = if found.balance > BALANCE { diagnosis.in_other_units()? } else { None };
            let cause = Some(cause.unwrap_or(way_out));
            return Err(Refusal::Inconsistent(Contradiction { figure, cause, can_be_accepted: false }));
        }
    }
    Ok(unfit)
}

/// The figures of a history, of which parts were `derived`; figures over their limits are an error, with the likely
/// cause, unless they are to be accepted.
pub(crate) fn check(
    problem: &AnyProblem,
    source: &dyn StepSource,
    critical: f64,
    derived: &[Derived],
    accept: bool,
) -> Result<CheckResult, Refusal> {
    let energies = RefCell::new((Evaluation::new(problem, source.times()), Balancing::new(problem, source.times())));
    let watched = StepFilter::new(source, |step, take| {
        let (evaluation, balancing) = &mut *energies.borrow_mut();
        balancing.accept(&evaluation.advance(step)?)?;
        take(step)
    });
    let (mut found, evidence) = measure(problem, &watched, derived, 0)?;
    found.energy = energies.into_inner().1.finish().last().map_or(0.0, |last| last.energy_drift);
    let samples = Samples::of(source, &found, evidence.given, critical);
    let mut exceeded = exceeded(&found, samples.is_some());
    let touches = evidence.contact.forced.contains(&true);
    let lacking = lacking(source, &found, (evidence.given, [touches, evidence.contact.slides()]), critical);
    exceeded.extend(through_planes(&found).filter(|_| !touches));
    let diagnosis = Diagnosis { problem, source, derived, found: &found, evidence: &evidence };
    exceeded.extend(penalty::excess(&diagnosis).filter(|_| samples.is_none()));
    let contradiction = contradiction(&diagnosis, lacking, &exceeded)?;
    if let Some(contradiction) = contradiction.clone().filter(|_| !accept) {
        return Err(Refusal::Inconsistent(contradiction));
    }
    let complete = samples.is_none() && contradiction.is_none();
    let shifted = if complete { of_balance::shifted(&diagnosis)? } else { None };
    Ok(CheckResult { consistency: found, samples, shifted, contradiction })
}

/// The figure over its limit that tells most, with its likely cause. What is `lacking` comes with a way out.
fn contradiction(
    diagnosis: &Diagnosis<'_>,
    lacking: Option<(String, String)>,
    exceeded: &[Excess],
) -> Result<Option<Contradiction>, SinkError> {
    let balance = exceeded.iter().find(|excess| excess.name == "balance");
    let can_be_accepted = exceeded.iter().all(|excess| excess.name != "initial_displacement");
    if let Some((figure, way_out)) = lacking {
        let changed = balance.map(|_| diagnosis.in_other_units()).transpose()?.flatten();
        let figure = balance.filter(|_| changed.is_some()).map_or(figure, |excess| excess.what.clone());
        return Ok(Some(Contradiction { figure, cause: changed.or(Some(way_out)), can_be_accepted }));
    }
    let Some(first) = exceeded.first() else { return Ok(None) };
    let cause = diagnosis.cause(exceeded)?;
    let place = if cause.is_none() && balance.is_some() { of_balance::place(diagnosis) } else { String::new() };
    let cause = cause.or_else(|| of_balance::hint(diagnosis).filter(|_| balance.is_some()));
    let figure = format!("{}{place}", balance.unwrap_or(first).what);
    Ok(Some(Contradiction { figure, cause, can_be_accepted }))
}

/// a/b, and 0 where both are.
fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}

/// The largest difference of two fields and the largest component of the first.
fn widest(field: &[f64], other: &[f64]) -> [f64; 2] {
    let pairs = field.iter().zip(other);
    pairs.fold([0.0; 2], |[difference, most], (a, b): (&f64, &f64)| [(a - b).abs().max(difference), a.abs().max(most)])
}

fn take_in(largest: &mut [f64; 2], values: [f64; 2]) {
    largest.iter_mut().zip(values).for_each(|(most, value)| *most = most.max(value));
}
