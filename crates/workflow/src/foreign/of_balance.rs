//! The likely cause of a residual of the balance: changes are tried and compared.

use super::attempt::{Attempt, FALL, ROUNDING, best};
use super::contact::ContactCheck;
use super::diagnosis::Diagnosis;
use super::holding::{MOST, holding};
use super::limits::BALANCE;
use super::residual::Residual;
use super::{instants, mass, missing_instants, moduli, orders, planes, rounded, skipped, surface, units};
use crate::message::{numbered, percent, trimmed};
use crate::step_filter::StepFilter;
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, Step};

/// Nodes are few if they are no more than this, or than this share of all.
const FEW: usize = 8;
const FEW_OF_ALL: f64 = 0.1;
/// Contact forces of another step must make a residual within its limit so many times smaller. Those of correct
/// histories, also in single precision, make it larger (studies/consistency.py).
const SHIFTED: f64 = 3.0;
/// The residual from which on the displacements have nothing to do with the mesh.
const ALL_WRONG: f64 = 0.3;

/// The likely cause, if the numbers single one out.
pub(super) fn cause(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    if let Some(text) = accelerations(diagnosis)? {
        return Ok(Some(text));
    }
    if let Some(text) = changed(diagnosis)? {
        return Ok(Some(text));
    }
    if let Some(text) = skipped::skipped(diagnosis)? {
        return Ok(Some(text));
    }
    Ok(rounded::rounded(diagnosis)?.or_else(|| at_silent_nodes(diagnosis)).or_else(|| one_value(diagnosis)))
}

/// The change that leaves the least residual, if it is little.
pub(super) fn changed(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    let mut attempts = shifts(diagnosis)?;
    attempts.extend(missing_instants::attempt(diagnosis));
    attempts.extend(units::one_term(diagnosis.problem, diagnosis.evidence, diagnosis.derived));
    let inside = diagnosis.evidence.residual.inside();
    if inside <= FALL * diagnosis.residual() {
        attempts.extend(surface::attempt(diagnosis)?);
    } else {
        attempts.extend(moduli::attempt(diagnosis)?);
        attempts.push(mass::consistent(diagnosis)?);
        attempts.extend(instants::attempt(diagnosis)?);
        attempts.extend(orders::places(diagnosis)?);
        attempts.extend(orders::orders(diagnosis)?);
    }
    attempts.extend(units::two_terms(diagnosis.problem, diagnosis.evidence));
    Ok(best(attempts).map(|best| best.told()))
}

/// Given accelerations without which the history is consistent.
fn accelerations(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    let Some(differs) = diagnosis.found.acceleration.filter(|differs| *differs > BALANCE) else { return Ok(None) };
    let without = StepFilter::new(diagnosis.source, |step, take| take(&Step { acceleration: None, ..*step }));
    let text = format!(
        "the accelerations are not those of the displacements, they differ by {} of the largest; leave them out",
        percent(differs)
    );
    let attempt = diagnosis.attempt(&without, 0, text)?;
    Ok(attempt.explains().then(|| attempt.told()))
}

/// Contact forces of the step before and after.
fn shifts(diagnosis: &Diagnosis<'_>) -> Result<Vec<Attempt>, SinkError> {
    if !diagnosis.has_forces() {
        return Ok(Vec::new());
    }
    let told = [(1, "late", "R_{n+1}"), (-1, "early", "R_{n-1}")];
    let attempts = told.map(|(shift, when, row)| {
        let text =
            format!("the contact forces are a step too {when}: the row of t_n should hold what is given as {row}");
        diagnosis.attempt(diagnosis.source, shift, text)
    });
    attempts.into_iter().collect()
}

/// A change to contact forces of another step that leaves much less of a residual within its limit.
pub(super) fn shifted(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    // Without a term to compare with, as at the two instants of one step in flight, no change makes it smaller.
    if diagnosis.residual() <= ROUNDING || !diagnosis.residual().is_finite() {
        return Ok(None);
    }
    let less = |one: &Attempt| one.left * SHIFTED <= one.before;
    Ok(shifts(diagnosis)?.into_iter().find(less).map(|one| one.told()))
}

/// Nodes of the surface on which no force acts, although they have the residual.
fn at_silent_nodes(diagnosis: &Diagnosis<'_>) -> Option<String> {
    let squares = &diagnosis.evidence.residual.by_node;
    let total: f64 = squares.iter().sum();
    let contact: &ContactCheck<'_> = &diagnosis.evidence.contact;
    let surface = diagnosis.problem.contact_nodes().iter().zip(&contact.forced);
    let silent: Vec<usize> = surface.filter(|(_, forced)| !**forced).map(|(c, _)| c.node.index()).collect();
    if silent.iter().map(|&node| squares[node]).sum::<f64>() < MOST * total {
        return None;
    }
    let place = units::displacements(diagnosis.evidence).or_else(|| planes::place(diagnosis, true));
    if place.is_some() {
        return place;
    }
    let missing: Vec<usize> = silent.into_iter().filter(|&node| squares[node] > 1e-6 * total).collect();
    let nodes = numbered("node", &missing);
    Some(format!("the contact forces of {nodes} are missing: a force acts there by the balance"))
}

/// A single value: few nodes at few instants.
fn one_value(diagnosis: &Diagnosis<'_>) -> Option<String> {
    let Residual { worst, by_instant, .. } = &diagnosis.evidence.residual;
    let (instants, _) = holding(by_instant, MOST);
    few_nodes(diagnosis)?;
    let at_once = instants.last().zip(instants.first()).is_some_and(|(last, first)| last - first <= 2);
    at_once.then(|| {
        let (node, time) = (worst.node, trimmed(worst.time, 5));
        format!(
            "a value of node {node}, or of a node beside it, is wrong at about {time} s: the residual is there alone"
        )
    })
}

/// The nodes that have the residual and the share that they have of its square, if they are few of all.
fn few_nodes(diagnosis: &Diagnosis<'_>) -> Option<(Vec<usize>, f64)> {
    let by_node = &diagnosis.evidence.residual.by_node;
    let (nodes, share) = holding(by_node, MOST);
    let few = FEW.max((FEW_OF_ALL * by_node.len() as f64) as usize).min(by_node.len() - 1);
    (nodes.len() <= few).then_some((nodes, share))
}

/// What to look at if no change helps: few nodes, or a history that has nothing to do with the mesh.
pub(super) fn hint(diagnosis: &Diagnosis<'_>) -> Option<String> {
    if let Some((nodes, share)) = few_nodes(diagnosis) {
        return Some(format!(
            "{} of {} nodes have {} of its square ({}): their rows, supports, loads or materials differ",
            nodes.len(),
            diagnosis.evidence.residual.by_node.len(),
            percent(share),
            numbered("node", &nodes)
        ));
    }
    (diagnosis.found.balance > ALL_WRONG).then(|| {
        "the displacements do not fit the mesh and its material: is the order of the nodes that of the mesh, and are \
         all units those of SI?"
            .to_string()
    })
}

/// Which terms fail, where, and how much.
pub(super) fn place(diagnosis: &Diagnosis<'_>) -> String {
    let residual = &diagnosis.evidence.residual;
    let worst = &residual.worst;
    let [inertia, stiffness, load, reaction] = worst.terms.map(|term| trimmed(term, 4));
    let axis = ["x", "y", "z"][worst.component];
    let (nodes, _) = holding(&residual.by_node, MOST);
    let (instants, _) = holding(&residual.by_instant, MOST);
    let times = diagnosis.source.times().instants();
    let of = |at: Option<&usize>| at.map_or(String::new(), |&n| trimmed(times[n], 5));
    format!(
        "; along {axis}, M a = {inertia} N, K u = {stiffness} N, F = {load} N, R = {reaction} N; 99 % of its square \
         are at {} of {} nodes ({}) and {} of {} instants (from {} to {} s); the instants are {} critical steps apart",
        nodes.len(),
        residual.by_node.len(),
        numbered("node", &nodes),
        instants.len(),
        diagnosis.source.count(),
        of(instants.first()),
        of(instants.last()),
        trimmed(diagnosis.source.times().longest_step() / critical_time_step(diagnosis.problem), 3)
    )
}
