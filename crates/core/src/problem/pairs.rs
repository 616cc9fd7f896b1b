//! Pairs of nodes of two bodies that face each other across an interface.

use super::Cause;
use super::sides::{Bodies, InterfaceSide, check_nodes};
use crate::contact::{ContactFace, ContactNode, ContactSurface, Frame, Interface, Obstacle, dot};
use crate::ids::{FaceId, NodeId};
use std::collections::BTreeMap;

/// Nodes of a pair differ by less than this part of the shortest edge, but for a gap along the normal.
const MATCHING: f64 = 1e-9;
/// The two sides of an interface, the common normal from the second one to the first, and the node of the second side
/// that faces each node of the first one.
type OpposedSides<const D: usize> = ([InterfaceSide<D>; 2], [f64; D], Vec<NodeId>);

/// Adds the pairs of an interface to the contact surface, as two obstacles: for the first group the surface of the
/// second one, and the other way round.
pub(super) fn add<const D: usize>(
    surface: &mut ContactSurface<D>,
    bodies: &Bodies<'_, D>,
    interface: &Interface,
) -> Result<(), Cause> {
    let (sides, normal, partners) = bodies.facing(surface, interface)?;
    let away = normal.map(|n| -n);
    let ordered = [sides[0].nodes.clone(), partners];
    let start = surface.nodes().len();
    let points = bodies.mesh.points_in::<D>();
    for (k, (nodes, side)) in ordered.iter().zip(&sides).enumerate() {
        let obstacle = surface.obstacles().len();
        let frame = if k == 0 { normal } else { away };
        let contact = |(at, node): (usize, &NodeId)| {
            let facing = ordered[1 - k][at];
            let apart: [f64; D] = std::array::from_fn(|c| points[node.index()][c] - points[facing.index()][c]);
            let guided = bodies.guided(&frame, [*node, facing])?;
            let partner = Some(start + if k == 0 { ordered[0].len() + at } else { at });
            let undeformed_gap = dot(&apart, &frame);
            let contact =
                ContactNode { node: *node, obstacle, undeformed_gap, free: true, guided, partner, second_slot: None };
            Ok((contact, points[node.index()]))
        };
        let contacts = nodes.iter().enumerate().map(contact).collect::<Result<Vec<_>, Cause>>()?;
        let position: BTreeMap<NodeId, usize> = nodes.iter().enumerate().map(|(at, &node)| (node, at)).collect();
        let faces = side.faces.iter().map(|&face| {
            let nodes = bodies.mesh.face_nodes::<D>(face).map(|node| position[&node]);
            ContactFace { face, nodes, area: bodies.area(face), obstacle }
        });
        let facing = Obstacle::surface(frame, interface.law(), interface.groups()[k].to_string(), None);
        surface.add(facing, contacts, faces);
    }
    Ok(())
}

impl<const D: usize> Bodies<'_, D> {
    /// Both sides of an interface, which face each other in pairs.
    fn facing(&self, surface: &ContactSurface<D>, interface: &Interface) -> Result<OpposedSides<D>, Cause> {
        let sides = self.sides(interface)?;
        let outward = self.outward(&sides);
        // The surface of either body may be the one that the normal stands on.
        let mut normal = outward[0].map(|n| -n);
        let mut partners = self.partners(&sides, &normal);
        if partners.is_err()
            && let Ok(found) = self.partners(&sides, &outward[1])
        {
            (normal, partners) = (outward[1], Ok(found));
        }
        self.check_directions([&sides[0], &sides[1]], &normal)?;
        let partners = partners?;
        check_nodes(surface, &sides, interface)?;
        Ok((sides, normal, partners))
    }

    /// The node of the second side that faces each node of the first one.
    fn partners(&self, [first, second]: &[InterfaceSide<D>; 2], normal: &[f64; D]) -> Result<Vec<NodeId>, Cause> {
        let points = self.mesh.points_in::<D>();
        let counts = [first.nodes.len(), second.nodes.len()];
        if counts[0] != counts[1] {
            return Err(Cause::NotMatching { counts, node: first.nodes[0].index(), offset: 0.0 });
        }
        let shortest = first.faces.iter().map(|&face| self.mesh.normal_in::<D>(face).1).fold(f64::INFINITY, f64::min);
        let frame = Frame::new(*normal);
        let offset = |a: NodeId, b: NodeId| {
            let apart = std::array::from_fn(|c| points[a.index()][c] - points[b.index()][c]);
            let (_, aside) = frame.split(&apart);
            dot(&aside, &aside).sqrt()
        };
        let partner = |&node: &NodeId| {
            let facing = second.nodes.iter().map(|&other| (offset(node, other), other));
            let (offset, facing) = facing.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, node));
            let matches = offset <= MATCHING * shortest;
            if matches { Ok(facing) } else { Err(Cause::NotMatching { counts, node: node.index(), offset }) }
        };
        let partners = first.nodes.iter().map(partner).collect::<Result<Vec<_>, _>>()?;
        let of: BTreeMap<NodeId, NodeId> = first.nodes.iter().copied().zip(partners.iter().copied()).collect();
        let edges = |faces: &[FaceId], image: &dyn Fn(NodeId) -> NodeId| -> BTreeMap<Vec<NodeId>, FaceId> {
            let sorted = |face: &FaceId| {
                let mut nodes = self.mesh.face_nodes::<D>(*face).map(image).to_vec();
                nodes.sort_unstable();
                (nodes, *face)
            };
            faces.iter().map(sorted).collect()
        };
        let (ours, theirs) = (edges(&first.faces, &|node| of[&node]), edges(&second.faces, &|node| node));
        let alone = ours.iter().find(|(nodes, _)| !theirs.contains_key(*nodes));
        match alone.or_else(|| theirs.iter().find(|(nodes, _)| !ours.contains_key(*nodes))) {
            Some((_, face)) => {
                Err(Cause::EdgesDiffer { nodes: self.mesh.face_nodes::<D>(*face).map(NodeId::index).to_vec() })
            }
            None => Ok(partners),
        }
    }

    /// Whether the tangential motion of a pair is prescribed; across the interface both nodes are free.
    fn guided(&self, normal: &[f64; D], pair: [NodeId; 2]) -> Result<bool, Cause> {
        let held = pair.map(|node| self.fixed[node.index()]);
        let across = (0..D).any(|c| held.iter().any(|held| held[c]) && normal[c].abs() > super::candidates::ALIGNED);
        let node = pair[usize::from(held[0] == [false; D])].index();
        if across || held[0] != held[1] {
            return Err(Cause::HeldPair { node });
        }
        Ok(held[0] != [false; D])
    }
}
