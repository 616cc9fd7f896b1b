//! The candidate facets and nodes of contact.

use super::{Cause, HeldBy, InputError};
use crate::ids::{FacetId, NodeId};
use crate::mesh::Mesh;
use crate::obstacle::Plane;
use std::collections::BTreeMap;

/// A facet faces a plane if its outward unit normal · n is below this.
const FACES: f64 = -1e-9;
/// A prescribed component of which the normal has no more than this is tangential.
const ALIGNED: f64 = 1e-12;

/// A node of the candidate facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNode {
    /// The node.
    pub node: NodeId,
    /// The plane it may touch.
    pub obstacle: usize,
    /// Distance to the plane of its place in the undeformed mesh (m).
    pub undeformed_gap: f64,
    /// Whether it is a candidate: its normal motion is not prescribed.
    pub free: bool,
    /// Whether its tangential motion is prescribed, as on a plane of symmetry: its tangential
    /// reaction is then the support's.
    pub guided: bool,
}

/// A facet that may touch a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFacet<const D: usize> {
    /// The facet.
    pub facet: FacetId,
    /// Positions of its nodes in [`ContactSurface::nodes`], in the order of the facet's nodes.
    pub nodes: [usize; D],
    /// Its area, with thickness or section (m²).
    pub area: f64,
    /// The plane it may touch.
    pub obstacle: usize,
}

/// All candidate facets, ordered along the boundary: in 2D a facet joins two nodes that follow
/// each other in [`ContactSurface::nodes`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSurface<const D: usize> {
    nodes: Vec<ContactNode>,
    facets: Vec<ContactFacet<D>>,
}

impl<const D: usize> ContactSurface<D> {
    /// Nodes of the candidate facets.
    #[must_use]
    pub fn nodes(&self) -> &[ContactNode] {
        &self.nodes
    }

    /// Candidate facets.
    #[must_use]
    pub fn facets(&self) -> &[ContactFacet<D>] {
        &self.facets
    }

    /// Tributary area (m²) of each node: its share of the candidate facets, ℓ_k of eq. \[45\].
    #[must_use]
    pub fn tributary_areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        for facet in &self.facets {
            facet.nodes.iter().for_each(|&at| areas[at] += facet.area / D as f64);
        }
        areas
    }

    /// The gap of a node with this displacement (m), eq. \[3\].
    #[inline]
    #[must_use]
    pub fn gap(&self, at: usize, displacement: &[f64; D], planes: &[Plane<D>]) -> f64 {
        let contact = &self.nodes[at];
        contact.undeformed_gap + crate::obstacle::dot(displacement, planes[contact.obstacle].normal())
    }

    /// Adds the facets that may touch a plane.
    pub(super) fn add<const N: usize>(
        &mut self,
        mesh: &Mesh<D, N>,
        index: usize,
        plane: &Plane<D>,
        held: impl Fn(FacetId) -> Option<HeldBy>,
        prescribed: impl Fn(NodeId) -> [bool; D],
        area: impl Fn(FacetId) -> f64,
    ) -> Result<(), InputError> {
        let facing = facing(mesh, plane, held).map_err(|(cause, key)| cause.at("obstacle", Some(index), key))?;
        let start = self.nodes.len();
        for node in along_the_boundary(mesh, &facing) {
            if let Some(other) = self.nodes[..start].iter().find(|c| c.node == node) {
                let cause = Cause::TwoPlanes { node: node.index(), first: other.obstacle + 1 };
                return Err(cause.at("obstacle", Some(index), "group"));
            }
            let undeformed_gap = plane.gap(&mesh.points()[node.index()]);
            let held = prescribed(node);
            let free = (0..D).all(|c| !held[c] || plane.normal()[c].abs() <= ALIGNED);
            let guided = free && held != [false; D];
            self.nodes.push(ContactNode { node, obstacle: index, undeformed_gap, free, guided });
        }
        if let Some(first) = self.nodes.get(start).filter(|_| self.nodes[start..].iter().all(|c| !c.free)) {
            return Err(Cause::HeldNodes { node: first.node.index() }.at("obstacle", Some(index), ""));
        }
        let position: BTreeMap<NodeId, usize> =
            self.nodes.iter().enumerate().skip(start).map(|(i, c)| (c.node, i)).collect();
        for facet in facing {
            let nodes = mesh.facets()[facet.index()].nodes.map(|n| position[&n]);
            self.facets.push(ContactFacet { facet, nodes, area: area(facet), obstacle: index });
        }
        self.facets[..].sort_by_key(|f| f.nodes.iter().copied().min());
        Ok(())
    }
}

/// Free facets, of the plane's group if it names one, that face the plane; or what is wrong, with the key.
fn facing<const D: usize, const N: usize>(
    mesh: &Mesh<D, N>,
    plane: &Plane<D>,
    held: impl Fn(FacetId) -> Option<HeldBy>,
) -> Result<Vec<FacetId>, (Cause, &'static str)> {
    let nodes = |facet: FacetId| mesh.facets()[facet.index()].nodes.map(NodeId::index).to_vec();
    let faces = |&facet: &FacetId| crate::obstacle::dot(&mesh.facet_normal(facet).0, plane.normal()) < FACES;
    let mut found: Vec<FacetId>;
    if let Some(name) = plane.group() {
        let group = super::boundary::facet_group(mesh, name).map_err(|cause| (cause, "group"))?;
        if let Some((facet, by)) = group.iter().find_map(|&facet| Some((facet, held(facet)?))) {
            return Err((Cause::NotFree { nodes: nodes(facet), by }, "group"));
        }
        found = group.iter().copied().filter(faces).collect();
        if found.is_empty() {
            return Err((nothing_faces(mesh, plane, name, group), "group"));
        }
    } else {
        found = mesh.boundary().filter(faces).collect();
        // A closed boundary looks everywhere: something always faces the plane.
        let first = found.first().and_then(|&facet| Some((facet, held(facet)?)));
        found.retain(|&facet| held(facet).is_none());
        if let (Some((facet, by)), true) = (first, found.is_empty()) {
            return Err((Cause::AllHeld { nodes: nodes(facet), by }, ""));
        }
    }
    Ok(found)
}

/// What a group that does not face a plane looks at, and which groups do face it.
fn nothing_faces<const D: usize, const N: usize>(
    mesh: &Mesh<D, N>,
    plane: &Plane<D>,
    name: &str,
    group: &[FacetId],
) -> Cause {
    let mean = |facets: &[FacetId]| {
        let mut sum = [0.0; D];
        for &facet in facets {
            let (normal, area) = mesh.facet_normal(facet);
            (0..D).for_each(|c| sum[c] += area * normal[c]);
        }
        let length = crate::obstacle::dot(&sum, &sum).sqrt();
        // A few digits are enough to be shown.
        sum.map(|s| if length > 0.0 { (1e3 * s / length).round() / 1e3 } else { 0.0 })
    };
    let outward = mean(group);
    let looks = |facets: &[FacetId]| crate::obstacle::dot(&mean(facets), plane.normal()) < FACES;
    let facing = mesh.facet_groups().iter().filter(|(_, facets)| looks(facets)).map(|(name, _)| name.clone()).collect();
    let normal = plane.normal().map(|n| (1e3 * n).round() / 1e3);
    Cause::NothingFaces { group: name.to_string(), outward: Box::new(outward), normal: Box::new(normal), facing }
}

/// Nodes of the facets, piece by piece along the boundary. A piece is never closed: not all
/// facets of a closed curve face the same plane.
fn along_the_boundary<const D: usize, const N: usize>(mesh: &Mesh<D, N>, facets: &[FacetId]) -> Vec<NodeId> {
    let mut neighbours: BTreeMap<NodeId, Vec<NodeId>> = BTreeMap::new();
    for facet in facets {
        let nodes = &mesh.facets()[facet.index()].nodes;
        for node in nodes {
            neighbours.entry(*node).or_default().extend(nodes.iter().filter(|n| *n != node));
        }
    }
    let mut ordered: Vec<NodeId> = Vec::with_capacity(neighbours.len());
    let ends: Vec<NodeId> = neighbours.iter().filter(|(_, n)| n.len() < 2).map(|(n, _)| *n).collect();
    for end in ends {
        let mut next = neighbours.contains_key(&end).then_some(end);
        while let Some(node) = next {
            let around = neighbours.remove(&node).unwrap_or_default();
            ordered.push(node);
            next = around.into_iter().find(|n| neighbours.contains_key(n));
        }
    }
    ordered
}
