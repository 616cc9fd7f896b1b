//! Lines of symmetry of a model of which one half is there.

use crate::ids::FacetId;
use crate::mesh::Mesh;

/// Places nearer than this part of the size of the mesh are one.
pub(super) const ONE_PLACE: f64 = 1e-12;

/// A line of symmetry: it stands across a direction, at a coordinate (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SymmetryLine {
    pub(crate) across: usize,
    pub(crate) place: f64,
}

/// The direction across which an edge is on a line of symmetry: supports hold it in this direction alone. Bars have no
/// such line, because nothing is beside them.
pub(crate) fn across<const D: usize, const N: usize>(
    mesh: &Mesh<D, N>,
    supported: &[bool; D],
    facet: FacetId,
) -> Option<usize> {
    let mut held = (0..D).filter(|&c| supported[c]);
    let direction = held.next().filter(|_| D == 2 && held.next().is_none())?;
    mesh.stands_across(facet, direction).then_some(direction)
}

/// Each of some lines once.
pub(crate) fn distinct(lines: impl Iterator<Item = SymmetryLine>) -> Vec<SymmetryLine> {
    let mut lines: Vec<SymmetryLine> = lines.collect();
    lines.sort_by(|a, b| a.across.cmp(&b.across).then(a.place.total_cmp(&b.place)));
    lines.dedup();
    lines
}

/// The line of symmetry of which two bodies with these lines and points are halves, if there is one alone, in a mesh of
/// this size (m).
pub(crate) fn common_line<'p, const D: usize>(
    [own, other]: [&[SymmetryLine]; 2],
    points: impl Iterator<Item = &'p [f64; D]> + Clone,
    size: f64,
) -> Option<SymmetryLine> {
    let of_both =
        |line: &&SymmetryLine| other.iter().any(|other| line.is_at(other, size)) && line.bounds(points.clone(), size);
    let mut lines = own.iter().filter(of_both);
    let line = *lines.next()?;
    lines.all(|other| other.across == line.across).then_some(line)
}

impl SymmetryLine {
    /// How far a point is on its upper side (m), 0 to rounding in a mesh of this size (m).
    pub(super) fn beyond<const D: usize>(&self, point: &[f64; D], size: f64) -> f64 {
        let apart = point[self.across] - self.place;
        // A line that is far from the origin has two places that differ by its rounding.
        let rounding = ONE_PLACE * size + 4.0 * f64::EPSILON * self.place.abs();
        if apart.abs() <= rounding { 0.0 } else { apart }
    }

    /// Whether it is another one, too, in a mesh of this size (m).
    pub(crate) fn is_at(&self, other: &Self, size: f64) -> bool {
        self.across == other.across && self.beyond(&[other.place; 2], size) == 0.0
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
        let line = SymmetryLine { across: 0, place: 1000.0 };
        assert!(line.is_at(&SymmetryLine { across: 0, place: 1000.0 + 2e-13 }, 0.01));
        assert!(!line.is_at(&SymmetryLine { across: 0, place: 1000.0 + 1e-9 }, 0.01));
        assert!(!line.is_at(&SymmetryLine { across: 1, place: 1000.0 }, 0.01));
        let points = |x: [f64; 2]| x.map(|x| [1000.0 + x, 5.0]);
        assert!(line.bounds(points([0.02, -2e-13]).iter(), 0.01) && line.bounds(points([-0.02, 0.0]).iter(), 0.01));
        assert!(!line.bounds(points([-0.02, 1e-9]).iter(), 0.01));
    }
}
