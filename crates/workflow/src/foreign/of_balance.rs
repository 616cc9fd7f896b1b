//! The likely cause of a residual of the balance: changes are tried and compared.

use super::contact::Contact;
use super::holding::{MOST, holding};
use super::limits::BALANCE;
use super::residual::Residual;
use super::suspect::Suspect;
use super::tried::{FALL, ROUNDING, Tried, best};
use super::{instants, lost, mass, moduli, orders, planes, rounded, skipped, surface, units};
use crate::message::{numbered, percent, trimmed};
use crate::through::Through;
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
pub(super) fn cause(suspect: &Suspect<'_>) -> Result<Option<String>, SinkError> {
    if let Some(text) = accelerations(suspect)? {
        return Ok(Some(text));
    }
    if let Some(text) = changed(suspect)? {
        return Ok(Some(text));
    }
    if let Some(text) = skipped::skipped(suspect)? {
        return Ok(Some(text));
    }
    Ok(rounded::rounded(suspect)?.or_else(|| at_silent_nodes(suspect)).or_else(|| one_value(suspect)))
}

/// The change that leaves the least residual, if it is little.
pub(super) fn changed(suspect: &Suspect<'_>) -> Result<Option<String>, SinkError> {
    let mut tried = shifts(suspect)?;
    tried.extend(lost::tried(suspect));
    tried.extend(units::one_term(suspect.problem, suspect.evidence, suspect.derived));
    let inside = suspect.evidence.residual.inside();
    if inside <= FALL * suspect.residual() {
        tried.extend(surface::tried(suspect)?);
    } else {
        tried.extend(moduli::tried(suspect)?);
        tried.push(mass::consistent(suspect)?);
        tried.extend(instants::tried(suspect)?);
        tried.extend(orders::places(suspect)?);
        tried.extend(orders::orders(suspect)?);
    }
    tried.extend(units::two_terms(suspect.problem, suspect.evidence));
    Ok(best(tried).map(|best| best.told()))
}

/// Given accelerations without which the history is consistent.
fn accelerations(suspect: &Suspect<'_>) -> Result<Option<String>, SinkError> {
    let Some(differs) = suspect.found.acceleration.filter(|differs| *differs > BALANCE) else { return Ok(None) };
    let without = Through::new(suspect.source, |step, take| take(&Step { acceleration: None, ..*step }));
    let text = format!(
        "the accelerations are not those of the displacements, they differ by {} of the largest; leave them out",
        percent(differs)
    );
    let tried = suspect.tried(&without, 0, text)?;
    Ok(tried.explains().then(|| tried.told()))
}

/// Contact forces of the step before and after.
fn shifts(suspect: &Suspect<'_>) -> Result<Vec<Tried>, SinkError> {
    if !suspect.has_forces() {
        return Ok(Vec::new());
    }
    let told = [(1, "late", "R_{n+1}"), (-1, "early", "R_{n-1}")];
    let tried = told.map(|(shift, when, row)| {
        let text =
            format!("the contact forces are a step too {when}: the row of t_n should hold what is given as {row}");
        suspect.tried(suspect.source, shift, text)
    });
    tried.into_iter().collect()
}

/// A change to contact forces of another step that leaves much less of a residual within its limit.
pub(super) fn shifted(suspect: &Suspect<'_>) -> Result<Option<String>, SinkError> {
    // Without a term to compare with, as at the two instants of one step in flight, no change makes it smaller.
    if suspect.residual() <= ROUNDING || !suspect.residual().is_finite() {
        return Ok(None);
    }
    let less = |one: &Tried| one.left * SHIFTED <= one.before;
    Ok(shifts(suspect)?.into_iter().find(less).map(|one| one.told()))
}

/// Nodes of the surface on which no force acts, although they have the residual.
fn at_silent_nodes(suspect: &Suspect<'_>) -> Option<String> {
    let squares = &suspect.evidence.residual.by_node;
    let total: f64 = squares.iter().sum();
    let contact: &Contact<'_> = &suspect.evidence.contact;
    let surface = suspect.problem.contact_nodes().iter().zip(&contact.forced);
    let silent: Vec<usize> = surface.filter(|(_, forced)| !**forced).map(|(c, _)| c.node.index()).collect();
    if silent.iter().map(|&node| squares[node]).sum::<f64>() < MOST * total {
        return None;
    }
    let place = units::displacements(suspect.evidence).or_else(|| planes::place(suspect, true));
    if place.is_some() {
        return place;
    }
    let missing: Vec<usize> = silent.into_iter().filter(|&node| squares[node] > 1e-6 * total).collect();
    let nodes = numbered("node", &missing);
    Some(format!("the contact forces of {nodes} are missing: a force acts there by the balance"))
}

/// A single value: few nodes at few instants.
fn one_value(suspect: &Suspect<'_>) -> Option<String> {
    let Residual { worst, by_instant, .. } = &suspect.evidence.residual;
    let (instants, _) = holding(by_instant, MOST);
    few_nodes(suspect)?;
    let at_once = instants.last().zip(instants.first()).is_some_and(|(last, first)| last - first <= 2);
    at_once.then(|| {
        let (node, time) = (worst.node, trimmed(worst.time, 5));
        format!(
            "a value of node {node}, or of a node beside it, is wrong at about {time} s: the residual is there alone"
        )
    })
}

/// The nodes that have the residual and the share that they have of its square, if they are few of all.
fn few_nodes(suspect: &Suspect<'_>) -> Option<(Vec<usize>, f64)> {
    let by_node = &suspect.evidence.residual.by_node;
    let (nodes, share) = holding(by_node, MOST);
    let few = FEW.max((FEW_OF_ALL * by_node.len() as f64) as usize).min(by_node.len() - 1);
    (nodes.len() <= few).then_some((nodes, share))
}

/// What to look at if no change helps: few nodes, or a history that has nothing to do with the mesh.
pub(super) fn hint(suspect: &Suspect<'_>) -> Option<String> {
    if let Some((nodes, share)) = few_nodes(suspect) {
        return Some(format!(
            "{} of {} nodes have {} of its square ({}): their rows, supports, loads or materials differ",
            nodes.len(),
            suspect.evidence.residual.by_node.len(),
            percent(share),
            numbered("node", &nodes)
        ));
    }
    (suspect.found.balance > ALL_WRONG).then(|| {
        "the displacements do not fit the mesh and its material: is the order of the nodes that of the mesh, and are \
         all units those of SI?"
            .to_string()
    })
}

/// Which terms fail, where, and how much.
pub(super) fn place(suspect: &Suspect<'_>) -> String {
    let residual = &suspect.evidence.residual;
    let worst = &residual.worst;
    let [inertia, stiffness, load, reaction] = worst.terms.map(|term| trimmed(term, 4));
    let axis = ["x", "y", "z"][worst.component];
    let (nodes, _) = holding(&residual.by_node, MOST);
    let (instants, _) = holding(&residual.by_instant, MOST);
    let times = suspect.source.times().instants();
    let of = |at: Option<&usize>| at.map_or(String::new(), |&n| trimmed(times[n], 5));
    format!(
        "; along {axis}, M a = {inertia} N, K u = {stiffness} N, F = {load} N, R = {reaction} N; 99 % of its square \
         are at {} of {} nodes ({}) and {} of {} instants (from {} to {} s); the instants are {} critical steps apart",
        nodes.len(),
        residual.by_node.len(),
        numbered("node", &nodes),
        instants.len(),
        suspect.source.count(),
        of(instants.first()),
        of(instants.last()),
        trimmed(suspect.source.times().longest_step() / critical_time_step(suspect.problem), 3)
    )
}
