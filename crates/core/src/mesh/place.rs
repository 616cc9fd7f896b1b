//! Points in a mesh: the elements that contain one, and the nearest point of the outline; angles at nodes.

use super::{Mesh, in_kind};
use crate::border::{Vector, cut};
use crate::cell::{CellKind, cell};
use crate::ids::{ElementId, FaceId, NodeId};

/// A point counts as one of an element, an edge or a node within this part of the size of the mesh: rounding of
/// coordinates.
const ROUNDING: f64 = 1e-9;

/// An element that contains a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Around {
    /// The element.
    pub element: ElementId,
    /// The shape functions of its nodes at the point.
    pub shapes: Vec<f64>,
    /// Its share of a small circle or sphere around the point, as far as this is in the body: 1 if the point is inside
    /// the element. In a bar elements have equal shares.
    pub share: f64,
}

impl Mesh {
    /// The elements that contain a point (m), ascending; several if it is on an edge or a node between them. None if it
    /// is outside the body. The shares add up to 1. They do not depend on the mesh, where the same elements, edges or
    /// nodes of a coarser mesh are cut into smaller ones.
    #[must_use]
    pub fn around(&self, point: &Vector) -> Vec<Around> {
        let tolerance = ROUNDING * self.size();
        let mut found: Vec<_> = (0..self.element_count())
            .map(ElementId::new)
            .filter(|&element| !self.is_beside(element, point, tolerance))
            .filter_map(|element| in_kind!(self, D, N => self.around_in::<D, N>(element, &cut(point), tolerance)))
            .collect();
        let all: f64 = found.iter().map(|around| around.share).sum();
        found.iter_mut().for_each(|around| around.share /= all);
        found
    }

    /// That of an element, with its angle around the point for a share: [`Cell::angle_around`](crate::cell::Cell).
    fn around_in<const D: usize, const N: usize>(
        &self,
        element: ElementId,
        point: &[f64; D],
        tolerance: f64,
    ) -> Option<Around> {
        let (corners, gradients) = (self.corners::<D, N>(element), self.geometry::<D, N>(element).gradients);
        let shapes: [f64; N] =
            std::array::from_fn(|k| 1.0 + (0..D).map(|c| gradients[k][c] * (point[c] - corners[k][c])).sum::<f64>());
        let distance = |k: usize| shapes[k] / gradients[k].iter().map(|g| g * g).sum::<f64>().sqrt();
        if (0..N).any(|k| distance(k) < -tolerance) {
            return None;
        }
        let off: Vec<usize> = (0..N).filter(|&k| distance(k) > tolerance).collect();
        let share = cell::<D, N>().angle_around(&corners, &off);
        Some(Around { element, shapes: shapes.to_vec(), share })
    }

    /// Whether a point is farther than this (m) from the smallest box around an element.
    pub(super) fn is_beside(&self, element: ElementId, point: &Vector, tolerance: f64) -> bool {
        (0..self.dimension()).any(|c| {
            let corners = self.cell(element).iter().map(|&node| self.point(node)[c]);
            let [low, high] = [f64::min, f64::max].map(|pick| corners.clone().reduce(pick));
            low.is_some_and(|low| point[c] < low - tolerance) || high.is_some_and(|high| point[c] > high + tolerance)
        })
    }

    /// The point of the outline that is nearest to a point, and the distance (m).
    #[must_use]
    pub fn nearest_of_outline(&self, point: &Vector) -> (Vector, f64) {
        let feet = self.boundary().map(|face| foot(point, &self.face_points(face)));
        feet.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((*point, f64::INFINITY))
    }

    /// The angle of a triangle (rad) or the solid angle of a tetrahedron (sr) at one of its nodes; 0 for a bar.
    #[must_use]
    pub fn angle(&self, element: ElementId, node: NodeId) -> f64 {
        let Some(k) = self.local_node(element, node) else { return 0.0 };
        match self.kind {
            CellKind::Bar => 0.0,
            CellKind::Triangle => cell::<2, 3>().angle_around(&self.corners(element), &[k]),
            CellKind::Tetrahedron => cell::<3, 4>().angle_around(&self.corners(element), &[k]),
        }
    }

    /// The angle inside a plane body between the two edges of its outline at a node (rad); none at a node inside the
    /// body and of a solid.
    #[must_use]
    pub fn angle_of_outline(&self, node: NodeId) -> Option<f64> {
        let star = self.stars().star(node);
        (!star.is_closed() && self.kind != CellKind::Tetrahedron)
            .then(|| star.elements.iter().map(|&element| self.angle(element, node)).sum())
    }

    /// The nodes of the outline of a plane body with an angle inside the body above this (rad).
    #[must_use]
    pub fn corners_above(&self, angle: f64) -> Vec<NodeId> {
        let nodes = (0..self.node_count()).map(NodeId::new);
        nodes.filter(|&node| self.angle_of_outline(node).is_some_and(|inside| inside > angle)).collect()
    }

    /// The nodes of a face (m).
    pub(super) fn face_points(&self, face: FaceId) -> Vec<Vector> {
        self.face(face).nodes.iter().map(|&node| self.point(node)).collect()
    }
}

fn less(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|c| a[c] - b[c])
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The nearest point of a face (a point, a line between two, or a triangle), and its distance (m).
pub(super) fn foot(point: &Vector, face: &[Vector]) -> (Vector, f64) {
    if let [a, b, c] = face {
        let edges = || [[a, b], [b, c], [c, a]].map(|ends| foot_on_line(point, ends)).into_iter();
        let nearest = || edges().min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((*point, f64::INFINITY));
        return foot_in_triangle(point, [a, b, c]).unwrap_or_else(nearest);
    }
    foot_on_line(point, [&face[0], &face[face.len() - 1]])
}

fn foot_on_line(point: &Vector, [first, last]: [&Vector; 2]) -> (Vector, f64) {
    let (start, along) = (less(point, first), less(last, first));
    let length = dot(&along, &along);
    let at = if length > 0.0 { (dot(&start, &along) / length).clamp(0.0, 1.0) } else { 0.0 };
    let rest: Vector = std::array::from_fn(|c| start[c] - at * along[c]);
    (less(point, &rest), dot(&rest, &rest).sqrt())
}

/// The foot of the perpendicular, if it is inside the triangle.
fn foot_in_triangle(point: &Vector, [a, b, c]: [&Vector; 3]) -> Option<(Vector, f64)> {
    let (u, v, start) = (less(b, a), less(c, a), less(point, a));
    let (uu, uv, vv, us, vs) = (dot(&u, &u), dot(&u, &v), dot(&v, &v), dot(&u, &start), dot(&v, &start));
    let determinant = uu * vv - uv * uv;
    let (s, t) = ((us * vv - vs * uv) / determinant, (vs * uu - us * uv) / determinant);
    let rest: Vector = std::array::from_fn(|k| start[k] - s * u[k] - t * v[k]);
    (s >= 0.0 && t >= 0.0 && s + t <= 1.0).then(|| (less(point, &rest), dot(&rest, &rest).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::border::padded;
    use std::collections::BTreeMap;
    use std::f64::consts::PI;

    fn shares<const D: usize>(mesh: &Mesh, point: [f64; D]) -> Vec<f64> {
        mesh.around(&padded(&point)).iter().map(|around| around.share).collect()
    }

    /// Right angles: a node inside, on an edge of the outline and at a corner, an edge, and the inside of an element.
    #[test]
    fn elements_share_a_point_by_their_angles() {
        let mesh = Mesh::rectangle(2.0, 2.0, 2, 2).unwrap();
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
        let bar = Mesh::uniform_bar(1.0, 4).unwrap();
        assert!(close(shares(&bar, [0.5]), &[0.5, 0.5]) && close(shares(&bar, [0.6]), &[1.0]));
    }

    /// A linear field is reproduced at a point, whichever element gives it.
    #[test]
    fn shape_functions_reproduce_linear_fields() {
        let mesh = Mesh::rectangle(2.0, 1.0, 5, 3).unwrap();
        let field = |p: &[f64; 2]| 3.0 + 2.0 * p[0] - 5.0 * p[1];
        for point in [[0.4, 1.0 / 3.0], [0.77, 0.5], [1.999, 0.001]] {
            for Around { element, shapes, .. } in mesh.around(&padded(&point)) {
                let corners = mesh.corners::<2, 3>(element);
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
        let mesh = Mesh::new(points, &cells, &BTreeMap::new(), &BTreeMap::new()).unwrap();
        assert_eq!(mesh.corners_above(1.2 * PI), [NodeId::new(4)]);
        assert_eq!(mesh.nearest_of_outline(&[1.5, 1.25, 0.0]), ([1.5, 1.0, 0.0], 0.25));
        assert_eq!(mesh.nearest_of_outline(&[-3.0, -4.0, 0.0]), ([0.0; 3], 5.0));
    }
}
