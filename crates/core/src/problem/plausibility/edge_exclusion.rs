//! An edge next to a contact that a support excludes from it.

use super::{PlausibilityWarning, plausibility_warning};
use crate::contact::{dot, tangent};
use crate::ids::{FaceId, NodeId};
use crate::problem::Problem;
use crate::problem::alignment::FACES;
use std::collections::BTreeSet;

/// Smaller components of a normal, and parts of an edge, are rounding.
const ROUNDING: f64 = 1e-9;

/// An edge next to a surface that faces the other surface at the start without belonging to its own, because a support
/// holds one of its nodes across the contact: the other body may enter there without a force. Of surfaces that the user
/// names, the edges are chosen.
pub(super) fn plausibility_warnings<const D: usize>(problem: &Problem<D>) -> Option<PlausibilityWarning> {
    let (mesh, surface) = (problem.mesh(), problem.surface());
    let held: BTreeSet<(NodeId, usize)> = problem.prescribed().iter().map(|p| (p.node, p.component)).collect();
    // None of them has a node that is held.
    if held.is_empty() {
        return None;
    }
    let loaded: BTreeSet<FaceId> = problem.face_loads().iter().map(|load| load.face).collect();
    let in_contact: BTreeSet<FaceId> = surface.faces().iter().map(|face| face.face).collect();
    for index in 0..problem.obstacles().len() {
        let place = problem.place_of_obstacle(index);
        let Some(partner) = problem.partner_obstacle(index).filter(|_| place.key != "groups") else { continue };
        let normal = *problem.obstacles()[index].flat_frame().normal();
        let along = tangent(&normal);
        let range = |face: FaceId| {
            let nodes = mesh.face_nodes::<D>(face).into_iter();
            nodes
                .map(|node| dot(&mesh.points_in::<D>()[node.index()], &along))
                .fold(NOTHING, |[low, high], xi| [low.min(xi), high.max(xi)])
        };
        let of = |obstacle: usize| surface.faces().iter().filter(move |face| face.obstacle == obstacle);
        let other = of(partner)
            .map(|face| range(face.face))
            .fold(NOTHING, |[low, high], [from, to]| [low.min(from), high.max(to)]);
        let own: BTreeSet<NodeId> = of(index).flat_map(|face| mesh.face_nodes::<D>(face.face)).collect();
        for face in mesh.boundary().filter(|face| !in_contact.contains(face)) {
            let nodes = mesh.face_nodes::<D>(face);
            let is_across = |node: &NodeId| (0..D).any(|c| normal[c].abs() > ROUNDING && held.contains(&(*node, c)));
            let free = problem.supported(face) == [false; D] && !loaded.contains(&face);
            let beside = free && nodes.iter().any(|node| own.contains(node));
            let faces = -dot(&mesh.normal_in::<D>(face).0, &normal) >= FACES;
            let [low, high] = range(face);
            let common = high.min(other[1]) - low.max(other[0]) > ROUNDING * (high - low);
            if let Some(node) = nodes.iter().find(|node| is_across(node)).filter(|_| beside && faces && common) {
                let edge = nodes.map(|node| node.index().to_string()).join(", ");
                let surface = problem.obstacles()[partner].group().unwrap_or_default();
                let message = format!(
                    "the edge of nodes {edge} is left out of the contact with \"{surface}\", because a support holds \
                     node {} across it: the other body may enter there; support the body away from the contact or, \
                     if both are halves of a symmetric model, support the other one at their line of symmetry, too",
                    node.index()
                );
                return Some(plausibility_warning(
                    place,
                    "edge_excluded",
                    "an edge beside a support that is left out of the contact",
                    message,
                ));
            }
        }
    }
    None
}

/// An interval without a point.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
