//! Reactions of the contact constraints of one step (§5.3).

use super::constraint::{Constraint, Constraints};
use super::corner;
use super::frame::dot;

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
        reaction(constraint.at, alone(constraint, steps));
    }
    for pair in &constraints.corners {
        let forces = corner::reactions(pair, steps, tolerance);
        for (constraint, force) in pair.iter().zip(forces).filter(|(_, force)| *force != [0.0; D]) {
            reaction(constraint.at, force);
        }
    }
}

/// The reaction of a constraint alone.
pub(super) fn alone<const D: usize>(constraint: &Constraint<D>, [dt, h]: [f64; 2]) -> [f64; D] {
    let Constraint { frame, law, mass, gap, velocity, .. } = constraint;
    // Normal: end exactly on the obstacle. Tangential: stop, as far as Coulomb's cone allows.
    let normal = -mass * gap / (dt * h);
    let (stop, (_, sliding)) = (mass / h, frame.split(velocity));
    let scale = law.admissible(normal, stop * dot(&sliding, &sliding).sqrt(), stop);
    std::array::from_fn(|c| normal * frame.normal()[c] - scale * sliding[c])
}
