//! The candidate faces and nodes of contact, with their obstacles.

use super::coulomb::Coulomb;
use super::frame::Frame;
use super::mortar::{ContactConfiguration, NonMatchingSurfaces};
use super::obstacle::Obstacle;
use crate::ids::{FaceId, NodeId};
use crate::mesh::{Mesh, NewNumbers};

/// A node of the candidate faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNode {
    /// The node.
    pub node: NodeId,
    /// The obstacle it may touch.
    pub obstacle: usize,
    /// Gap of its place in the undeformed mesh (m); infinite on a non-matching interface, where it may touch all of the
    /// other side, of which [`ContactConfiguration::gap`] has the gap.
    pub undeformed_gap: f64,
    /// Whether it is a candidate: its normal motion is not prescribed.
    pub free: bool,
    /// Whether its tangential motion is prescribed, as on a plane of symmetry: its tangential
    /// reaction is then the support's.
    pub guided: bool,
    /// The node of another body that it may touch, by its position in [`ContactSurface::nodes`]; `None` at a rigid
    /// obstacle. The two have each other, and opposite reactions.
    pub partner: Option<usize>,
    /// The other slot of the same node, for a second plane that it may touch, by its position in
    /// [`ContactSurface::nodes`].
    pub second_slot: Option<usize>,
}

/// A face that may touch an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFace<const D: usize> {
    /// The face.
    pub face: FaceId,
    /// Positions of its nodes in [`ContactSurface::nodes`], in the order of the face's nodes.
    pub nodes: [usize; D],
    /// Its area, with thickness or section (m²).
    pub area: f64,
    /// The obstacle it may touch.
    pub obstacle: usize,
}

/// All obstacles and all candidate faces, ordered along the boundary: in 2D a face joins two nodes that follow
/// each other in [`ContactSurface::nodes`], or the ends of a closed curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSurface<const D: usize> {
    obstacles: Vec<Obstacle<D>>,
    nodes: Vec<ContactNode>,
    /// Places of the nodes in the undeformed mesh (m).
    points: Vec<[f64; D]>,
    faces: Vec<ContactFace<D>>,
    non_matching: Vec<NonMatchingSurfaces<D>>,
}

impl<const D: usize> ContactSurface<D> {
    /// The obstacles.
    #[must_use]
    pub fn obstacles(&self) -> &[Obstacle<D>] {
        &self.obstacles
    }

    /// Nodes of the candidate faces.
    #[must_use]
    pub fn nodes(&self) -> &[ContactNode] {
        &self.nodes
    }

    /// Place of a node in the undeformed mesh (m).
    #[must_use]
    pub fn point(&self, at: usize) -> &[f64; D] {
        &self.points[at]
    }

    /// Candidate faces.
    #[must_use]
    pub fn faces(&self) -> &[ContactFace<D>] {
        &self.faces
    }

    /// All non-matching interfaces.
    #[inline]
    #[must_use]
    pub fn non_matching(&self) -> &[NonMatchingSurfaces<D>] {
        &self.non_matching
    }

    /// Which of [`ContactSurface::non_matching`] a node belongs to.
    #[inline]
    #[must_use]
    pub fn non_matching_of(&self, at: usize) -> Option<usize> {
        self.obstacles[self.nodes[at].obstacle].non_matching()
    }

    /// What each node faces with these displacements of all nodes of the mesh (m).
    #[must_use]
    pub fn configuration(&self, displacement: &[[f64; D]]) -> ContactConfiguration<'_, D> {
        ContactConfiguration::new(self, displacement)
    }

    /// Tributary area (m²) of each node: its share of the candidate faces, ℓ_k of eq. \[45\].
    #[must_use]
    pub fn tributary_areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        for face in &self.faces {
            face.nodes.iter().for_each(|&at| areas[at] += face.area / D as f64);
        }
        areas
    }

    /// The value of a nodal field at a node less that at the node that it may touch, if there is one: displacement or
    /// velocity against the obstacle. [`ContactConfiguration::relative`] has it for non-matching interfaces, too.
    #[inline]
    #[must_use]
    pub fn against_obstacle(&self, at: usize, field: &[[f64; D]]) -> [f64; D] {
        let contact = &self.nodes[at];
        let own = field[contact.node.index()];
        let Some(partner) = contact.partner else { return own };
        let other = &field[self.nodes[partner].node.index()];
        std::array::from_fn(|c| own[c] - other[c])
    }

    /// Whether contact is solved for at a node: of two nodes that may touch, at the first one; of non-matching
    /// interfaces, on the slave.
    #[inline]
    #[must_use]
    pub fn leads(&self, at: usize) -> bool {
        match self.non_matching_of(at) {
            Some(index) => self.non_matching[index].slave().node_at(at).is_some(),
            None => self.nodes[at].partner.is_none_or(|partner| at < partner),
        }
    }

    /// Whether a node is at a plane, or on the first one of two surfaces that may touch.
    #[inline]
    #[must_use]
    pub fn is_of_first(&self, at: usize) -> bool {
        match self.non_matching_of(at) {
            Some(index) => {
                let [slave, master] = [self.non_matching[index].slave(), self.non_matching[index].master()];
                at < slave.position(0).max(master.position(0))
            }
            None => self.leads(at),
        }
    }

    /// The mass that a force between a node and its obstacle moves (kg), from those of all nodes: 1/(1/m + 1/m') of two
    /// nodes.
    #[inline]
    #[must_use]
    pub fn moved_mass(&self, at: usize, mass: &[f64]) -> f64 {
        let contact = &self.nodes[at];
        let own = mass[contact.node.index()];
        contact.partner.map_or(own, |partner| 1.0 / (1.0 / own + 1.0 / mass[self.nodes[partner].node.index()]))
    }

    /// The part of a motion against the obstacle that the node itself does if forces between the two cause it: 1 at a
    /// rigid obstacle, m'/(m + m') of two nodes, of which m' is the mass of the other one.
    #[inline]
    #[must_use]
    pub fn own_part(&self, at: usize, mass: &[f64]) -> f64 {
        let contact = &self.nodes[at];
        let own = mass[contact.node.index()];
        contact.partner.map_or(1.0, |partner| {
            let other = mass[self.nodes[partner].node.index()];
            other / (own + other)
        })
    }

    /// The part of a contact that is counted at a node: all of it at a rigid obstacle, half at each of two nodes.
    #[inline]
    #[must_use]
    pub fn part_of_contact(&self, at: usize) -> f64 {
        if self.nodes[at].partner.is_some() { 0.5 } else { 1.0 }
    }

    /// The first slot of the node of a slot.
    #[inline]
    #[must_use]
    pub fn first_entry(&self, at: usize) -> usize {
        self.nodes[at].second_slot.map_or(at, |second_slot| at.min(second_slot))
    }

    /// Whether a face has a node that may touch two planes.
    #[inline]
    #[must_use]
    pub fn reaches_a_corner(&self, face: &ContactFace<D>) -> bool {
        face.nodes.iter().any(|&at| self.nodes[at].second_slot.is_some())
    }

    /// The force that the contact forces at all its obstacles do on a node.
    #[inline]
    #[must_use]
    pub fn force_on_node(&self, at: usize, forces: &[[f64; D]]) -> [f64; D] {
        let own = forces[at];
        self.nodes[at].second_slot.map_or(own, |second_slot| std::array::from_fn(|c| own[c] + forces[second_slot][c]))
    }

    /// The gap of a node with this displacement against its obstacle (m), eq. \[3\].
    #[inline]
    #[must_use]
    pub fn gap(&self, at: usize, displacement: &[f64; D]) -> f64 {
        let contact = &self.nodes[at];
        self.obstacles[contact.obstacle].gap_after(contact.undeformed_gap, displacement)
    }

    /// The gaps of its nodes (m), with these displacements of all nodes of the mesh.
    #[must_use]
    pub fn gaps(&self, displacement: &[[f64; D]]) -> Vec<f64> {
        let configuration = self.configuration(displacement);
        (0..self.nodes.len()).map(|at| configuration.gap(at, displacement)).collect()
    }

    /// The frame at a node with this displacement.
    #[inline]
    #[must_use]
    pub fn frame(&self, at: usize, displacement: &[f64; D]) -> Frame<D> {
        let place = std::array::from_fn(|c| self.points[at][c] + displacement[c]);
        self.obstacles[self.nodes[at].obstacle].frame_at(&place)
    }

    /// The law of contact at a node. At a guided node of a plane body the support takes the tangential reaction; one of
    /// a solid may slide in the other direction, with friction.
    #[inline]
    pub(super) fn law(&self, at: usize) -> Coulomb {
        let contact = &self.nodes[at];
        if contact.guided && D < 3 { Coulomb::FRICTIONLESS } else { self.obstacles[contact.obstacle].law() }
    }

    /// The surface of the renumbered mesh: nodes and faces in the same order.
    pub(crate) fn renumbered(&self, old: &Mesh, new: &NewNumbers) -> Self {
        let node = |contact: &ContactNode| ContactNode { node: new.node(contact.node), ..*contact };
        let face = |face: &ContactFace<D>| {
            let nodes = &old.face_nodes::<D>(face.face);
            ContactFace { face: new.face(face.face), nodes: new.along(nodes, face.nodes), ..*face }
        };
        Self {
            obstacles: self.obstacles.clone(),
            nodes: self.nodes.iter().map(node).collect(),
            points: self.points.clone(),
            faces: self.faces.iter().map(face).collect(),
            non_matching: self.non_matching.clone(),
        }
    }

    /// Moves a plane against its normal by a distance (m).
    pub(crate) fn move_back(&mut self, obstacle: usize, distance: f64) {
        self.obstacles[obstacle] = self.obstacles[obstacle].moved_back(distance);
        let Some(plane) = self.obstacles[obstacle].as_plane() else { return };
        for (contact, point) in self.nodes.iter_mut().zip(&self.points).filter(|(c, _)| c.obstacle == obstacle) {
            contact.undeformed_gap = plane.gap(point);
        }
    }

    /// Puts a plane that states a gap in its place, with these displacements of all nodes of the mesh (m).
    pub(crate) fn place(&mut self, obstacle: usize, displacement: &[[f64; D]]) {
        let Some(gap) = self.obstacles[obstacle].gap_to_place() else { return };
        let nodes = self.nodes.iter().enumerate().filter(|(_, c)| c.obstacle == obstacle && c.free);
        let gaps = nodes.map(|(at, c)| self.gap(at, &displacement[c.node.index()]));
        let least = gaps.fold(f64::INFINITY, f64::min);
        self.move_back(obstacle, gap - least);
    }

    /// Adds a non-matching interface, of which the nodes and faces have been added.
    pub(crate) fn add_non_matching(&mut self, non_matching: NonMatchingSurfaces<D>) {
        self.non_matching.push(non_matching);
    }

    /// Adds an obstacle with its candidates. The faces have positions in `nodes`.
    pub(crate) fn add(
        &mut self,
        obstacle: Obstacle<D>,
        nodes: impl IntoIterator<Item = (ContactNode, [f64; D])>,
        faces: impl IntoIterator<Item = ContactFace<D>>,
    ) {
        let start = self.nodes.len();
        for (node, point) in nodes {
            if let Some(first) = node.second_slot {
                self.nodes[first].second_slot = Some(self.nodes.len());
            }
            self.nodes.push(node);
            self.points.push(point);
        }
        self.faces.extend(faces.into_iter().map(|f| ContactFace { nodes: f.nodes.map(|at| start + at), ..f }));
        self.faces.sort_by_key(|f| f.nodes.iter().copied().min());
        self.obstacles.push(obstacle);
    }
}
