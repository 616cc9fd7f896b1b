//! The two sides of an interface.

use super::alignment::{FACES, outward, unit};
use super::candidates::along_the_boundary;
use super::symmetry::{self, LineMotion, NodeLines, SymmetryLine};
use super::{Cause, HeldBy, boundary};
use crate::border::cut;
use crate::contact::{ContactSurface, Interface, Obstacle, dot};
use crate::ids::{ElementId, FaceId, NodeId};
use crate::material::{Elastic, Law};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// The data of a problem that interfaces need.
pub(super) struct Bodies<'m, const D: usize> {
    pub(super) mesh: &'m Mesh,
    /// For each node the first node of its body; empty without interfaces.
    pub(super) body: Vec<NodeId>,
    pub(super) held: Vec<Option<HeldBy>>,
    pub(super) fixed: Vec<[bool; D]>,
    /// Which components of each face supports hold.
    pub(super) supported: &'m [[bool; D]],
    /// The lines of symmetry on which each node is.
    pub(super) lines: Vec<NodeLines<D>>,
    /// The initial velocity of each node (m/s).
    pub(super) velocity: &'m [[f64; D]],
    /// The mass of each node (kg).
    pub(super) mass: &'m [f64],
    /// The law of the element that a face belongs to.
    pub(super) law: &'m dyn Fn(FaceId) -> &'m Elastic,
}

/// A normal with a smaller component stands across the others.
const UPRIGHT: f64 = 1e-9;

/// One side of an interface.
pub(super) struct InterfaceSide<const D: usize> {
    /// Those of one body after those of the other.
    pub(super) faces: Vec<FaceId>,
    /// Nodes along the boundary.
    pub(super) nodes: Vec<NodeId>,
    /// Σ of outward normals times areas (m² or 1).
    pub(super) outward: [f64; D],
    /// The same with the mirrored half of a symmetric model.
    pub(super) of_whole: [f64; D],
    /// The bodies that it belongs to, by their first nodes, ascending.
    pub(super) bodies: Vec<NodeId>,
}

impl<const D: usize> Bodies<'_, D> {
    /// Area of a face with section or thickness (m²).
    pub(super) fn area(&self, face: FaceId) -> f64 {
        self.mesh.normal_in::<D>(face).1 * (self.law)(face).extent()
    }

    /// ρc² of the element at a face, times its section or thickness (Pa·m in the plane).
    pub(super) fn stiffness(&self, face: FaceId) -> f64 {
        let law = (self.law)(face);
        law.wave_modulus() * law.extent()
    }

    /// Both sides of an interface, which are of different bodies with one hypothesis. Of non-matching interfaces, one
    /// side may be of several bodies.
    pub(super) fn sides(&self, interface: &Interface) -> Result<[InterfaceSide<D>; 2], Cause> {
        let [first, second] = interface.groups();
        let mut sides = [self.side(first)?, self.side(second)?];
        let lines = self.common_lines(&sides);
        sides.iter_mut().for_each(|side| side.mirror(&lines));
        if sides[0].bodies.iter().any(|body| sides[1].bodies.contains(body)) {
            return Err(Cause::SameBody { groups: interface.groups().map(str::to_string) });
        }
        let several = sides.each_ref().map(|side| side.bodies.len() > 1);
        if several == [true; 2] || (interface.is_matching() && several != [false; 2]) {
            let group = interface.groups()[usize::from(!several[0])].to_string();
            return Err(Cause::SeveralBodies { group, other: interface.groups()[usize::from(several[0])].to_string() });
        }
        let hypothesis = |face: &FaceId| (self.law)(*face).hypothesis();
        let first = hypothesis(&sides[0].faces[0]);
        let all = sides.iter().flat_map(|side| &side.faces).all(|face| hypothesis(face) == first);
        if all { Ok(sides) } else { Err(Cause::PlanesDiffer) }
    }

    /// The mean outward unit normals of two sides. Rounding of places does not tilt them across a support.
    pub(super) fn outward(&self, sides: &[InterfaceSide<D>; 2]) -> [[f64; D]; 2] {
        let fixed = |c: usize| sides.iter().flat_map(|side| &side.nodes).any(|node| self.fixed[node.index()][c]);
        let fixed: [bool; D] = std::array::from_fn(fixed);
        sides.each_ref().map(|side| {
            let mut normal = unit(&side.of_whole);
            if let Some(c) = (0..D).find(|&c| fixed[c] && normal[c] != 0.0 && normal[c].abs() <= UPRIGHT) {
                normal[c] = 0.0;
                normal = unit(&normal);
            }
            normal
        })
    }

    /// Whether all edges face the other side, with the normal from the second one to the first.
    pub(super) fn check_directions(&self, sides: [&InterfaceSide<D>; 2], normal: &[f64; D]) -> Result<(), Cause> {
        let away = normal.map(|n| -n);
        for (side, outward) in sides.into_iter().zip([&away, normal]) {
            let faces = |&face: &FaceId| dot(&self.mesh.normal_in::<D>(face).0, outward) >= FACES;
            if let Some(face) = side.faces.iter().find(|face| !faces(face)) {
                let nodes = self.mesh.face_nodes::<D>(*face).map(NodeId::index).to_vec();
                let outward = Box::new([away.to_vec(), normal.to_vec()]);
                return Err(Cause::TurnedAway { nodes, outward });
            }
        }
        Ok(())
    }

    /// The faces of a group, which are free.
    fn side(&self, group: &str) -> Result<InterfaceSide<D>, Cause> {
        let mut faces = boundary::face_group(self.mesh, group)?.to_vec();
        let nodes_of = |face: FaceId| self.mesh.face_nodes::<D>(face);
        let shown = |face: FaceId| nodes_of(face).map(NodeId::index).to_vec();
        if let Some(&face) = faces.iter().find(|&&face| self.mesh.face(face).neighbour.is_some()) {
            return Err(Cause::InnerFace { nodes: shown(face) });
        }
        if let Some((face, by)) = faces.iter().find_map(|&face| Some((face, self.held[face.index()]?))) {
            return Err(Cause::NotFree { nodes: shown(face), by });
        }
        faces.sort_by_key(|&face| self.body_of(face));
        let mut bodies: Vec<NodeId> = faces.iter().map(|&face| self.body_of(face)).collect();
        bodies.dedup();
        let nodes = along_the_boundary(self.mesh, &faces);
        let outward = cut(&outward(self.mesh, &faces));
        Ok(InterfaceSide { of_whole: outward, nodes, faces, outward, bodies })
    }

    /// The line of symmetry on which an edge is, if its way is known before the run.
    pub(super) fn line_of(&self, face: FaceId) -> Option<SymmetryLine> {
        let line = symmetry::line_of(self.mesh, &self.supported[face.index()], &self.lines, face)?;
        matches!(line.motion, LineMotion::Uniform(_)).then_some(line)
    }

    /// The lines of symmetry that both sides meet, of which the way is known before the run.
    pub(super) fn common_lines(&self, sides: &[InterfaceSide<D>; 2]) -> Vec<SymmetryLine> {
        let [own, other] = sides.each_ref().map(|side| side.nodes.as_slice());
        let mut lines: Vec<SymmetryLine> = Vec::new();
        for (node, across) in own.iter().flat_map(|&node| (0..D).map(move |c| (node, c))) {
            let Some(motion @ LineMotion::Uniform(_)) = self.lines[node.index()][across] else { continue };
            let line = SymmetryLine { across, place: self.mesh.points_in::<D>()[node.index()][across], motion };
            if other.iter().any(|node| self.is_on(&line, *node)) {
                lines.push(line);
            }
        }
        lines
    }

    /// Whether a node is on a line of symmetry.
    pub(super) fn is_on(&self, line: &SymmetryLine, node: NodeId) -> bool {
        line.has((&self.mesh.points_in::<D>()[node.index()], &self.lines[node.index()]), self.mesh.size())
    }

    /// The body of a face, by its first node.
    pub(super) fn body_of(&self, face: FaceId) -> NodeId {
        self.body[self.mesh.face_nodes::<D>(face)[0].index()]
    }
}

impl<const D: usize> InterfaceSide<D> {
    /// Adds the outward normals of the mirrored side. A line along the surface is none of a half.
    fn mirror(&mut self, lines: &[SymmetryLine]) {
        let largest = self.outward.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
        for line in lines.iter().filter(|line| self.outward[line.across].abs() < largest) {
            self.of_whole[line.across] = 0.0;
        }
    }
}

/// Whether no node may touch anything else.
pub(super) fn check_nodes<const D: usize>(
    surface: &ContactSurface<D>,
    sides: &[InterfaceSide<D>; 2],
    interface: &Interface,
) -> Result<(), Cause> {
    let nodes = sides.iter().flat_map(|side| &side.nodes);
    let Some(node) = nodes.into_iter().find(|node| surface.nodes().iter().any(|contact| contact.node == **node)) else {
        return Ok(());
    };
    let groups = interface.groups();
    let surfaces = surface.obstacles().iter().filter(|obstacle| obstacle.as_plane().is_none());
    // The two of an interface follow each other.
    let named: Vec<_> = surfaces.map(Obstacle::group).collect();
    let same = |pair: &[Option<&str>]| groups.iter().all(|group| pair.contains(&Some(*group)));
    Err(match named.chunks(2).any(same) {
        true => Cause::SameSurfaces { groups: Box::new(groups.map(str::to_string)) },
        false => Cause::TwoContacts { node: node.index() },
    })
}

/// Elements of different bodies that touch have nodes on the two sides of an interface.
pub(super) fn check_touching<const D: usize>(surface: &ContactSurface<D>, mesh: &Mesh) -> Result<(), Cause> {
    let touching = mesh.touching_elements();
    if touching.is_empty() {
        return Ok(());
    }
    let obstacle: BTreeMap<NodeId, usize> =
        surface.nodes().iter().map(|contact| (contact.node, contact.obstacle)).collect();
    // The two obstacles of an interface follow each other, after all planes.
    let planes = surface.obstacles().iter().filter(|obstacle| obstacle.as_plane().is_some()).count();
    let sides = |element: ElementId| {
        let nodes = mesh.cell(element).iter();
        nodes.filter_map(|node| obstacle.get(node)?.checked_sub(planes)).collect::<Vec<_>>()
    };
    let faces = |&[first, second]: &[ElementId; 2]| {
        let others = sides(second);
        sides(first).iter().any(|side| others.contains(&(side ^ 1)))
    };
    match touching.iter().find(|pair| !faces(pair)) {
        Some(pair) => Err(Cause::TouchUnstated { elements: pair.map(ElementId::index) }),
        None => Ok(()),
    }
}
