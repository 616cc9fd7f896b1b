//! The changes of the tractions that leave the resultant and the moment on each element as they are.
//!
//! The moments of an edge act on an element like forces at the two nodes of the edge. The changes without resultant and
//! moment on any element are spanned by:
//! - on each edge, opposite forces at its ends, along it: one for each edge;
//! - around each node that is surrounded by unknown edges, the same force and the same couple through all of
//!   them: three for each such node.
//!
//! Each edge and each node has coefficients, whether it has modes or not; without modes they stay 0. Edges are numbered
//! by their lower ends, so that those of consecutive nodes follow each other.

use super::present::PresentPlaces;
use percute_core::ids::{FaceId, NodeId};
use percute_core::mesh::{Face, Mesh};
use percute_core::simd::lanes::{Lanes, Value, load};

/// Components of the moments on the three edges of a triangle: 3 edges, 2 nodes, 2 components.
pub(super) const MOMENTS: usize = 12;

/// Coefficients of all modes, or the slopes of an energy in them, at the instants of a group.
#[derive(Clone, Debug)]
pub(in crate::reconstruction) struct Modes {
    pub(super) nodes: Vec<[Lanes; 3]>,
    pub(super) edges: Vec<Lanes>,
}

/// The coefficients of consecutive nodes and of the edges of which they are the lower ends.
#[derive(Debug)]
pub(in crate::reconstruction) struct ModesPart<'a> {
    pub(super) nodes: &'a mut [[Lanes; 3]],
    pub(super) edges: &'a mut [Lanes],
    pub(super) first_node: usize,
    pub(super) first_edge: usize,
}

impl Modes {
    /// All coefficients 0.
    pub(super) fn new(numbers: &Numbers) -> Self {
        Self { nodes: vec![[Lanes::ZERO; 3]; numbers.nodes()], edges: vec![Lanes::ZERO; numbers.edges()] }
    }

    /// Makes all coefficients 0.
    pub(in crate::reconstruction) fn clear(&mut self) {
        self.nodes.fill([Lanes::ZERO; 3]);
        self.edges.fill(Lanes::ZERO);
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Lanes> {
        self.nodes.as_flattened().iter().chain(&self.edges)
    }

    /// All of them as one part.
    pub(in crate::reconstruction) fn part(&mut self) -> ModesPart<'_> {
        ModesPart { nodes: &mut self.nodes, edges: &mut self.edges, first_node: 0, first_edge: 0 }
    }
}

impl ModesPart<'_> {
    /// The same for a while.
    pub(super) fn reborrow(&mut self) -> ModesPart<'_> {
        ModesPart { nodes: self.nodes, edges: self.edges, ..*self }
    }

    /// The nodes before the given one and those from it on.
    pub(in crate::reconstruction) fn split(self, numbers: &Numbers, node: NodeId) -> (Self, Self) {
        let edge = numbers.first_edge(node.index());
        let nodes = self.nodes.split_at_mut(node.index() - self.first_node);
        let edges = self.edges.split_at_mut(edge - self.first_edge);
        let before = Self { nodes: nodes.0, edges: edges.0, ..self };
        (before, Self { nodes: nodes.1, edges: edges.1, first_node: node.index(), first_edge: edge })
    }
}

/// The numbers of edges.
#[derive(Clone, Debug)]
pub(in crate::reconstruction) struct Numbers {
    /// The first of each node, and after them the number of all.
    first: Vec<u32>,
    /// Of each face.
    face: Vec<u32>,
}

impl Numbers {
    /// Of an element (bytes): in a triangulation, three edges and one node go with two elements.
    pub(super) const BYTES: usize = 2 * size_of::<u32>();

    pub(super) fn new(mesh: &Mesh) -> Self {
        let lower = |face: &Face<'_>| face.nodes.iter().map(|n| n.index()).min().unwrap_or(0);
        let mut first = vec![0; mesh.node_count() + 1];
        mesh.faces().for_each(|face| first[lower(&face) + 1] += 1);
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let number = |face: Face<'_>| {
            let next = &mut next[lower(&face)];
            *next += 1;
            *next - 1
        };
        Self { face: mesh.faces().map(number).collect(), first }
    }

    /// How many nodes there are.
    #[inline(always)]
    pub(super) fn nodes(&self) -> usize {
        self.first.len() - 1
    }

    /// How many edges there are.
    #[inline(always)]
    pub(super) fn edges(&self) -> usize {
        self.first_edge(self.nodes())
    }

    /// The first edge of which a node, or one after it, is the lower end.
    #[inline(always)]
    pub(super) fn first_edge(&self, node: usize) -> usize {
        self.first[node] as usize
    }

    #[inline(always)]
    pub(super) fn of(&self, face: FaceId) -> usize {
        self.face[face.index()] as usize
    }

    /// Adds the slopes of an energy in the moments on the edges of element `e`, outward from it. Moment 4k + 2p + c is
    /// component c at the p-th node of edge k.
    #[inline(always)]
    pub(super) fn add_slope<T: Value<Stored = Lanes>, const D: usize, const N: usize>(
        &self,
        mesh: &Mesh,
        (e, slope): (usize, &[T; MOMENTS]),
        present: Option<&PresentPlaces>,
        to: &mut ModesPart<'_>,
    ) {
        let (cell, faces, like) = (&mesh.nodes_of::<N>()[e], &mesh.faces_of::<N>()[e], slope[0]);
        let mut nodes = [[like.zero(); 3]; N];
        for k in 0..N {
            let (a, b) = ((k + 1) % N, (k + 2) % N);
            let edge = Edge::new::<D>(like, mesh, [cell[a], cell[b]], present);
            let (ax, ay, bx, by) = (slope[4 * k], slope[4 * k + 1], slope[4 * k + 2], slope[4 * k + 3]);
            let (x, y) = (bx - ax, by - ay);
            let sum = &mut to.edges[self.of(faces[k]) - to.first_edge];
            *sum = (x.load(sum) + (x * edge.along[0] + y * edge.along[1])).store();
            let couple = x * edge.lever[0] + y * edge.lever[1];
            nodes[a] = [nodes[a][0] - ax, nodes[a][1] - ay, nodes[a][2] - couple];
            nodes[b] = [nodes[b][0] + bx, nodes[b][1] + by, nodes[b][2] + couple];
        }
        for (node, own) in cell.iter().zip(&nodes) {
            let own = present.map_or(*own, |present| present.slopes(*node, *own));
            let to = &mut to.nodes[node.index() - to.first_node];
            for i in 0..3 {
                to[i] = (own[i].load(&to[i]) + own[i]).store();
            }
        }
    }

    /// Adds the moments that modes make on the links of the star of one node; the sums have the form of a number.
    #[inline(always)]
    pub(super) fn add_change<T: Value<Stored = Lanes>, const D: usize>(
        &self,
        like: T,
        mesh: &Mesh,
        node: NodeId,
        (change, present): (&Modes, Option<&PresentPlaces>),
        moments: &mut [[Lanes; D]],
    ) {
        let forces = |node: NodeId| {
            let forces = load(like, &change.nodes[node.index()]);
            present.map_or(forces, |present| present.forces(node, forces))
        };
        let [x, y, turn] = forces(node);
        for (moment, face) in moments.iter_mut().zip(mesh.stars().star(node).links) {
            let Some(face) = *face else { continue };
            let ends = &mesh.face_nodes::<D>(face);
            let other = if ends[0] == node { ends[D - 1] } else { ends[0] };
            // The star leaves the element before the link by it: the node is the second one there.
            let edge = Edge::new::<D>(like, mesh, [other, node], present);
            let s = like.load(&change.edges[self.of(face)]);
            let couple = turn - forces(other)[2];
            let [a, b] = [like.load(&moment[0]), like.load(&moment[1])];
            moment[0] = (a + (x + (couple * edge.lever[0] + s * edge.along[0]))).store();
            moment[1] = (b + (y + (couple * edge.lever[1] + s * edge.along[1]))).store();
        }
    }
}

/// An edge of an element, from its first node to its second, counterclockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<T> {
    /// Unit vector along it, from the end of higher number to the lower one: the force of the mode of the edge on the
    /// element at the second node; at the first node there is the opposite one.
    pub(super) along: [T; 2],
    /// d⊥/|d|² with d from the first node to the second (1/m): the force at the second node of a unit couple about it.
    pub(super) lever: [T; 2],
}

impl<T: Value<Stored = Lanes>> Edge<T> {
    /// Of a body at rest, or in its present places.
    #[inline(always)]
    fn new<const D: usize>(
        like: T,
        mesh: &Mesh,
        [first, second]: [NodeId; 2],
        present: Option<&PresentPlaces>,
    ) -> Self {
        let (a, b) = (&mesh.points_in::<D>()[first.index()], &mesh.points_in::<D>()[second.index()]);
        let d = [b[0] - a[0], b[1] - a[1]];
        let inverse_square = 1.0 / (d[0] * d[0] + d[1] * d[1]);
        let inverse = if first < second { -inverse_square.sqrt() } else { inverse_square.sqrt() };
        let (along, lever) = ([inverse * d[0], inverse * d[1]], [-inverse_square * d[1], inverse_square * d[0]]);
        if let Some(present) = present {
            let [along, lever] = present.edge::<_, D>(like, mesh, [first, second], [along, lever]);
            return Self { along, lever };
        }
        Self { along: along.map(|x| like.fill(x)), lever: lever.map(|x| like.fill(x)) }
    }
}
