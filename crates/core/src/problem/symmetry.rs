//! Lines of symmetry of a model of which one half is there.

use super::{PrescribedComponent, Problem};
use crate::contact::ContactNode;
use crate::ids::FaceId;
use crate::load::Table;
use crate::mesh::Mesh;

/// Places nearer than this part of the size of the mesh are one.
pub(super) const ONE_PLACE: f64 = 1e-12;

/// Velocities that differ by a smaller part of the larger one are one.
const ONE_VELOCITY: f64 = 1e-9;

/// How a line moves across itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LineMotion {
    /// With this velocity (m/s), which may be 0.
    Uniform(f64),
    /// As the table of supports of this number says.
    Changing(usize),
}

impl LineMotion {
    /// Whether two lines that move so stay at one place.
    fn is_that_of(self, other: Self) -> bool {
        match (self, other) {
            (Self::Uniform(a), Self::Uniform(b)) => (a - b).abs() <= ONE_VELOCITY * a.abs().max(b.abs()),
            _ => self == other,
        }
    }
}

/// A line of symmetry: it stands across a direction, at a coordinate (m) at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SymmetryLine {
    pub(crate) across: usize,
    pub(crate) place: f64,
    pub(crate) motion: LineMotion,
}

/// The motion of the line of symmetry across each direction on which a node is, if it is on one.
pub(crate) type NodeLines<const D: usize> = [Option<LineMotion>; D];

/// Those of all nodes.
pub(crate) fn node_lines<const D: usize>(
    mesh: &Mesh,
    supported: &[[bool; D]],
    prescribed: &[PrescribedComponent],
    motions: &[Table],
) -> Vec<NodeLines<D>> {
    let mirrors = mirrors(mesh, supported);
    let mut lines = vec![[None; D]; mesh.node_count()];
    for p in prescribed.iter().filter(|p| mirrors[p.node.index()][p.component]) {
        let of_table = |index: usize| match motions[index].is_constant() {
            true => LineMotion::Uniform(motions[index].value()[0][0]),
            false => LineMotion::Changing(index),
        };
        lines[p.node.index()][p.component] = Some(p.motion.map_or(LineMotion::Uniform(0.0), of_table));
    }
    lines
}

/// For each node the directions across which it is on a line of symmetry: those in which supports hold an edge that
/// stands across them.
fn mirrors<const D: usize>(mesh: &Mesh, supported: &[[bool; D]]) -> Vec<[bool; D]> {
    let mut mirrors = vec![[false; D]; mesh.node_count()];
    for (index, supported) in supported.iter().enumerate().filter(|(_, supported)| supported.contains(&true)) {
        let face = FaceId::new(index);
        for c in (0..D).filter(|&c| supported[c] && mesh.stands_across(face, c)) {
            mesh.face(face).nodes.iter().for_each(|node| mirrors[node.index()][c] = true);
        }
    }
    mirrors
}

impl<const D: usize> Problem<D> {
    /// Whether each node of the contact surface is on a line of symmetry across it: a support holds it along the
    /// surface, and an edge that stands across.
    #[must_use]
    pub fn on_lines_of_symmetry(&self) -> Vec<bool> {
        self.mirrors_at_contact().into_iter().map(|across| across.contains(&true)).collect()
    }

    /// The directions across which each node of the contact surface is on a line or plane of symmetry that stands
    /// across the surface.
    #[must_use]
    pub fn mirrors_at_contact(&self) -> Vec<[bool; D]> {
        let mirrors = mirrors(&self.mesh, &self.supported);
        let of = |contact: &ContactNode| if contact.guided { mirrors[contact.node.index()] } else { [false; D] };
        self.surface.nodes().iter().map(of).collect()
    }

    /// The lines of symmetry on which each node is.
    pub(crate) fn node_lines(&self) -> Vec<NodeLines<D>> {
        node_lines(&self.mesh, &self.supported, &self.prescribed, &self.motions)
    }
}

/// The line of symmetry on which an edge is: supports hold it across the line alone. Bars have no such line, because
/// nothing is beside them.
pub(crate) fn line_of<const D: usize>(
    mesh: &Mesh,
    supported: &[bool; D],
    lines: &[NodeLines<D>],
    face: FaceId,
) -> Option<SymmetryLine> {
    let mut held = (0..D).filter(|&c| supported[c]);
    let across = held.next().filter(|_| D == 2 && held.next().is_none())?;
    let nodes = mesh.face_nodes::<D>(face);
    let motion = lines[nodes[0].index()][across].filter(|_| mesh.stands_across(face, across))?;
    Some(SymmetryLine { across, place: mesh.points_in::<D>()[nodes[0].index()][across], motion })
}

/// Each of some lines once.
pub(crate) fn distinct(lines: impl Iterator<Item = SymmetryLine>) -> Vec<SymmetryLine> {
    let mut lines: Vec<SymmetryLine> = lines.collect();
    lines.sort_by(|a, b| a.across.cmp(&b.across).then(a.place.total_cmp(&b.place)));
    lines.dedup();
    lines
}

/// The lines of symmetry of which two bodies with these lines and points are halves, in a mesh of this size (m).
pub(crate) fn common_lines<'p, const D: usize>(
    [own, other]: [&[SymmetryLine]; 2],
    points: impl Iterator<Item = &'p [f64; D]> + Clone,
    size: f64,
) -> Vec<SymmetryLine> {
    let of_both =
        |line: &&SymmetryLine| other.iter().any(|other| line.is_at(other, size)) && line.bounds(points.clone(), size);
    own.iter().filter(of_both).copied().collect()
}

impl SymmetryLine {
    /// How far a point is on its upper side (m), 0 to rounding in a mesh of this size (m).
    pub(crate) fn beyond<const D: usize>(&self, point: &[f64; D], size: f64) -> f64 {
        let apart = point[self.across] - self.place;
        // A line that is far from the origin has two places that differ by its rounding.
        let rounding = ONE_PLACE * size + 4.0 * f64::EPSILON * self.place.abs();
        if apart.abs() <= rounding { 0.0 } else { apart }
    }

    /// Whether it is another one, too, in a mesh of this size (m).
    pub(crate) fn is_at(&self, other: &Self, size: f64) -> bool {
        self.across == other.across
            && self.motion.is_that_of(other.motion)
            && self.beyond(&[other.place; 2], size) == 0.0
    }

    /// Whether a node at a point, with these lines, is on it, in a mesh of this size (m).
    pub(super) fn has<const D: usize>(&self, (point, lines): (&[f64; D], &NodeLines<D>), size: f64) -> bool {
        lines[self.across].is_some_and(|motion| motion.is_that_of(self.motion)) && self.beyond(point, size) == 0.0
    }

    /// Whether all these points are on one side of it or on it, in a mesh of this size (m).
    fn bounds<'p, const D: usize>(&self, points: impl Iterator<Item = &'p [f64; D]> + Clone, size: f64) -> bool {
        let mut sides = [-1.0, 1.0].into_iter();
        sides.any(|side| points.clone().all(|point| side * self.beyond(point, size) >= 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::{LineMotion, SymmetryLine};

    #[test]
    fn lines_move_together_or_apart() {
        let line = |motion: LineMotion| SymmetryLine { across: 0, place: 0.0, motion };
        let together = |one: LineMotion, other: LineMotion| line(one).is_at(&line(other), 0.01);
        assert!(together(LineMotion::Uniform(0.3), LineMotion::Uniform(0.1 + 0.2)));
        assert!(!together(LineMotion::Uniform(0.3), LineMotion::Uniform(0.0)));
        assert!(together(LineMotion::Changing(1), LineMotion::Changing(1)));
        assert!(!together(LineMotion::Changing(1), LineMotion::Changing(0)));
        assert!(!together(LineMotion::Changing(0), LineMotion::Uniform(0.0)));
    }

    #[test]
    fn a_line_is_found_beside_rounding() {
        let line = SymmetryLine { across: 0, place: 1000.0, motion: LineMotion::Uniform(3.0) };
        assert!(line.is_at(&SymmetryLine { place: 1000.0 + 2e-13, ..line }, 0.01));
        assert!(!line.is_at(&SymmetryLine { place: 1000.0 + 1e-9, ..line }, 0.01));
        assert!(!line.is_at(&SymmetryLine { across: 1, ..line }, 0.01));
        let points = |x: [f64; 2]| x.map(|x| [1000.0 + x, 5.0]);
        assert!(line.bounds(points([0.02, -2e-13]).iter(), 0.01) && line.bounds(points([-0.02, 0.0]).iter(), 0.01));
        assert!(!line.bounds(points([-0.02, 1e-9]).iter(), 0.01));
    }
}
