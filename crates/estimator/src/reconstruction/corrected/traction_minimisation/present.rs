//! Modes of a body that turns: they balance in its present places.
//!
//! The forces of a mode are those of the undeformed body, moved on by F: along an edge by that of its elements, at a
//! node by the mean F̄ of the elements around it. Pulled back to an element they are those of the undeformed body, but
//! for the differences of F between neighbours, so that the matrix of the energy there serves.

use crate::element::Element;
use crate::time_level::ForcesKnown;
use percute_core::ids::NodeId;
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use percute_core::simd::lanes::{Lanes, Value, load};
use rayon::prelude::*;

/// A node at the instants of a group.
#[derive(Clone, Copy, Debug)]
struct PresentNode {
    /// Its displacement (m).
    displacement: [Lanes; 2],
    /// F̄ of its star.
    frame: [[Lanes; 2]; 2],
    /// det F̄.
    ratio: Lanes,
}

/// All nodes at the instants of a group.
#[derive(Debug)]
pub(super) struct PresentPlaces(Vec<PresentNode>);

impl PresentPlaces {
    /// At levels with these fields.
    pub(super) fn new<const D: usize, const N: usize>(
        problem: &Problem<D>,
        elements: &[Element<D, N>],
        forces: &[ForcesKnown<D>],
    ) -> Self {
        let mesh = problem.mesh();
        let field = |node: NodeId| -> [Lanes; D] {
            let of =
                |k: usize, c: usize| forces.get(k).map_or(0.0, |forces| forces.level.displacement[node.index()][c]);
            std::array::from_fn(|c| Lanes::at_levels(|k| of(k, c)))
        };
        let node = |node: usize| {
            let (node, mut sum, mut volume) = (NodeId::new(node), [[Lanes::ZERO; D]; D], 0.0);
            for element in mesh.stars().star(node).elements {
                let element = &elements[element.index()];
                let gradient = element.gradient(&element.nodes.map(field));
                volume += element.volume;
                (0..D).for_each(|a| (0..D).for_each(|b| sum[a][b] += gradient[a][b] * element.volume));
            }
            let own = field(node);
            let entry = |a: usize, b: usize| sum[a][b] * (1.0 / volume) + Lanes::ZERO.fill(f64::from(u8::from(a == b)));
            let frame = [[entry(0, 0), entry(0, D - 1)], [entry(D - 1, 0), entry(D - 1, D - 1)]];
            let ratio = frame[0][0] * frame[1][1] - frame[0][1] * frame[1][0];
            PresentNode { displacement: [own[0], own[D - 1]], frame, ratio }
        };
        Self((0..mesh.node_count()).into_par_iter().map(node).collect())
    }

    /// The forces of an edge from its first node to its second: its unit vector in the undeformed body, which is given,
    /// moved on, and the force at the second node of a unit couple about it.
    #[inline(always)]
    pub(super) fn edge<T: Value<Stored = Lanes>, const D: usize>(
        &self,
        like: T,
        mesh: &Mesh,
        [first, second]: [NodeId; 2],
        [along, lever]: [[f64; 2]; 2],
    ) -> [[T; 2]; 2] {
        let points = mesh.points_in::<D>();
        let (a, b) = (&points[first.index()], &points[second.index()]);
        let [from, to] = [first, second].map(|node| &self.0[node.index()]);
        let [u, v] = [load(like, &from.displacement), load(like, &to.displacement)];
        let before = [b[0] - a[0], b[1] - a[1]];
        let now = [v[0] - u[0] + like.fill(before[0]), v[1] - u[1] + like.fill(before[1])];
        // The unit vector is the edge times 1/|d|, with its sign.
        let scale = (along[0] * before[0] + along[1] * before[1]) / (before[0] * before[0] + before[1] * before[1]);
        let mut force = [like.zero(); 2];
        for a in 0..2 {
            for b in 0..2 {
                force[a] += (like.load(&from.frame[a][b]) + like.load(&to.frame[a][b])) * lever[b];
            }
        }
        let couple = like.fill(1.0) / (now[0] * force[1] - now[1] * force[0]);
        [now.map(|d| d * scale), force.map(|f| f * couple)]
    }

    /// The slopes in the modes of a node, from those in forces on its links and in their couple.
    #[inline(always)]
    pub(super) fn slopes<T: Value<Stored = Lanes>>(&self, node: NodeId, [x, y, turn]: [T; 3]) -> [T; 3] {
        let PresentNode { frame, ratio, .. } = &self.0[node.index()];
        let entry = |a: usize, b: usize| x.load(&frame[a][b]);
        [entry(0, 0) * x + entry(1, 0) * y, entry(0, 1) * x + entry(1, 1) * y, turn * x.load(ratio)]
    }

    /// The force on the links of a node and their couple, from the coefficients of its modes.
    #[inline(always)]
    pub(super) fn forces<T: Value<Stored = Lanes>>(&self, node: NodeId, [x, y, turn]: [T; 3]) -> [T; 3] {
        let PresentNode { frame, ratio, .. } = &self.0[node.index()];
        let entry = |a: usize, b: usize| x.load(&frame[a][b]);
        [entry(0, 0) * x + entry(0, 1) * y, entry(1, 0) * x + entry(1, 1) * y, turn * x.load(ratio)]
    }
}
