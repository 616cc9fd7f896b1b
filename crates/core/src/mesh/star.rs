//! The elements around each node: in the plane in counterclockwise order, with the faces between them.

use super::MeshError;
use super::topology::Faces;
use crate::cell::Cell;
use crate::ids::{ElementId, FaceId, NodeId};

/// The stars of all nodes, one after the other.
///
/// A star of k elements is a chain: face, element, face, …, element, face, in counterclockwise order (in 1D from
/// left to right). An interior node of a 2D mesh has a closed chain whose first and last face are the same; in 1D,
/// where an element has a single face at a node, the outer ends of the chain are `None`. In 3D no order goes around a
/// node: a star has its elements and, as links, the faces at the node, both ascending.
#[derive(Clone, Debug, Default)]
pub struct Stars {
    offsets: Vec<u32>,
    elements: Vec<ElementId>,
    links: Vec<Option<FaceId>>,
    /// Where the links of each star begin; empty where they follow from the elements of a chain.
    link_offsets: Vec<u32>,
}

/// The star of one node.
#[derive(Clone, Copy, Debug)]
pub struct Star<'a> {
    /// Elements in the order of the chain; ascending in 3D.
    pub elements: &'a [ElementId],
    /// Face before, between and after them: one more than elements. In 3D all faces at the node, ascending.
    pub links: &'a [Option<FaceId>],
}

impl Star<'_> {
    /// Whether the chain closes on itself.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        matches!(self.links, [Some(first), .., Some(last)] if first == last)
    }

    /// The place of a face among the links of a star without order.
    #[must_use]
    pub fn place_of(&self, face: FaceId) -> usize {
        self.links.partition_point(|link| *link < Some(face))
    }
}

impl Stars {
    /// The star of a node.
    #[inline]
    #[must_use]
    pub fn star(&self, node: NodeId) -> Star<'_> {
        let i = node.index();
        let elements = &self.elements[self.offsets[i] as usize..self.offsets[i + 1] as usize];
        Star { elements, links: &self.links[self.link_range(node)] }
    }

    /// Where the links of a star lie among those of all stars.
    #[inline]
    #[must_use]
    pub fn link_range(&self, node: NodeId) -> std::ops::Range<usize> {
        let i = node.index();
        match self.link_offsets.get(i..i + 2) {
            Some(range) => range[0] as usize..range[1] as usize,
            // Each earlier star holds one link more than elements.
            None => self.offsets[i] as usize + i..self.offsets[i + 1] as usize + i + 1,
        }
    }

    /// Number of links in all stars.
    #[must_use]
    pub fn link_count(&self) -> usize {
        self.links.len()
    }

    /// The stars after renumbering, which keeps the order around each node: `nodes` has the old number of each new
    /// node. A closed chain begins at its lowest element.
    pub(super) fn renumbered(&self, nodes: &[NodeId], element: &[u32], face: &[u32]) -> Self {
        let mut stars = Self {
            offsets: Vec::with_capacity(self.offsets.len()),
            elements: Vec::with_capacity(self.elements.len()),
            links: Vec::with_capacity(self.links.len()),
            link_offsets: Vec::with_capacity(self.link_offsets.len()),
        };
        stars.offsets.push(0);
        let has_order = self.link_offsets.is_empty();
        stars.link_offsets.extend((!has_order).then_some(0));
        let element = |e: &ElementId| ElementId::new(element[e.index()] as usize);
        let face = |f: &Option<FaceId>| f.map(|f| FaceId::new(face[f.index()] as usize));
        for &node in nodes {
            let star = self.star(node);
            let (at, count) = (stars.elements.len(), star.elements.len());
            stars.elements.extend(star.elements.iter().map(element));
            if !has_order {
                let links = stars.links.len();
                stars.links.extend(star.links.iter().map(face));
                stars.links[links..].sort_unstable();
                stars.elements[at..].sort_unstable();
                stars.link_offsets.push(stars.links.len() as u32);
                stars.offsets.push(stars.elements.len() as u32);
                continue;
            }
            stars.links.extend(star.links[..count].iter().map(face));
            if star.is_closed() {
                let around = &mut stars.elements[at..];
                let lowest = (0..count).min_by_key(|&k| around[k]).unwrap_or(0);
                around.rotate_left(lowest);
                let links = stars.links.len() - count;
                stars.links[links..].rotate_left(lowest);
                stars.links.push(stars.links[links]);
            } else {
                stars.links.push(face(&star.links[count]));
            }
            stars.offsets.push(stars.elements.len() as u32);
        }
        stars
    }

    /// Builds all stars; a star that falls into several chains is a non-manifold node.
    pub(super) fn new<const D: usize, const N: usize>(
        kind: &dyn Cell<D, N>,
        node_count: usize,
        cells: &[[NodeId; N]],
        faces: &Faces,
        cell_faces: &[[FaceId; N]],
    ) -> Result<Self, MeshError> {
        let (faces_around, (starts, incident)) = (kind.faces_around(), incident_elements(node_count, cells));
        if D == 3 {
            return Self::without_order(starts, incident, cells, faces, cell_faces);
        }
        let mut stars = Self {
            offsets: Vec::with_capacity(node_count + 1),
            elements: Vec::with_capacity(N * cells.len()),
            links: Vec::with_capacity(N * cells.len() + node_count),
            link_offsets: Vec::new(),
        };
        stars.offsets.push(0);
        let sides = |element: ElementId, node: NodeId| {
            let local = cells[element.index()].iter().position(|&n| n == node).unwrap_or(0);
            faces_around[local].map(|side| side.map(|k| cell_faces[element.index()][k]))
        };
        let is_end = |face: Option<FaceId>| face.is_none_or(|f| faces.sides[f.index()].1.is_none());
        for i in 0..node_count {
            let (node, around) = (NodeId::new(i), &incident[starts[i] as usize..starts[i + 1] as usize]);
            let first = around.iter().copied().find(|&e| is_end(sides(e, node)[0])).unwrap_or(around[0]);
            let start = sides(first, node)[0];
            let mut element = first;
            let mut count = 0;
            stars.links.push(start);
            loop {
                let exit = sides(element, node)[1];
                stars.elements.push(element);
                stars.links.push(exit);
                count += 1;
                let Some(face) = exit.filter(|_| exit != start) else { break };
                let (owner, neighbour) = faces.sides[face.index()];
                let Some(next) = neighbour.map(|n| if n == element { owner } else { n }) else { break };
                element = next;
            }
            if count != around.len() {
                return Err(MeshError::NonManifoldNode { node: i, elements: around.len(), reached: count });
            }
            stars.offsets.push(stars.elements.len() as u32);
        }
        Ok(stars)
    }
}

impl Stars {
    /// The stars of a solid; elements around a node that are not joined by faces at it are refused.
    fn without_order<const N: usize>(
        starts: Vec<u32>,
        incident: Vec<ElementId>,
        cells: &[[NodeId; N]],
        faces: &Faces,
        cell_faces: &[[FaceId; N]],
    ) -> Result<Self, MeshError> {
        let (mut reached, mut links, mut link_offsets): (Vec<ElementId>, Vec<Option<FaceId>>, _) =
            (Vec::new(), Vec::with_capacity(3 * faces.len()), vec![0]);
        for (node, range) in starts.windows(2).enumerate().take(starts.len() - 2) {
            let around = &incident[range[0] as usize..range[1] as usize];
            reached.clear();
            reached.push(around[0]);
            let (mut at, first) = (0, links.len());
            while let Some(&element) = reached.get(at) {
                at += 1;
                let own = cells[element.index()].iter().zip(&cell_faces[element.index()]);
                // A face is at all nodes but that opposite to it.
                for (_, face) in own.filter(|(opposite, _)| opposite.index() != node) {
                    let known = faces.get(face.index());
                    links.extend((known.owner == element).then_some(Some(*face)));
                    reached.extend(known.across(element).filter(|other| !reached.contains(other)));
                }
            }
            if reached.len() != around.len() {
                return Err(MeshError::NonManifoldSolid { node, elements: around.len(), reached: reached.len() });
            }
            links[first..].sort_unstable();
            link_offsets.push(links.len() as u32);
        }
        Ok(Self { offsets: starts[..starts.len() - 1].to_vec(), elements: incident, links, link_offsets })
    }
}

/// Elements that hold each node, ascending, and where those of each node begin.
fn incident_elements<const N: usize>(node_count: usize, cells: &[[NodeId; N]]) -> (Vec<u32>, Vec<ElementId>) {
    let mut starts = vec![0_u32; node_count + 2];
    for node in cells.iter().flatten() {
        starts[node.index() + 2] += 1;
    }
    for i in 2..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut incident = vec![ElementId::new(0); N * cells.len()];
    for (e, cell) in cells.iter().enumerate() {
        for node in cell {
            let slot = &mut starts[node.index() + 1];
            incident[*slot as usize] = ElementId::new(e);
            *slot += 1;
        }
    }
    (starts, incident)
}

#[cfg(test)]
mod tests {
    use crate::ids::NodeId;
    use crate::mesh::{ElementGroups, FaceGroups, Mesh, MeshError};

    #[test]
    fn stars_of_a_square() {
        let mesh = Mesh::rectangle(1.0, 1.0, 2, 2).unwrap();
        let sizes: Vec<_> = (0..9).map(|i| mesh.stars().star(NodeId::new(i)).elements.len()).collect();
        assert_eq!(sizes, [2, 3, 1, 3, 6, 3, 1, 3, 2]);
        let closed: Vec<_> = (0..9).map(|i| mesh.stars().star(NodeId::new(i)).is_closed()).collect();
        assert_eq!(closed.iter().filter(|c| **c).count(), 1);
        assert!(closed[4]);
        for i in [0, 1, 2, 3, 5, 6, 7, 8] {
            let star = mesh.stars().star(NodeId::new(i));
            for end in [star.links[0], star.links[star.links.len() - 1]] {
                assert_eq!(mesh.face(end.unwrap()).neighbour, None);
            }
        }
    }

    #[test]
    fn elements_on_the_same_side_of_a_face_overlap() {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.5, 2.0]];
        let made = Mesh::new(points, &[[0, 1, 2], [0, 1, 3]], &FaceGroups::new(), &ElementGroups::new());
        assert_eq!(made.unwrap_err(), MeshError::Overlap { elements: [0, 1] });
    }

    #[test]
    fn stars_of_a_bar() {
        let mesh = Mesh::uniform_bar(1.0, 2).unwrap();
        let star = |i: usize| mesh.stars().star(NodeId::new(i));
        assert_eq!((star(0).links[0].is_some(), star(0).links[1]), (true, None));
        assert_eq!((star(1).links[0], star(1).links[1].is_some(), star(1).links[2]), (None, true, None));
        assert!(!star(1).is_closed());
    }
}
