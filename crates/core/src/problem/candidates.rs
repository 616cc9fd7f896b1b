//! Candidates of contact: the faces that face an obstacle, and their nodes.

use super::{Cause, HeldBy, InputError};
use crate::contact::{ContactFace, ContactNode, ContactSurface, Obstacle, Plane, dot};
use crate::ids::{FaceId, NodeId};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// A face faces an obstacle if its outward unit normal · n is below this.
const FACES: f64 = -1e-9;
/// Angles (degrees) between two planes that a node may touch. Contact was tried from 30 to 150 degrees.
const OPENINGS: std::ops::RangeInclusive<f64> = 15.0..=165.0;
/// A prescribed component of which the normal has no more than this is tangential.
pub(super) const ALIGNED: f64 = 1e-12;

/// Adds an obstacle and the faces that may touch it to the contact surface.
pub(super) fn add<const D: usize>(
    surface: &mut ContactSurface<D>,
    mesh: &Mesh,
    (obstacle, plane, turning): (Obstacle<D>, &Plane<D>, bool),
    held: impl Fn(FaceId) -> Option<HeldBy>,
    prescribed: impl Fn(NodeId) -> [bool; D],
    area: impl Fn(FaceId) -> f64,
) -> Result<(), InputError> {
    let index = surface.obstacles().len();
    let facing =
        facing(mesh, &obstacle, held, turning).map_err(|(cause, key)| cause.at("obstacle", Some(index), key))?;
    if let Some(other) = surface.faces().iter().find(|other| facing.contains(&other.face)) {
        let nodes = mesh.face_nodes::<D>(other.face).map(NodeId::index).to_vec();
        return Err(Cause::TwoPlanes { nodes, first: other.obstacle + 1 }.at("obstacle", Some(index), "group"));
    }
    // Of a node with two slots the first one.
    let mut known: BTreeMap<NodeId, usize> = BTreeMap::new();
    for (at, contact) in surface.nodes().iter().enumerate() {
        known.entry(contact.node).or_insert(at);
    }
    let mut nodes: Vec<(ContactNode, [f64; D])> = Vec::new();
    for node in along_the_boundary(mesh, &facing) {
        let second_slot = known.get(&node).copied();
        let (point, held) = (mesh.points_in::<D>()[node.index()], prescribed(node));
        let frame = obstacle.frame_at(&point);
        let free = (0..D).all(|c| !held[c] || frame.normal()[c].abs() <= ALIGNED);
        let guided = free && held != [false; D];
        let undeformed_gap = plane.gap(&point);
        if let Some(other) = second_slot {
            corner(surface, other, (&obstacle, index), free)?;
        }
        let contact = ContactNode { node, obstacle: index, undeformed_gap, free, guided, partner: None, second_slot };
        nodes.push((contact, point));
    }
    if let Some((first, _)) = nodes.first().filter(|_| nodes.iter().all(|(contact, _)| !contact.free)) {
        return Err(Cause::HeldNodes { node: first.node.index() }.at("obstacle", Some(index), ""));
    }
    let position: BTreeMap<NodeId, usize> = nodes.iter().enumerate().map(|(at, (c, _))| (c.node, at)).collect();
    let face = |face: FaceId| {
        let nodes = mesh.face_nodes::<D>(face).map(|node| position[&node]);
        ContactFace { face, nodes, area: area(face), obstacle: index }
    };
    surface.add(obstacle, nodes, facing.into_iter().map(face));
    Ok(())
}

/// Refuses a node at two planes, of which the first has it at this position of the surface, without a solution, or at
/// angles that were not tried, and one at three planes.
fn corner<const D: usize>(
    surface: &ContactSurface<D>,
    at: usize,
    (obstacle, index): (&Obstacle<D>, usize),
    free: bool,
) -> Result<(), InputError> {
    let other = &surface.nodes()[at];
    let (node, first) = (other.node.index(), other.obstacle + 1);
    if let Some(second) = other.second_slot {
        let others = [first, surface.nodes()[second].obstacle + 1];
        return Err(Cause::ThreePlanes { node, others }.at("obstacle", Some(index), "group"));
    }
    if !(free && other.free) {
        return Ok(());
    }
    let both = [&surface.obstacles()[other.obstacle], obstacle];
    let [one, two] = both.map(Obstacle::flat_frame);
    let opening = (-dot(one.normal(), two.normal())).clamp(-1.0, 1.0).acos();
    if !OPENINGS.contains(&opening.to_degrees()) {
        let cause = Cause::Opening { node, first, opening: opening.to_degrees() };
        return Err(cause.at("obstacle", Some(index), "normal"));
    }
    let angles = both.map(|obstacle| obstacle.law().friction().atan());
    if angles[0] + angles[1] >= opening {
        let limit = (opening > angles[0]).then(|| (opening - angles[0]).tan());
        let (opening, angles) = (opening.to_degrees(), angles.map(f64::to_degrees));
        return Err(Cause::Jams { node, first, opening, angles, limit }.at("obstacle", Some(index), "friction"));
    }
    Ok(())
}

/// Free faces that face an obstacle, of its group if it names one; all of a body that may turn. The error has the key
/// of the statement.
fn facing<const D: usize>(
    mesh: &Mesh,
    obstacle: &Obstacle<D>,
    held: impl Fn(FaceId) -> Option<HeldBy>,
    turning: bool,
) -> Result<Vec<FaceId>, (Cause, &'static str)> {
    let nodes = |face: FaceId| mesh.face_nodes::<D>(face).map(NodeId::index).to_vec();
    let inclination = |face: FaceId| dot(&mesh.normal_in::<D>(face).0, &normal_at(mesh, obstacle, face));
    let faces = |&face: &FaceId| turning || inclination(face) < FACES;
    let mut found: Vec<FaceId>;
    if let Some(name) = obstacle.group() {
        let group = super::boundary::face_group(mesh, name).map_err(|cause| (cause, "group"))?;
        if let Some((face, by)) = group.iter().find_map(|&face| Some((face, held(face)?))) {
            return Err((Cause::NotFree { nodes: nodes(face), by }, "group"));
        }
        found = group.iter().copied().filter(faces).collect();
        if found.is_empty() {
            return Err((nothing_faces(mesh, obstacle, name, group), "group"));
        }
    } else {
        found = mesh.boundary().filter(faces).collect();
        // A closed boundary has faces in all directions: some always face the obstacle.
        let first = found.first().and_then(|&face| Some((face, held(face)?)));
        found.retain(|&face| held(face).is_none());
        if let (Some((face, by)), true) = (first, found.is_empty()) {
            return Err((Cause::AllHeld { nodes: nodes(face), by }, ""));
        }
    }
    Ok(found)
}

/// The normal of a group that does not face the obstacle, and the groups that do face it.
fn nothing_faces<const D: usize>(mesh: &Mesh, obstacle: &Obstacle<D>, name: &str, group: &[FaceId]) -> Cause {
    let mean = |faces: &[FaceId]| {
        let mut sum = [0.0; D];
        for &face in faces {
            let (normal, area) = mesh.normal_in::<D>(face);
            (0..D).for_each(|c| sum[c] += area * normal[c]);
        }
        let length = dot(&sum, &sum).sqrt();
        // A few digits are enough to be shown.
        sum.map(|s| if length > 0.0 { (1e3 * s / length).round() / 1e3 } else { 0.0 })
    };
    let (outward, normal) = (mean(group), normal_at(mesh, obstacle, group[0]));
    let looks = |faces: &[FaceId]| dot(&mean(faces), &normal) < FACES;
    let facing = mesh.face_groups().iter().filter(|(_, faces)| looks(faces)).map(|(name, _)| name.clone()).collect();
    let normal = normal.map(|n| (1e3 * n).round() / 1e3);
    Cause::NothingFaces { group: name.to_string(), outward: Box::new(outward), normal: Box::new(normal), facing }
}

/// Normal of an obstacle at the centroid of a face.
fn normal_at<const D: usize>(mesh: &Mesh, obstacle: &Obstacle<D>, face: FaceId) -> [f64; D] {
    let points = mesh.face_nodes::<D>(face).map(|node| mesh.points_in::<D>()[node.index()]);
    let centroid = std::array::from_fn(|c| points.iter().map(|p| p[c]).sum::<f64>() / D as f64);
    *obstacle.frame_at(&centroid).normal()
}

/// Nodes of the faces, piece by piece. In 2D a piece is a chain from one end to the other; a closed curve begins at its
/// lowest node.
pub(super) fn along_the_boundary(mesh: &Mesh, faces: &[FaceId]) -> Vec<NodeId> {
    let mut neighbours: BTreeMap<NodeId, Vec<NodeId>> = BTreeMap::new();
    for face in faces {
        let nodes = mesh.face(*face).nodes;
        for node in nodes {
            neighbours.entry(*node).or_default().extend(nodes.iter().filter(|n| *n != node));
        }
    }
    let mut ordered: Vec<NodeId> = Vec::with_capacity(neighbours.len());
    let mut starts: Vec<NodeId> = neighbours.keys().copied().collect();
    starts.sort_by_key(|node| neighbours[node].len() > 1);
    for start in starts {
        let mut next = neighbours.contains_key(&start).then_some(start);
        while let Some(node) = next {
            let around = neighbours.remove(&node).unwrap_or_default();
            ordered.push(node);
            next = around.into_iter().find(|n| neighbours.contains_key(n));
        }
    }
    ordered
}
