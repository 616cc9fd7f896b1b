//! The edges of non-matching interfaces, as candidate faces.

use crate::direction::along;
use crate::partition::Piece;
use percute_core::contact::{NonMatchingSurfaces, Side};
use percute_core::ids::ElementId;
use percute_core::material::{Hypothesis, Law};
use percute_core::problem::Problem;

/// An edge of a non-matching interface, as a candidate face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeFace {
    /// Position among the candidate faces.
    pub(crate) face: usize,
    /// Position in the face of the first and of the second node along the tangent.
    pub(super) ends: [usize; 2],
    /// Its length along the tangent (m).
    pub(super) length: f64,
    /// The energy of the stress of a traction r without resultant and moment is at most this times ∫r² dξ (m²/N).
    pub(super) spread: f64,
}

/// The edges of slave and master as candidate faces.
#[derive(Clone, Debug)]
pub(crate) struct NonMatchingFaces {
    pub(super) edges: [Vec<EdgeFace>; 2],
}

impl NonMatchingFaces {
    /// Those of all non-matching interfaces.
    pub(crate) fn all<const D: usize>(problem: &Problem<D>) -> Vec<Self> {
        let surface = problem.surface();
        let mut starts_at = vec![None; surface.nodes().len()];
        for (f, face) in surface.faces().iter().enumerate() {
            let first = face.nodes.iter().copied().min().unwrap_or(0);
            if surface.non_matching_of(first).is_some() {
                starts_at[first] = Some(f);
            }
        }
        let edges = |non_matching: &NonMatchingSurfaces<D>| {
            let one = |side: &Side, first: usize| {
                let face = starts_at[side.position(first)]?;
                let length = side.xi()[first + 1] - side.xi()[first];
                let nodes = &surface.faces()[face].nodes;
                let ends = [0, 1].map(|k| nodes.iter().position(|&at| at == side.position(first + k)).unwrap_or(k));
                Some(EdgeFace { face, ends, length, spread: spread(problem, face) * length })
            };
            let edges = [non_matching.slave(), non_matching.master()];
            Self { edges: edges.map(|side| side.edges().iter().filter_map(|&first| one(side, first)).collect()) }
        };
        surface.non_matching().iter().map(edges).collect()
    }

    /// The faces on which a piece is: that of the slave and that of the master.
    pub(crate) fn of(&self, piece: &Piece) -> [usize; 2] {
        [self.edges[0][piece.slave[0]].face, self.edges[1][piece.master[0]].face]
    }
}

/// C over the thickness, with the energy C ℓ ∫r² ds of a traction r without resultant and moment on an edge of length
/// ℓ: (0.3 + max(0, cot θ)²)/E with the smaller angle θ of the element at the edge. It is above the largest eigenvalue
/// of the edge in nine shapes of triangles.
fn spread<const D: usize>(problem: &Problem<D>, face: usize) -> f64 {
    let (mesh, face) = (problem.mesh(), problem.surface().faces()[face].face);
    let owner: ElementId = mesh.face(face).owner;
    let (points, law) = (mesh.points_in::<D>(), problem.material(owner));
    let ends = mesh.face_nodes::<D>(face);
    let apex = mesh.cell(owner).iter().find(|node| !ends.contains(node)).copied().unwrap_or(ends[0]);
    let arm = |from: usize, to: usize| -> [f64; D] { std::array::from_fn(|c| points[to][c] - points[from][c]) };
    let cotangent = |k: usize| {
        let (near, far) = (ends[k].index(), ends[D - 1 - k].index());
        let (edge, side) = (arm(near, far), arm(near, apex.index()));
        let cross = edge[0] * side[D - 1] - edge[D - 1] * side[0];
        along(&edge, &side) / cross.abs()
    };
    let cotangent = cotangent(0).max(cotangent(D - 1)).max(0.0);
    let modulus = match law.hypothesis() {
        Hypothesis::PlaneStrain => law.young() / (1.0 - law.poisson() * law.poisson()),
        _ => law.young(),
    };
    (0.3 + cotangent * cotangent) / modulus / law.extent()
}
