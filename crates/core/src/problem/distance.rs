//! How near the nodes of one of two surfaces are to the other one.

use crate::contact::{CORNER, dot};

/// The node of a surface that is nearest to another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NearestNode {
    /// Its distance along the direction (m): infinite where no node faces an edge.
    pub(super) distance: f64,
    /// Whether the surface ends or turns there.
    pub(super) is_corner: bool,
}

/// The nearest node of each of two surfaces, along a direction from the first to the second. Surfaces are given by the
/// ends of their edges.
pub(super) fn nearest<const D: usize>(
    edges: [&[[[f64; D]; 2]]; 2],
    direction: &[f64; D],
    along: &[f64; D],
    tolerance: f64,
) -> [NearestNode; 2] {
    let [first, second] = edges.map(|edges| SurfaceView::new(edges, direction, along));
    [first.nearest_to(&second, 1.0, tolerance), second.nearest_to(&first, -1.0, tolerance)]
}

/// A surface in coordinates across (ξ) and along (η) a direction (m).
struct SurfaceView {
    /// The ends of each edge, ascending in ξ, as are the edges.
    edges: Vec<[[f64; 2]; 2]>,
}

impl SurfaceView {
    fn new<const D: usize>(edges: &[[[f64; D]; 2]], direction: &[f64; D], along: &[f64; D]) -> Self {
        let place = |point: &[f64; D]| [dot(point, along), dot(point, direction)];
        let ascending = |ends: &[[f64; D]; 2]| {
            let [first, second] = ends.each_ref().map(place);
            if second[0] < first[0] { [second, first] } else { [first, second] }
        };
        let mut edges: Vec<_> = edges.iter().map(ascending).collect();
        edges.sort_by(|a, b| a[0][0].total_cmp(&b[0][0]));
        Self { edges }
    }

    /// The node that is nearest to another surface, which is ahead where the sign is positive.
    fn nearest_to(&self, other: &Self, sign: f64, tolerance: f64) -> NearestNode {
        let nodes = self.edges.iter().enumerate().flat_map(|(at, ends)| {
            let beside = [at.checked_sub(1), Some(at + 1)].map(|next| next.and_then(|next| self.edges.get(next)));
            std::array::from_fn::<_, 2, _>(|k| (ends[k], beside[k].is_none_or(|next| turns(ends, next))))
        });
        let distances = nodes.filter_map(|([xi, eta], is_corner)| {
            other.eta_at(xi, tolerance).map(|ahead| NearestNode { distance: sign * (ahead - eta), is_corner })
        });
        let none = NearestNode { distance: f64::INFINITY, is_corner: false };
        distances.min_by(|a, b| a.distance.total_cmp(&b.distance)).unwrap_or(none)
    }

    /// η at a place, if an edge is there.
    fn eta_at(&self, xi: f64, tolerance: f64) -> Option<f64> {
        // Edges of one surface have only their ends in common.
        let after = self.edges.partition_point(|[start, _]| start[0] <= xi + tolerance);
        let covers = |[start, end]: &&[[f64; 2]; 2]| end[0] > start[0] && xi <= end[0] + tolerance;
        let [start, end] = self.edges[after.saturating_sub(2)..after].iter().find(covers)?;
        Some(start[1] + (end[1] - start[1]) * (xi - start[0]) / (end[0] - start[0]))
    }
}

/// Whether the direction of one edge and that of the next one differ by a corner.
fn turns(edge: &[[f64; 2]; 2], next: &[[f64; 2]; 2]) -> bool {
    let along = |[start, end]: &[[f64; 2]; 2]| [end[0] - start[0], end[1] - start[1]];
    let (a, b) = (along(edge), along(next));
    dot(&a, &b) < CORNER.cos() * (dot(&a, &a) * dot(&b, &b)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::nearest;

    /// An edge from one place to another.
    fn edges(points: &[[f64; 2]]) -> Vec<[[f64; 2]; 2]> {
        points.windows(2).map(|ends| [ends[0], ends[1]]).collect()
    }

    fn distances(lower: &[[f64; 2]], upper: &[[f64; 2]]) -> [f64; 2] {
        nearest([&edges(lower), &edges(upper)], &[0.0, 1.0], &[1.0, 0.0], 1e-12).map(|nearest| nearest.distance)
    }

    #[test]
    fn corners_are_ends_and_sharp_turns() {
        let flat = edges(&[[-2.0, -1.0], [2.0, -1.0]]);
        let is_corner =
            |points: &[[f64; 2]]| nearest([&flat, &edges(points)], &[0.0, 1.0], &[1.0, 0.0], 1e-12)[1].is_corner;
        assert!(is_corner(&[[0.0, 0.0], [1.0, 0.1], [2.0, 0.2]]));
        assert!(is_corner(&[[-1.0, 0.5], [0.0, 0.0], [1.0, 0.5]]));
        // A regular polygon of 12 edges turns by 30°.
        let polygon = [-1.0, 0.0, 1.0].map(|k| {
            let (sin, cos) = (std::f64::consts::PI / 6.0 * k).sin_cos();
            [sin, 1.0 - cos]
        });
        assert!(!is_corner(&polygon));
    }

    #[test]
    fn a_corner_is_nearer_than_the_nodes_beside_it() {
        let (flat, corner) = ([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], [[0.25, 1.0], [0.75, 0.5], [1.25, 1.0]]);
        assert_eq!(distances(&flat, &corner), [0.75, 0.5]);
        // In whatever order nodes and surfaces are.
        let reversed = [corner[2], corner[1], corner[0]];
        assert_eq!(distances(&flat, &reversed), [0.75, 0.5]);
        let up = |points: &[[f64; 2]]| points.iter().map(|[x, y]| [*x, -y]).collect::<Vec<_>>();
        assert_eq!(distances(&up(&corner), &up(&flat)), [0.5, 0.75]);
    }

    #[test]
    fn parallel_surfaces_are_as_near_as_each_other() {
        assert_eq!(distances(&[[0.0, 0.0], [1.0, 0.0]], &[[0.5, 0.25], [0.75, 0.25], [2.0, 0.25]]), [0.25; 2]);
    }

    #[test]
    fn where_nothing_is_faced_the_distance_is_infinite() {
        let beside = distances(&[[0.0, 0.0], [1.0, 0.0]], &[[1.5, 0.25], [2.0, 0.25]]);
        assert_eq!(beside, [f64::INFINITY; 2]);
        // No node of the longer surface faces the shorter one.
        let within = distances(&[[0.0, 0.0], [1.0, 0.0]], &[[0.25, 0.25], [0.5, 0.25]]);
        assert_eq!(within, [f64::INFINITY, 0.25]);
    }
}
