//! The split of the mass term where there is no auxiliary solution: M ã = M_c ã + (M − M_c) ã.

use crate::inertia::arms;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;

/// The acceleration o₂ = M⁻¹ Σ|E|(τ − τˢ)∇φ (m/s²) of the skew part of the stress τ = ρ/(D+2) Σ w_i ⊗ d_i that
/// lumping the mass is for a motion w (m/s²), d_i from the centroid; 0 on prescribed components, whose supports carry
/// any force.
pub(super) fn skew_acceleration<const D: usize, const N: usize>(
    problem: &Problem<D>,
    inverse_mass: &[f64],
    w: &[[f64; D]],
) -> Vec<[f64; D]> {
    let (mesh, mut skew) = (problem.mesh(), vec![[0.0; D]; w.len()]);
    for (e, nodes) in mesh.nodes_of::<N>().iter().enumerate() {
        let id = ElementId::new(e);
        let (arms, gradients) = (arms(&mesh.corners::<D, N>(id)), mesh.geometry::<D, N>(id).gradients);
        let half = 0.5 * problem.material(id).density() * problem.volume(id) / (D + 2) as f64;
        let mut stress = [[0.0; D]; D];
        for (i, node) in nodes.iter().enumerate() {
            for a in 0..D {
                let change = half * (w[node.index()][a] - w[nodes[0].index()][a]);
                for b in 0..D {
                    stress[a][b] += change * arms[i][b];
                    stress[b][a] -= change * arms[i][b];
                }
            }
        }
        for (node, gradient) in nodes.iter().zip(gradients) {
            for a in 0..D {
                skew[node.index()][a] += (0..D).map(|b| stress[a][b] * gradient[b]).sum::<f64>();
            }
        }
    }
    for (value, inverse) in skew.iter_mut().zip(inverse_mass) {
        value.iter_mut().for_each(|value| *value *= inverse);
    }
    problem.prescribed().iter().for_each(|p| skew[p.node.index()][p.component] = 0.0);
    skew
}
