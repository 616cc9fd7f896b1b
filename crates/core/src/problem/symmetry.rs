//! Lines of symmetry of a model of which one half is there.

use super::{PrescribedComponent, boundary};
use crate::ids::FacetId;
use crate::load::Table;
use crate::mesh::Mesh;

/// Places nearer than this part of the size of the mesh are one.
pub(super) const ONE_PLACE: f64 = 1e-12;

/// A line of symmetry: it stands across a direction, at a coordinate (m), and moves with a velocity (m/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SymmetryLine {
    pub(crate) across: usize,
    pub(crate) place: f64,
    pub(crate) velocity: f64,
}

/// For each node and each direction, the velocity of the line of symmetry across it on which the node is (m/s); none if
/// it is on no such line, or if the velocity changes.
pub(crate) fn velocities<const D: usize, const N: usize>(
    mesh: &Mesh<D, N>,
    supported: &[[bool; D]],
    prescribed: &[PrescribedComponent],
    motions: &[Table<1>],
) -> Vec<[Option<f64>; D]> {
    let mirrors = boundary::mirrors(mesh, supported);
    let mut velocities = vec![[None; D]; mesh.node_count()];
    for p in prescribed.iter().filter(|p| mirrors[p.node.index()][p.component]) {
        let uniform = |motion: usize| motions[motion].is_constant().then(|| motions[motion].value()[0][0]);
        velocities[p.node.index()][p.component] = p.motion.map_or(Some(0.0), uniform);
    }
    velocities
}

/// The line of symmetry on which an edge is: supports hold it across the line alone. Bars have no such line, because
/// nothing is beside them.
pub(crate) fn line_of<const D: usize, const N: usize>(
    mesh: &Mesh<D, N>,
    supported: &[bool; D],
    velocities: &[[Option<f64>; D]],
    facet: FacetId,
) -> Option<SymmetryLine> {
    let mut held = (0..D).filter(|&c| supported[c]);
    let across = held.next().filter(|_| D == 2 && held.next().is_none())?;
    let nodes = mesh.facets()[facet.index()].nodes;
    let velocity = velocities[nodes[0].index()][across].filter(|_| mesh.stands_across(facet, across))?;
    Some(SymmetryLine { across, place: mesh.points()[nodes[0].index()][across], velocity })
}

/// Each of some lines once.
pub(crate) fn distinct(lines: impl Iterator<Item = SymmetryLine>) -> Vec<SymmetryLine> {
    let mut lines: Vec<SymmetryLine> = lines.collect();
    lines.sort_by(|a, b| {
        a.across.cmp(&b.across).then(a.place.total_cmp(&b.place)).then(a.velocity.total_cmp(&b.velocity))
    });
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
        self.across == other.across && self.velocity == other.velocity && self.beyond(&[other.place; 2], size) == 0.0
    }

    /// Whether all these points are on one side of it or on it, in a mesh of this size (m).
    fn bounds<'p, const D: usize>(&self, points: impl Iterator<Item = &'p [f64; D]> + Clone, size: f64) -> bool {
        let mut sides = [-1.0, 1.0].into_iter();
        sides.any(|side| points.clone().all(|point| side * self.beyond(point, size) >= 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::SymmetryLine;

    #[test]
    fn a_line_is_found_beside_rounding() {
        let line = SymmetryLine { across: 0, place: 1000.0, velocity: 3.0 };
        assert!(line.is_at(&SymmetryLine { place: 1000.0 + 2e-13, ..line }, 0.01));
        assert!(!line.is_at(&SymmetryLine { place: 1000.0 + 1e-9, ..line }, 0.01));
        assert!(!line.is_at(&SymmetryLine { across: 1, ..line }, 0.01));
        assert!(!line.is_at(&SymmetryLine { velocity: 0.0, ..line }, 0.01));
        let points = |x: [f64; 2]| x.map(|x| [1000.0 + x, 5.0]);
        assert!(line.bounds(points([0.02, -2e-13]).iter(), 0.01) && line.bounds(points([-0.02, 0.0]).iter(), 0.01));
        assert!(!line.bounds(points([-0.02, 1e-9]).iter(), 0.01));
    }
}
