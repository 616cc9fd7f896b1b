//! The limits of consistency.

use super::figures::Consistency;
use super::nearness::NEAR;
use crate::message::{percent, trimmed};

/// A figure over its limit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Excess {
    /// What the figure measures.
    pub(crate) what: String,
    /// Its name, a key of the JSON document.
    pub(crate) name: &'static str,
}

/// Limits of `balance`, `velocity` and `initial_velocity`. Percute's own histories and those of an independent solver
/// have 1e-13 to 1e-9, in single precision 1e-6 to 1e-3; a density that is wrong by 2 % has 1e-2.
pub(super) const BALANCE: f64 = 1e-2;
/// Limit of `long_step`: less does not limit the trust in an estimate.
pub(super) const LONG_STEP: f64 = 5e-4;
/// Limit of `initial_displacement`, a share of the body: single precision has 1e-7.
pub(super) const PLACE: f64 = 1e-6;
/// Limit of `interface_balance`: single precision has 1e-6.
const OPPOSITE: f64 = 1e-2;
/// Limit of `cone`: single precision has 1e-6.
pub(super) const CONE: f64 = 1e-2;
/// Limit of `gap_under_force` and `penetration`, in elements. The softest penalty of docs/recipes.md has 0.35, which
/// the estimate grades; more is a plane at another place, or another unit of length.
pub(super) const GAP: f64 = 1.0;
/// The same without any contact force. A penalty that meets its first penetration with the next step has at most the
/// way of a step, 0.1 at a tenth of the wave speed.
const THROUGH: f64 = 0.1;
/// Limit of `touching`: a status that is shifted by a step has 1.
pub(super) const TOUCHING: f64 = 0.05;
/// Penetration and gap under a force, over the element size, of Lagrange multipliers: histories of percute have less
/// than 1e-7, also in single precision. Penalties have more.
const OFF_CONTACT: f64 = 1e-6;
/// The least `penalty` of a penalty: 0.94 and more in tests, soft and stiff, with damping, with noise of 1e-9 m and
/// with forces of the next step's penetration. Multipliers have at most 0, a single node that slides on a turned plane
/// 0.8.
const PENALTY: f64 = 0.87;
/// Limit of `slip` of multipliers. A friction by a penalty lets nodes move before they slide, and has no limit: 0.21 in
/// docs/recipes.md, above 1 where nodes stick.
const SLIP: f64 = 0.05;
/// Limit of `plane`, in elements: nodes at a larger distance are not in contact.
pub(super) const PLANE: f64 = NEAR;

/// Energy that drifts by more than this, relatively, comes from unstable steps; the histories of percute have up to
/// 0.02.
pub(super) const DRIFT: f64 = 0.1;

/// The largest distance of a node from its plane under a contact force or behind it, over the element size.
pub(crate) fn off_contact(found: &Consistency) -> f64 {
    // A figure that is no number must not pass.
    let off = |figure: f64| if figure.is_nan() { f64::INFINITY } else { figure };
    off(found.penetration).max(off(found.gap_under_force))
}

/// Whether nodes are off their plane, by more than rounding.
pub(crate) fn is_off_contact(found: &Consistency) -> bool {
    off_contact(found) > OFF_CONTACT
}

/// Whether contact is by a penalty: nodes are off their plane, and forces follow the penetrations.
pub(crate) fn by_a_penalty(found: &Consistency) -> bool {
    is_off_contact(found) && found.plane == 0.0 && found.penalty.is_some_and(|fit| fit > PENALTY)
}

/// The name of what is over its limit where nodes go through their plane without a contact force.
pub(super) const THROUGH_PLANES: &str = "through_planes";

/// Figures that compare an instant with the next step of the solver, which a sample does not have.
const OF_STEPS: [&str; 5] = ["velocity", "touching", "slip", "plane", "gap_under_force"];

/// The figures over their limits, the most telling first; of samples, those that they have.
pub(crate) fn exceeded(found: &Consistency, sampled: bool) -> Vec<Excess> {
    let all = of_motion(found).into_iter().chain(of_contact(found)).flatten();
    all.filter(|excess| !sampled || !OF_STEPS.contains(&excess.name)).collect()
}

/// The penetration of a history in which no contact force acts.
pub(crate) fn through_planes(found: &Consistency) -> Option<Excess> {
    let what = "no contact force acts; the penetration, over the element size,";
    excess(found.penetration, THROUGH, THROUGH_PLANES, what)
}

/// A figure over its limit.
fn excess(value: f64, limit: f64, name: &'static str, what: &str) -> Option<Excess> {
    // A figure that is no number must not pass.
    let over = value.is_nan() || value > limit;
    over.then(|| Excess { what: format!("{what} is {} (limit {})", percent(value), percent(limit)), name })
}

/// Of the start, the balance and the velocities.
fn of_motion(found: &Consistency) -> [Option<Excess>; 5] {
    let place = format!("at node {}, {} s", found.node, trimmed(found.time, 5));
    [
        excess(
            found.initial_displacement,
            PLACE,
            "initial_displacement",
            "the difference of u_0 from that of the problem, over the size of the body,",
        ),
        excess(
            found.initial_velocity,
            BALANCE,
            "initial_velocity",
            "the difference of the initial velocity from that of the problem, over the largest,",
        ),
        excess(
            found.balance,
            BALANCE,
            "balance",
            &format!("the largest residual M a + K u - F - R, over its largest term, {place},"),
        ),
        excess(
            found.long_step,
            LONG_STEP,
            "long_step",
            "the largest residual M a + K u - F - R at the ends of a longer step, less ten times that of all other \
             instants, over its largest term,",
        ),
        excess(
            found.velocity.unwrap_or(0.0),
            BALANCE,
            "velocity",
            "the difference of the velocities from those of the displacements, over the largest,",
        ),
    ]
}

/// Of contact forces against gaps, touching status and Coulomb's law.
fn of_contact(found: &Consistency) -> [Option<Excess>; 7] {
    let slip = if is_off_contact(found) { f64::INFINITY } else { SLIP };
    [
        excess(
            found.interface_balance.unwrap_or(0.0),
            OPPOSITE,
            "interface_balance",
            "the contact force on one surface of a non-matching interface, beyond its multipliers, over all forces,",
        ),
        excess(
            found.plane,
            PLANE,
            "plane",
            "the gap under contact forces, the same everywhere, over the element size,",
        ),
        excess(
            found.touching,
            TOUCHING,
            "touching",
            "the number of disagreements of touching status and forces one step before, over that of their changes,",
        ),
        excess(found.cone, CONE, "cone", "the contact force in tension or beyond Coulomb's limit, over the largest,"),
        excess(
            found.slip.unwrap_or(0.0),
            slip,
            "slip",
            "the misfit of Coulomb's law at nodes that slide, over the work of its limit,",
        ),
        excess(found.gap_under_force, GAP, "gap_under_force", "the gap under a contact force, over the element size,"),
        excess(found.penetration, GAP, "penetration", "the penetration, over the element size,"),
    ]
}
