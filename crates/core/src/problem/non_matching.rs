//! Two surfaces of different bodies that may slide along each other.

use super::gaps::Gaps;
use super::roles::Roles;
use super::sides::{Bodies, InterfaceSide, check_nodes};
use super::symmetry::{LineMotion, ONE_PLACE};
use super::{Cause, candidates};
use crate::contact::{
    ContactFace, ContactNode, ContactSurface, Interface, NonMatchingSurfaces, Obstacle, Side as Line, dot, tangent,
};
use crate::ids::{FaceId, NodeId};

/// The cosine of 10°: an edge with a larger slope does not stand across a line of symmetry.
const RIDGE: f64 = 0.984_807_753_012_208;
/// Velocities that differ by less than this part of the largest are one.
const ONE_SPEED: f64 = 1e-9;

/// Faces of a body in ascending order of ξ, each with its nodes and their ξ (m).
type Chain = Vec<(FaceId, [(f64, NodeId); 2])>;

/// Adds an interface to the contact surface, as two obstacles: for the first group the surface of the second one, and
/// the other way round.
pub(super) fn add<const D: usize>(
    surface: &mut ContactSurface<D>,
    bodies: &Bodies<'_, D>,
    interface: &Interface,
    displacement: &[[f64; D]],
) -> Result<(), Cause> {
    let sides = bodies.sides(interface)?;
    check_nodes(surface, &sides, interface)?;
    let roles = bodies.roles(&sides, displacement);
    let with = |roles: Roles| -> Result<ContactSurface<D>, Cause> {
        let mut surface = surface.clone();
        bodies.add_surfaces(&mut surface, interface, &sides, roles)?;
        Ok(surface)
    };
    let first = with(roles)?;
    // A body that is beside a face and partly behind it does not meet this face: a corner of it may meet the other one.
    let several = sides[roles.slave].bodies.len() > 1;
    let reversed = Roles { slave: if several { roles.slave } else { roles.face }, face: 1 - roles.face };
    *surface = match starts_behind(&first, bodies, displacement).then(|| with(reversed)) {
        Some(Ok(other)) if !starts_behind(&other, bodies, displacement) => other,
        _ => first,
    };
    Ok(())
}

/// Whether the surfaces that were added last do not face each other and one starts behind the other one.
fn starts_behind<const D: usize>(
    surface: &ContactSurface<D>,
    bodies: &Bodies<'_, D>,
    displacement: &[[f64; D]],
) -> bool {
    let behind =
        surface.non_matching().last().and_then(|non_matching| Gaps { surface, non_matching, displacement }.behind());
    behind.is_some_and(|(depth, _)| depth > ONE_PLACE * bodies.mesh.size())
}

impl<const D: usize> Bodies<'_, D> {
    /// Adds both sides to the contact surface.
    fn add_surfaces(
        &self,
        surface: &mut ContactSurface<D>,
        interface: &Interface,
        sides: &[InterfaceSide<D>; 2],
        roles: Roles,
    ) -> Result<(), Cause> {
        let (slave, normal) = (roles.slave, self.normal(sides, roles));
        self.check_directions([&sides[slave], &sides[1 - slave]], &normal)?;
        self.check_ridge(sides, &normal)?;
        // All coordinates are from a place on the interface, so that a distant origin leaves no rounding in them.
        let origin = self.mesh.points_in::<D>()[sides[slave].nodes[0].index()];
        let mut lines = Vec::new();
        for (k, side) in sides.iter().enumerate() {
            let frame = if k == slave { normal } else { normal.map(|n| -n) };
            let group = interface.groups()[k].to_string();
            let facing = Obstacle::surface(frame, interface.law(), group, Some(surface.non_matching().len()));
            lines.push(self.add_side(surface, side, (&normal, &origin), facing)?);
        }
        let [Some(first), Some(second)] = [lines.pop(), lines.pop()] else { return Ok(()) };
        let ordered = if slave == 1 { [first, second] } else { [second, first] };
        let tolerance = ONE_PLACE * self.mesh.size();
        surface.add_non_matching(NonMatchingSurfaces::new(ordered, normal, interface.law(), tolerance));
        Ok(())
    }

    /// On a line of symmetry one of the surfaces at least stands across it: a force along the line is not normal to
    /// two slopes.
    fn check_ridge(&self, sides: &[InterfaceSide<D>; 2], normal: &[f64; D]) -> Result<(), Cause> {
        for line in self.common_lines(sides) {
            let slopes = |&&face: &&FaceId| {
                let meets_line = self.mesh.face_nodes::<D>(face).iter().any(|node| self.is_on(&line, *node));
                meets_line && dot(&self.mesh.normal_in::<D>(face).0, normal).abs() < RIDGE
            };
            if let [Some(first), Some(second)] = sides.each_ref().map(|side| side.faces.iter().find(slopes)) {
                let edges = [first, second].map(|face| self.mesh.face_nodes::<D>(*face));
                let edges = edges.map(|nodes| nodes.map(NodeId::index).to_vec());
                return Err(Cause::TwoSlopes { edges: Box::new(edges) });
            }
        }
        Ok(())
    }

    /// Adds one side to the contact surface.
    fn add_side(
        &self,
        surface: &mut ContactSurface<D>,
        side: &InterfaceSide<D>,
        (normal, origin): (&[f64; D], &[f64; D]),
        facing: Obstacle<D>,
    ) -> Result<Line, Cause> {
        let points = self.mesh.points_in::<D>();
        let from_origin = |node: NodeId| -> [f64; D] { std::array::from_fn(|c| points[node.index()][c] - origin[c]) };
        let along = tangent(normal);
        let chains = self.chains(side, |node| dot(&from_origin(node), &along))?;
        let (start, obstacle) = (surface.nodes().len(), surface.obstacles().len());
        let (mut nodes, mut xi, mut edges, mut faces) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut compliance = Vec::new();
        let mut starts = Vec::with_capacity(chains.len());
        for chain in chains {
            starts.push(nodes.len());
            for (face, ends) in chain {
                if nodes.last() != Some(&ends[0].1) {
                    nodes.push(ends[0].1);
                    xi.push(ends[0].0);
                }
                let first = nodes.len() - 1;
                nodes.push(ends[1].1);
                xi.push(ends[1].0);
                edges.push(first);
                compliance.push(1.0 / self.stiffness(face));
                let nodes = self.mesh.face_nodes::<D>(face).map(|node| first + usize::from(node == ends[1].1));
                faces.push(ContactFace { face, nodes, area: self.area(face), obstacle });
            }
        }
        let contact = |&node: &NodeId| {
            let held = self.fixed[node.index()];
            if (0..D).any(|c| held[c] && normal[c].abs() > candidates::ALIGNED) {
                return Err(Cause::HeldAcross { node: node.index() });
            }
            let (guided, undeformed_gap) = (held != [false; D], f64::INFINITY);
            let contact =
                ContactNode { node, obstacle, undeformed_gap, free: true, guided, partner: None, second_slot: None };
            Ok((contact, points[node.index()]))
        };
        let contacts = nodes.iter().map(contact).collect::<Result<Vec<_>, Cause>>()?;
        let eta = nodes.iter().map(|&node| dot(&from_origin(node), normal)).collect();
        let velocity: Vec<[f64; D]> = nodes.iter().map(|node| self.velocity[node.index()]).collect();
        let uniform = |line: &Option<LineMotion>| matches!(line, Some(LineMotion::Uniform(_)));
        let steady: Vec<bool> = nodes.iter().map(|node| self.lines[node.index()].iter().any(uniform)).collect();
        let fastest = velocity.iter().fold(0.0_f64, |most, v| most.max(dot(v, v).sqrt()));
        let velocity: Vec<f64> = velocity.iter().map(|velocity| dot(velocity, &along)).collect();
        surface.add(facing, contacts, faces);
        let line = Line::new(start, [xi, eta], edges, &starts).held(&velocity, &steady, ONE_SPEED * fastest);
        Ok(line.with_compliance(compliance))
    }

    /// The faces of each body of a side, of bodies in ascending order of their first ξ.
    fn chains(&self, side: &InterfaceSide<D>, xi: impl Fn(NodeId) -> f64) -> Result<Vec<Chain>, Cause> {
        let of_body = side.faces.chunk_by(|&a, &b| self.body_of(a) == self.body_of(b));
        let mut chains = of_body.map(|faces| self.chain(faces, &xi)).collect::<Result<Vec<_>, Cause>>()?;
        chains.sort_by(|a, b| a[0].1[0].0.total_cmp(&b[0].1[0].0));
        Ok(chains)
    }

    /// Faces of a body along the interface, of which none covers another one.
    fn chain(&self, faces: &[FaceId], xi: impl Fn(NodeId) -> f64) -> Result<Chain, Cause> {
        let ends = |&face: &FaceId| {
            let nodes = &self.mesh.face_nodes::<D>(face);
            let mut ends = [nodes[0], nodes[D - 1]].map(|node| (xi(node), node));
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            (face, ends)
        };
        let mut chain: Chain = faces.iter().map(ends).collect();
        chain.sort_by(|a, b| a.1[0].0.total_cmp(&b.1[0].0));
        for pair in chain.windows(2) {
            let [low, high] = [pair[1].1[0].0, pair[0].1[1].0];
            if low < high - 1e-9 * (high - pair[0].1[0].0) {
                let nodes = [0, 1].map(|k| pair[k].1.map(|(_, node)| node.index()).to_vec());
                return Err(Cause::Covered { nodes: Box::new(nodes) });
            }
        }
        Ok(chain)
    }
}
