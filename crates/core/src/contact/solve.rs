//! Reactions of the contact constraints of one step (§5.3).

use super::constraint::Constraints;
use super::corner;

/// Hands the reaction R_n (N) of each node of the surface, by its position, to `reaction`, for a step of these Δt_n and
/// h_n (s). Gaps within the tolerance (m) are none.
///
/// The mass is lumped, so that no reaction moves a node of another constraint but at a node at two planes: each has a
/// closed form, and the fixed point of Tresca problems is reached in one pass.
pub(crate) fn solve<const D: usize>(
    constraints: &Constraints<D>,
    steps: [f64; 2],
    tolerance: f64,
    mut reaction: impl FnMut(usize, [f64; D]),
) {
    for constraint in &constraints.single {
        reaction(constraint.at, constraint.alone(steps));
    }
    for pair in &constraints.corners {
        let forces = corner::reactions(pair, steps, tolerance);
        for (constraint, force) in pair.iter().zip(forces).filter(|(_, force)| *force != [0.0; D]) {
            reaction(constraint.at, force);
        }
    }
}
