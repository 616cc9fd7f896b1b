//! The data of an element, computed once.

use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Law;
use percute_core::mesh::{Mesh, Star};
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
    /// For each node, the links of its star on the faces of this element, by the place of the node in the face.
    pub(crate) links: [[Link; D]; N],
}

/// A face of an element in the star of one of its nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Link(u32);

impl Link {
    /// From its place among the links of all stars, and whether moments on it enter the element: those of a chain by
    /// the face before it, those of a solid from the owner of the face.
    pub(crate) fn new(place: usize, enters: bool) -> Self {
        Self(2 * place as u32 + u32::from(enters))
    }

    /// Its place among the links of all stars.
    #[inline(always)]
    pub(crate) fn place(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether moments on it enter the element at the p-th node of its face k. In the plane all elements are alike.
    #[inline(always)]
    pub(crate) fn enters<const D: usize>(self, k: usize, p: usize) -> bool {
        match D {
            1 => k == 1,
            2 => p == 0,
            _ => self.0 & 1 == 1,
        }
    }
}

/// The face of which local node `i` is the p-th node: face k lies opposite to node k.
#[inline(always)]
pub(crate) const fn face_at<const N: usize>(i: usize, p: usize) -> usize {
    (i + N - 1 - p) % N
}

/// The elements of a problem.
pub(crate) fn elements<const D: usize, const N: usize>(problem: &Problem<D>) -> Vec<Element<D, N>> {
    let mesh = problem.mesh();
    let mut links = vec![[[Link(0); D]; N]; mesh.element_count()];
    for node in (0..mesh.node_count()).map(NodeId::new) {
        let (first, star) = (mesh.stars().link_range(node).start, mesh.stars().star(node));
        for (m, &element) in star.elements.iter().enumerate() {
            let Some(i) = mesh.local_node(element, node) else { continue };
            for p in 0..D {
                links[element.index()][i][p] = link::<D, N>(mesh, star, first, (element, m, i), p);
            }
        }
    }
    let element = |(e, links): (usize, [[Link; D]; N])| {
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

/// The link of the m-th element of a star, whose local node `i` is the node of the star, on the face of which this is
/// the p-th node; `first` is the place of the first link of the star.
fn link<const D: usize, const N: usize>(
    mesh: &Mesh,
    star: Star<'_>,
    first: usize,
    (element, m, i): (ElementId, usize, usize),
    p: usize,
) -> Link {
    let k = face_at::<N>(i, p);
    let enters = Link(0).enters::<D>(k, p);
    if D < 3 {
        // The face by which the star enters the element, or the next one.
        return Link::new(first + m + usize::from(!enters), enters);
    }
    let face = mesh.faces_of::<N>()[element.index()][k];
    Link::new(first + star.place_of(face), mesh.face(face).owner != element)
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
