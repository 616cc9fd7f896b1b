//! The split of the mass term where there is no auxiliary solution: M ã = M_c ã + (M − M_c) ã.

use crate::deformation::Deformation;
use crate::inertia::{arms, lumping_stress};
use percute_core::element_state::displacement_gradient;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use std::array::from_fn;

/// The acceleration o₂ = M⁻¹ Σ|E|(τ − τˢ)∇φ (m/s²) of the skew part of the stress τ = ρ/(D+2) Σ w_i ⊗ d_i that
/// lumping the mass is for a motion w (m/s²), d_i from the centroid; 0 on prescribed components, whose supports carry
/// any force. With finite kinematics τˢ is the symmetric stress of the body that has moved by `displacement` (m).
pub(super) fn skew_acceleration<const D: usize, const N: usize>(
    problem: &Problem<D>,
    inverse_mass: &[f64],
    w: &[[f64; D]],
    displacement: &[[f64; D]],
) -> Vec<[f64; D]> {
    let (mesh, mut skew) = (problem.mesh(), vec![[0.0; D]; w.len()]);
    for (e, nodes) in mesh.nodes_of::<N>().iter().enumerate() {
        let id = ElementId::new(e);
        let (arms, gradients) = (arms(&mesh.corners::<D, N>(id)), mesh.geometry::<D, N>(id).gradients);
        let (law, volume) = (problem.material(id), problem.volume(id));
        let stress = lumping_stress(law.density(), &arms, &nodes.map(|node| w[node.index()]));
        let symmetric = if law.is_finite() {
            let moved = displacement_gradient(mesh, id, displacement);
            Deformation::new(&moved).symmetric_part(&stress, &moved)
        } else {
            from_fn(|a| from_fn(|b| 0.5 * (stress[a][b] + stress[b][a])))
        };
        for (node, gradient) in nodes.iter().zip(gradients) {
            for a in 0..D {
                let force: f64 = (0..D).map(|b| (stress[a][b] - symmetric[a][b]) * gradient[b]).sum();
                skew[node.index()][a] += volume * force;
            }
        }
    }
    for (value, inverse) in skew.iter_mut().zip(inverse_mass) {
        value.iter_mut().for_each(|value| *value *= inverse);
    }
    problem.prescribed().iter().for_each(|p| skew[p.node.index()][p.component] = 0.0);
    skew
}
