//! The same mesh under other numbers.

use super::order::{inverse, sorted};
use super::topology::Faces;
use super::{Face, Mesh, Numbering, in_kind};
use crate::ids::{ElementId, FaceId, NodeId};
use std::collections::BTreeMap;

/// New numbers by old ones: what a [`Numbering`] holds the other way round.
pub(crate) struct NewNumbers {
    pub(crate) node: Vec<u32>,
    pub(crate) element: Vec<u32>,
    pub(crate) face: Vec<u32>,
}

impl NewNumbers {
    /// The new number of a node.
    pub(crate) fn node(&self, old: NodeId) -> NodeId {
        NodeId::new(self.node[old.index()] as usize)
    }

    /// The new number of an element.
    pub(crate) fn element(&self, old: ElementId) -> ElementId {
        ElementId::new(self.element[old.index()] as usize)
    }

    /// The new number of a face.
    pub(crate) fn face(&self, old: FaceId) -> FaceId {
        FaceId::new(self.face[old.index()] as usize)
    }

    /// The values at the nodes of an old face in the order of its new nodes.
    pub(crate) fn along<T: Copy, const D: usize>(&self, old: &[NodeId; D], values: [T; D]) -> [T; D] {
        let mut order: [usize; D] = std::array::from_fn(|p| p);
        order.sort_unstable_by_key(|&p| self.node(old[p]));
        order.map(|p| values[p])
    }
}

impl Mesh {
    /// The mesh under new numbers, and those by the old ones: as if it were made from the renumbered points, elements
    /// and groups. Each element keeps the order of its nodes.
    pub(crate) fn renumbered(&self, numbering: &Numbering) -> (Self, NewNumbers) {
        let (nodes, elements) = (numbering.nodes(), numbering.elements());
        let mut new = NewNumbers { node: inverse(nodes), element: vec![0; elements.len()], face: Vec::new() };
        elements.iter().enumerate().for_each(|(at, old)| new.element[old.index()] = at as u32);
        let order = in_kind!(self, D, N => {
            let ends = |f: usize| {
                let mut ends = self.face_nodes::<D>(FaceId::new(f)).map(|node| new.node[node.index()]);
                ends.sort_unstable();
                ends
            };
            sorted(self.faces.len(), nodes.len(), ends)
        });
        new.face = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, &old)| new.face[old as usize] = at as u32);

        let mut points = Vec::new();
        numbering.order_nodal(&self.points, &mut points);
        let mut faces = Faces { width: self.faces.width, ..Faces::default() };
        order.iter().for_each(|&old| push_renumbered(self.faces.get(old as usize), &new, &mut faces));
        let mesh = Self {
            kind: self.kind,
            points,
            cells: elements.iter().flat_map(|&e| self.cell(e)).map(|&node| new.node(node)).collect(),
            faces,
            cell_faces: elements.iter().flat_map(|&e| self.cell_faces(e)).map(|&f| new.face(f)).collect(),
            stars: self.stars.renumbered(nodes, &new.element, &new.face),
            face_groups: groups(&self.face_groups, |f| new.face(f)),
            element_groups: groups(&self.element_groups, |e| new.element(e)),
            size: self.size,
            reoriented: self.reoriented,
            parts: self.parts,
            touching: self.touching_renumbered(&new),
            import_warnings: self.import_warnings.clone(),
        };
        (mesh, new)
    }

    /// The elements that touch under new numbers, in ascending order.
    fn touching_renumbered(&self, new: &NewNumbers) -> Vec<[ElementId; 2]> {
        let ascending = |pair: &[ElementId; 2]| {
            let [a, b] = pair.map(|element| new.element(element));
            [a.min(b), a.max(b)]
        };
        let mut touching: Vec<_> = self.touching.iter().map(ascending).collect();
        touching.sort_unstable();
        touching
    }
}

/// A face under new numbers; the lower element owns it.
fn push_renumbered(face: Face<'_>, new: &NewNumbers, faces: &mut Faces) {
    let first = faces.nodes.len();
    let (owner, neighbour) = (new.element(face.owner), face.neighbour.map(|e| new.element(e)));
    let [low, high] = neighbour.map_or([owner; 2], |other| [owner.min(other), owner.max(other)]);
    faces.nodes.extend(face.nodes.iter().map(|&node| new.node(node)));
    faces.nodes[first..].sort_unstable();
    faces.sides.push((low, neighbour.map(|_| high)));
}

fn groups<Id: Copy + Ord>(groups: &BTreeMap<String, Vec<Id>>, new: impl Fn(Id) -> Id) -> BTreeMap<String, Vec<Id>> {
    let renumbered = |members: &Vec<Id>| {
        let mut members: Vec<Id> = members.iter().map(|&id| new(id)).collect();
        members.sort_unstable();
        members
    };
    groups.iter().map(|(name, members)| (name.clone(), renumbered(members))).collect()
}
