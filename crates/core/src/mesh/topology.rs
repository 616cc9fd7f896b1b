//! Faces shared by elements.

use super::MeshError;
use crate::ids::{ElementId, FaceId, NodeId};
use std::cmp::Ordering;

/// A triangle in 3D, an edge in 2D, a point in 1D.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face<'m> {
    /// Its nodes, in ascending order.
    pub nodes: &'m [NodeId],
    /// The element whose outward normal orients the face.
    pub owner: ElementId,
    /// The element on the other side, none on the boundary.
    pub neighbour: Option<ElementId>,
}

impl Face<'_> {
    /// +1 seen from the owner, −1 from the neighbour: the sign η of the equilibrated tractions.
    #[inline]
    #[must_use]
    pub fn sign(&self, element: ElementId) -> f64 {
        if self.owner == element { 1.0 } else { -1.0 }
    }

    /// The element on the other side of one of its elements; none on the boundary.
    #[inline]
    #[must_use]
    pub fn across(&self, element: ElementId) -> Option<ElementId> {
        if self.owner == element { self.neighbour } else { Some(self.owner) }
    }

    /// Position of `node` among the face's nodes.
    #[inline]
    #[must_use]
    pub fn position(&self, node: NodeId) -> usize {
        self.nodes.iter().position(|&other| other == node).unwrap_or(0)
    }
}

/// The faces of a mesh, as data.
#[derive(Clone, Debug, Default)]
pub(super) struct Faces {
    /// Nodes of each face: the dimension of the mesh.
    pub(super) width: usize,
    /// Nodes of all faces, in rows.
    pub(super) nodes: Vec<NodeId>,
    /// The elements of each face.
    pub(super) sides: Vec<(ElementId, Option<ElementId>)>,
}

impl Faces {
    pub(super) fn len(&self) -> usize {
        self.sides.len()
    }

    pub(super) fn get(&self, face: usize) -> Face<'_> {
        let (owner, neighbour) = self.sides[face];
        Face { nodes: &self.nodes[self.width * face..self.width * (face + 1)], owner, neighbour }
    }

    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = Face<'_>> {
        (0..self.len()).map(|face| self.get(face))
    }

    /// The face with these nodes, ascending.
    pub(super) fn find(&self, nodes: &[NodeId]) -> Option<usize> {
        let (mut low, mut high) = (0, self.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            match self.get(middle).nodes.cmp(nodes) {
                Ordering::Less => low = middle + 1,
                Ordering::Greater => high = middle,
                Ordering::Equal => return Some(middle),
            }
        }
        None
    }

    pub(super) fn push(&mut self, nodes: &[NodeId], owner: ElementId, neighbour: Option<ElementId>) {
        self.nodes.extend_from_slice(nodes);
        self.sides.push((owner, neighbour));
    }
}

/// Nodes of the face opposite to local node `k`, ascending.
fn opposite<const D: usize, const N: usize>(cell: &[NodeId; N], k: usize) -> [NodeId; D] {
    let mut nodes = [cell[0]; D];
    let others = cell.iter().enumerate().filter(|&(i, _)| i != k);
    for (slot, (_, &node)) in nodes.iter_mut().zip(others) {
        *slot = node;
    }
    nodes.sort_unstable();
    nodes
}

/// Whether a face, seen from its element in counterclockwise order, has its nodes in an even permutation of their
/// ascending order; in 1D, whether it is the right end. Two elements on either side differ.
fn is_even<const D: usize, const N: usize>(cells: &[[NodeId; N]], side: &([NodeId; D], ElementId, u8)) -> bool {
    let (cell, k) = (&cells[side.1.index()], usize::from(side.2));
    let node = |p: usize| cell[(k + 1 + p) % N];
    let inversions = (0..D).map(|p| (0..p).filter(|&q| node(q) > node(p)).count()).sum::<usize>();
    // The nodes follow each other from k + 1 on: a rotation of the element's by k + 1 places, each of them D
    // transpositions.
    (inversions + k * D).is_multiple_of(2)
}

/// All faces in the order of their nodes, and those of each element.
pub(super) fn faces<const D: usize, const N: usize>(
    cells: &[[NodeId; N]],
) -> Result<(Faces, Vec<[FaceId; N]>), MeshError> {
    let mut sides: Vec<([NodeId; D], ElementId, u8)> = Vec::with_capacity(cells.len() * N);
    for (e, cell) in cells.iter().enumerate() {
        for k in 0..N {
            sides.push((opposite(cell, k), ElementId::new(e), k as u8));
        }
    }
    sides.sort_unstable();

    let mut faces = Faces { width: D, ..Faces::default() };
    let mut cell_faces = vec![[FaceId::new(0); N]; cells.len()];
    for shared in sides.chunk_by(|a, b| a.0 == b.0) {
        if shared.len() > 2 {
            return Err(MeshError::NonManifoldFace {
                nodes: shared[0].0.iter().map(|n| n.index()).collect(),
                elements: shared.iter().map(|s| s.1.index()).collect(),
            });
        }
        if let [one, other] = shared
            && is_even(cells, one) == is_even(cells, other)
        {
            return Err(MeshError::Overlap { elements: [one.1.index(), other.1.index()] });
        }
        let id = FaceId::new(faces.len());
        faces.push(&shared[0].0, shared[0].1, shared.get(1).map(|s| s.1));
        for side in shared {
            cell_faces[side.1.index()][usize::from(side.2)] = id;
        }
    }
    faces.nodes.shrink_to_fit();
    faces.sides.shrink_to_fit();
    Ok((faces, cell_faces))
}
