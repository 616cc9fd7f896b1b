//! The data of an element, computed once.

use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Law;
use percute_core::problem::Problem;
use percute_core::simd::lanes::Value;

/// Geometry and mass of one element.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element<const D: usize, const N: usize> {
    pub(crate) nodes: [NodeId; N],
    /// V∇φ_i (m² with thickness), V the volume: σ times it is a nodal force.
    pub(crate) gradients: [[f64; D]; N],
    /// V (m³).
    pub(crate) volume: f64,
    /// Lumped mass at each node, ρV/(D+1) (kg).
    pub(crate) nodal_mass: f64,
    /// For each node, where the face by which its star enters this element lies among the
    /// links of all stars; the face by which it leaves comes next.
    pub(crate) links: [u32; N],
}

/// The elements of a problem.
pub(crate) fn elements<const D: usize, const N: usize>(problem: &Problem<D>) -> Vec<Element<D, N>> {
    let mesh = problem.mesh();
    let mut links = vec![[0; N]; mesh.element_count()];
    for node in (0..mesh.node_count()).map(NodeId::new) {
        let first = mesh.stars().link_range(node).start;
        for (m, &element) in mesh.stars().star(node).elements.iter().enumerate() {
            if let Some(i) = mesh.local_node(element, node) {
                links[element.index()][i] = (first + m) as u32;
            }
        }
    }
    let element = |(e, links): (usize, [u32; N])| {
        let id = ElementId::new(e);
        let geometry = mesh.geometry::<D, N>(id);
        let volume = problem.volume(id);
        Element {
            nodes: mesh.nodes_of::<N>()[e],
            gradients: geometry.gradients.map(|g| g.map(|x| volume * x)),
            volume,
            nodal_mass: problem.material(id).density() * volume / N as f64,
            links,
        }
    };
    links.into_iter().enumerate().map(element).collect()
}

impl<const D: usize, const N: usize> Element<D, N> {
    /// ∂u_a/∂x_b of a linear field, from differences with its value at the first node.
    #[inline(always)]
    pub(crate) fn gradient<T: Value>(&self, u: &[[T; D]; N]) -> [[T; D]; D] {
        let inverse = 1.0 / self.volume;
        let mut gradient = [[u[0][0].zero(); D]; D];
        for i in 1..N {
            for a in 0..D {
                let difference = (u[i][a] - u[0][a]) * inverse;
                for b in 0..D {
                    gradient[a][b] += difference * self.gradients[i][b];
                }
            }
        }
        gradient
    }

    /// The values of a nodal field at the nodes.
    #[inline(always)]
    pub(crate) fn gather(&self, field: &[[f64; D]]) -> [[f64; D]; N] {
        self.nodes.map(|n| field[n.index()])
    }

    /// Vσ∇φ_i of node `i`.
    #[inline(always)]
    pub(crate) fn internal_force<T: Value>(&self, i: usize, stress: &[[T; D]; D]) -> [T; D] {
        let mut force = [stress[0][0].zero(); D];
        for a in 0..D {
            for b in 0..D {
                force[a] += stress[a][b] * self.gradients[i][b];
            }
        }
        force
    }
}
