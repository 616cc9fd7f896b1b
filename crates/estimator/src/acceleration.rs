//! Accelerations of nodes under given forces.

use crate::parallel::by_pieces;
use percute_core::problem::Problem;

/// Turns nodal forces (N) into M⁻¹ of them and of the contact forces on the nodes of the contact surface (m/s²).
pub(crate) fn accelerate<const D: usize>(
    problem: &Problem<D>,
    inverse_mass: &[f64],
    force: &mut [[f64; D]],
    contact: &[[f64; D]],
) {
    for (node, contact) in problem.surface().nodes().iter().zip(contact) {
        (0..D).for_each(|c| force[node.node.index()][c] += contact[c]);
    }
    by_pieces((force, inverse_mass), &|_, (force, inverse_mass)| {
        for (f, inverse) in force.iter_mut().zip(inverse_mass) {
            (0..D).for_each(|c| f[c] *= inverse);
        }
    });
}
