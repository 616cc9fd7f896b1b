//! Contact by a penalty that is too stiff for the steps.

use super::diagnosis::Diagnosis;
use super::limits::{DRIFT, Excess, by_a_penalty};
use crate::message::{percent, trimmed};
use percute_core::border::row;
use percute_core::dynamics::critical_time_step;
use percute_core::kernel::InternalForces;
use percute_core::time::is_stable;

/// The name of what is over its limit where a penalty makes the run unstable.
pub(super) const UNSTABLE: &str = "penalty";

/// That the energy drifts by a penalty that is too stiff for the steps.
pub(super) fn excess(diagnosis: &Diagnosis<'_>) -> Option<Excess> {
    if !by_a_penalty(diagnosis.found) || diagnosis.found.energy <= DRIFT {
        return None;
    }
    cause(diagnosis).map(|_| {
        let [drift, limit] = [diagnosis.found.energy, DRIFT].map(percent);
        let what = format!("contact is by a penalty, and the energy drifts by {drift} (limit {limit})");
        Excess { what, name: UNSTABLE }
    })
}

/// The node at which the contact stiffness makes the longest step unstable most, with the way out.
///
/// ω² of the body with the springs is at least (k + n·K n)/m of any node: central differences are unstable above
/// Δt = 2/ω.
pub(super) fn cause(diagnosis: &Diagnosis<'_>) -> Option<String> {
    let (problem, contact) = (diagnosis.problem, &diagnosis.evidence.contact);
    let mass = |at: usize| problem.moved_mass(at);
    let springs = contact.springs().filter(|(_, stiffness)| stiffness.is_finite());
    let (at, stiffness) = springs.max_by(|(a, k), (b, l)| (k / mass(*a)).total_cmp(&(l / mass(*b))))?;
    let node = problem.contact_nodes()[at].node.index();
    let (times, own) = (diagnosis.source.times(), own_stiffness(diagnosis, at));
    let (step, mass) = (times.longest_step(), mass(at));
    let stable = 2.0 * (mass / (stiffness + own)).sqrt();
    // Steps above that of the body alone are unstable with any contact.
    if step <= stable || !is_stable(step, critical_time_step(problem)) {
        return None;
    }
    let most = 4.0 * mass / (step * step) - own;
    let lower = if most > 0.0 {
        format!("lower it to less than {} N/m there, or take", trimmed(most, 3))
    } else {
        "take".to_string()
    };
    Some(format!(
        "the penalty is too stiff for the steps, and the contact is unstable: the force on node {node} is {} N/m times \
         its penetration; with its mass of {} kg, steps above {} s are unstable, and they are {} s; {lower} shorter \
         steps",
        trimmed(stiffness, 3),
        trimmed(mass, 3),
        trimmed(stable, 3),
        trimmed(step, 3)
    ))
}

/// n·K n of a node at a plane (N/m); 0 of two nodes, whose relative motion both share.
fn own_stiffness(diagnosis: &Diagnosis<'_>, at: usize) -> f64 {
    let problem = diagnosis.problem;
    let contact = &problem.contact_nodes()[at];
    let (obstacle, node) = (problem.obstacle(contact.obstacle), contact.node.index());
    if !obstacle.is_plane() {
        return 0.0;
    }
    let (frame, d) = (obstacle.frame(), problem.dimension());
    let (mut displacement, mut force) = (vec![0.0; d * problem.mesh().node_count()], Vec::new());
    force.resize(displacement.len(), 0.0);
    displacement[d * node..d * (node + 1)].copy_from_slice(&frame.normal()[..d]);
    InternalForces::linear(problem).subtract_from_rows(&displacement, &mut force);
    -frame.split(&row(&force, node, d)).0
}
