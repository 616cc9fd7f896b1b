//! Points in a mesh: the elements that contain one, and the nearest point of the outline; angles at nodes.

use super::Mesh;
use crate::ids::{ElementId, FacetId, NodeId};
use std::f64::consts::PI;

/// A point counts as one of an element, an edge or a node within this part of the size of the mesh: rounding of
/// coordinates.
const ROUNDING: f64 = 1e-9;

/// An element that contains a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around<const N: usize> {
    /// The element.
    pub element: ElementId,
    /// The shape functions of its nodes at the point.
    pub shapes: [f64; N],
    /// Its share of a small circle around the point, as far as this is in the body: 1 if the point is inside the
    /// element. In a bar elements have equal shares.
    pub share: f64,
}

impl<const D: usize, const N: usize> Mesh<D, N> {
    /// The elements that contain a point (m), ascending; several if it is on an edge or a node between them. None if it
    /// is outside the body. The shares add up to 1. They do not depend on the mesh, where the same elements, edges or
    /// nodes of a coarser mesh are cut into smaller ones.
    #[must_use]
    pub fn around(&self, point: &[f64; D]) -> Vec<Around<N>> {
        let tolerance = ROUNDING * self.size();
        let mut found: Vec<_> = (0..self.element_count())
            .map(ElementId::new)
            .filter(|&element| !self.is_beside(element, point, tolerance))
            .filter_map(|element| self.around_in(element, point, tolerance))
            .collect();
        let all: f64 = found.iter().map(|around| around.share).sum();
        found.iter_mut().for_each(|around| around.share /= all);
        found
    }

    /// That of an element, with its angle around the point for a share.
    fn around_in(&self, element: ElementId, point: &[f64; D], tolerance: f64) -> Option<Around<N>> {
        let (corners, gradients) = (self.cell_points(element), self.cell_geometry(element).gradients);
        let shapes: [f64; N] =
            std::array::from_fn(|k| 1.0 + (0..D).map(|c| gradients[k][c] * (point[c] - corners[k][c])).sum::<f64>());
        let distance = |k: usize| shapes[k] / gradients[k].iter().map(|g| g * g).sum::<f64>().sqrt();
        if (0..N).any(|k| distance(k) < -tolerance) {
            return None;
        }
        let off: Vec<usize> = (0..N).filter(|&k| distance(k) > tolerance).collect();
        let share = match off[..] {
            _ if D == 1 => 1.0,
            [node] => self.angle(element, self.cells()[element.index()][node]),
            _ if off.len() < N => PI,
            _ => 2.0 * PI,
        };
        Some(Around { element, shapes, share })
    }

    /// Whether a point is farther than this (m) from the smallest box around an element.
    pub(super) fn is_beside(&self, element: ElementId, point: &[f64; D], tolerance: f64) -> bool {
        let corners = self.cell_points(element);
        (0..D).any(|c| {
            let [low, high] = [f64::min, f64::max].map(|pick| corners.iter().map(|p| p[c]).reduce(pick));
            low.is_some_and(|low| point[c] < low - tolerance) || high.is_some_and(|high| point[c] > high + tolerance)
        })
    }

    /// The point of the outline that is nearest to a point, and the distance (m).
    #[must_use]
    pub fn nearest_of_outline(&self, point: &[f64; D]) -> ([f64; D], f64) {
        let feet = self.boundary().map(|facet| foot(point, &self.ends(facet)));
        feet.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((*point, f64::INFINITY))
    }

    /// The angle of a triangle at one of its nodes (rad); 0 for other elements.
    #[must_use]
    pub fn angle(&self, element: ElementId, node: NodeId) -> f64 {
        let Some(k) = self.local_node(element, node).filter(|_| D == 2 && N == 3) else { return 0.0 };
        let points = self.cell_points(element);
        let side = |to: usize| -> [f64; D] { std::array::from_fn(|c| points[to % N][c] - points[k][c]) };
        let (a, b) = (side(k + 1), side(k + 2));
        (a[0] * b[1 % D] - a[1 % D] * b[0]).abs().atan2((0..D).map(|c| a[c] * b[c]).sum())
    }

    /// The angle inside the body between the two edges of its outline at a node (rad); none at a node inside the body.
    #[must_use]
    pub fn angle_of_outline(&self, node: NodeId) -> Option<f64> {
        let star = self.stars().star(node);
        (!star.is_closed()).then(|| star.elements.iter().map(|&element| self.angle(element, node)).sum())
    }

    /// The nodes of the outline of a plane body with an angle inside the body above this (rad).
    #[must_use]
    pub fn corners_above(&self, angle: f64) -> Vec<NodeId> {
        let nodes = (0..self.node_count()).map(NodeId::new);
        nodes.filter(|&node| self.angle_of_outline(node).is_some_and(|inside| inside > angle)).collect()
    }

    pub(super) fn ends(&self, facet: FacetId) -> [[f64; D]; D] {
        self.facets()[facet.index()].nodes.map(|node| self.points()[node.index()])
    }
}

/// The nearest point of a facet (a point, or a line between two), and its distance (m).
pub(super) fn foot<const D: usize>(point: &[f64; D], ends: &[[f64; D]; D]) -> ([f64; D], f64) {
    let from = |end: &[f64; D]| -> [f64; D] { std::array::from_fn(|c| point[c] - end[c]) };
    let dot = |a: &[f64; D], b: &[f64; D]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
    let (start, last) = (from(&ends[0]), &ends[D - 1]);
    let along: [f64; D] = std::array::from_fn(|c| last[c] - ends[0][c]);
    let length = dot(&along, &along);
    let at = if length > 0.0 { (dot(&start, &along) / length).clamp(0.0, 1.0) } else { 0.0 };
    let rest: [f64; D] = std::array::from_fn(|c| start[c] - at * along[c]);
    (std::array::from_fn(|c| point[c] - rest[c]), dot(&rest, &rest).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{BarMesh, TriangleMesh};
    use std::collections::BTreeMap;

    fn shares<const D: usize, const N: usize>(mesh: &Mesh<D, N>, point: [f64; D]) -> Vec<f64> {
        mesh.around(&point).iter().map(|around| around.share).collect()
    }

    /// Right angles: a node inside, on an edge of the outline and at a corner, an edge, and the inside of an element.
    #[test]
    fn elements_share_a_point_by_their_angles() {
        let mesh = TriangleMesh::rectangle(2.0, 2.0, 2, 2).unwrap();
        let close = |found: Vec<f64>, known: &[f64]| {
            let mut found = found;
            found.sort_by(f64::total_cmp);
            found.len() == known.len() && found.iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(close(shares(&mesh, [1.0, 1.0]), &[0.125, 0.125, 0.125, 0.125, 0.25, 0.25]));
        assert!(close(shares(&mesh, [0.5, 1.0]), &[0.5, 0.5]));
        assert!(close(shares(&mesh, [1.3, 1.1]), &[1.0]));
        assert!(close(shares(&mesh, [0.5, 0.0]), &[1.0]));
        assert!(shares(&mesh, [2.1, 1.0]).is_empty());
        // Rounding of coordinates does not put a point outside.
        assert!(close(shares(&mesh, [0.5, -1e-13]), &[1.0]));
        let bar = BarMesh::uniform_bar(1.0, 4).unwrap();
        assert!(close(shares(&bar, [0.5]), &[0.5, 0.5]) && close(shares(&bar, [0.6]), &[1.0]));
    }

    /// A linear field is reproduced at a point, whichever element gives it.
    #[test]
    fn shape_functions_reproduce_linear_fields() {
        let mesh = TriangleMesh::rectangle(2.0, 1.0, 5, 3).unwrap();
        let field = |p: &[f64; 2]| 3.0 + 2.0 * p[0] - 5.0 * p[1];
        for point in [[0.4, 1.0 / 3.0], [0.77, 0.5], [1.999, 0.001]] {
            for Around { element, shapes, .. } in mesh.around(&point) {
                let corners = mesh.cell_points(element);
                let value: f64 = (0..3).map(|k| shapes[k] * field(&corners[k])).sum();
                assert!((value - field(&point)).abs() < 1e-13, "{value}");
            }
        }
    }

    #[test]
    fn the_outline_has_nearest_points_and_corners() {
        // An L: a square of three squares, with the node 4 in the corner between them.
        let points: Vec<[f64; 2]> = (0..8).map(|k| [f64::from(k % 3), f64::from(k / 3)]).collect();
        let cells = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [3, 4, 7], [3, 7, 6]];
        let mesh = TriangleMesh::new(points, &cells, &BTreeMap::new(), &BTreeMap::new()).unwrap();
        assert_eq!(mesh.corners_above(1.2 * PI), [NodeId::new(4)]);
        assert_eq!(mesh.nearest_of_outline(&[1.5, 1.25]), ([1.5, 1.0], 0.25));
        assert_eq!(mesh.nearest_of_outline(&[-3.0, -4.0]), ([0.0, 0.0], 5.0));
    }
}
