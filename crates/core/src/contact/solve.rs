//! Reactions of the contact constraints of one step (§5.3).

use super::constraint::Constraint;
use super::frame::dot;

/// Hands the reaction R_n (N) of each constraint to `reaction`, for a step of these Δt_n and h_n (s).
///
/// The mass is lumped and each node has one constraint, so that no reaction moves a node of another constraint: each
/// has a closed form, and the fixed point of Tresca problems is reached in one pass.
pub(crate) fn solve<const D: usize>(
    constraints: &[Constraint<D>],
    [dt, h]: [f64; 2],
    mut reaction: impl FnMut(&Constraint<D>, [f64; D]),
) {
    for constraint in constraints {
        let Constraint { frame, law, mass, gap, sliding, .. } = constraint;
        // Normal: end exactly on the obstacle. Tangential: stop, as far as Coulomb's cone allows.
        let normal = -mass * gap / (dt * h);
        let stop = mass / h;
        let scale = law.admissible(normal, stop * dot(sliding, sliding).sqrt(), stop);
        reaction(constraint, std::array::from_fn(|c| normal * frame.normal()[c] - scale * sliding[c]));
    }
}
