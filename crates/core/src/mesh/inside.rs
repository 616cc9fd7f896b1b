//! How far a body is inside another one.

use super::place::foot;
use super::{Mesh, in_kind};
use crate::border::{Vector, cut};
use crate::cell::cell;
use crate::ids::{FaceId, NodeId};

/// The node of a body that is deepest inside another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inside {
    pub(super) node: NodeId,
    /// The way to the boundary of the other body (m).
    pub(super) depth: f64,
    /// The face of the node that looks most against the other body, and the nearest one of that.
    pub(super) faces: [FaceId; 2],
}

impl Mesh {
    /// The node of the boundary that is deepest inside another mesh, by more than a tolerance (m).
    pub(super) fn deepest_in(&self, other: &Self, tolerance: f64) -> Option<Inside> {
        let mut nodes: Vec<NodeId> = self.boundary().flat_map(|face| self.face(face).nodes).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let outline: Vec<(FaceId, Vec<Vector>)> =
            other.boundary().map(|face| (face, other.face_points(face))).collect();
        let depth = |node: NodeId| {
            let point = &self.point(node);
            if !other.encloses(point) {
                return None;
            }
            let ways = outline.iter().map(|(face, points)| (foot(point, points).1, *face));
            ways.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(depth, nearest)| (node, depth, nearest))
        };
        let deepest = nodes.into_iter().filter_map(depth).filter(|(_, depth, _)| *depth > tolerance);
        let (node, depth, nearest) = deepest.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let normal = other.face_normal(nearest).0;
        let against = |face: &FaceId| -> f64 { self.face_normal(*face).0.iter().zip(normal).map(|(a, b)| a * b).sum() };
        let own = self.boundary().filter(|&face| self.face(face).nodes.contains(&node));
        let own = own.min_by(|a, b| against(a).total_cmp(&against(b)))?;
        Some(Inside { node, depth, faces: [own, nearest] })
    }

    /// The names of the groups of a face of the boundary.
    pub(super) fn groups_of(&self, face: FaceId) -> impl Iterator<Item = &str> {
        self.face_groups().iter().filter(move |(_, all)| all.contains(&face)).map(|(name, _)| name.as_str())
    }

    /// Whether a point is in an element, or on its boundary.
    fn encloses(&self, point: &Vector) -> bool {
        let mut near = self.elements().filter(|&element| !self.is_beside(element, point, 0.0));
        in_kind!(self, D, N => near.any(|e| cell::<D, N>().encloses(&self.corners(e), &cut(point), 0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_deepest_node_is_found_with_its_surfaces() {
        let block = |x: f64, y: f64| Mesh::rectangle(4.0, 2.0, 8, 4).unwrap().placed(&[x, y, 0.0], 0.0).unwrap();
        let (lower, upper) = (block(0.0, 0.0), block(1.0, 1.9));
        let inside = upper.deepest_in(&lower, 1e-9).unwrap();
        // The lower side of the upper block is 0.1 m below the upper side of the lower one.
        assert!((inside.depth - 0.1).abs() < 1e-12, "{inside:?}");
        let groups = [(&upper, inside.faces[0]), (&lower, inside.faces[1])];
        assert_eq!(groups.map(|(mesh, face)| mesh.groups_of(face).collect::<Vec<_>>()), [["bottom"], ["top"]]);
        // Blocks that touch, and such that are apart.
        assert_eq!(block(1.0, 2.0).deepest_in(&lower, 1e-9), None);
        assert_eq!(block(1.0, 2.1).deepest_in(&lower, 1e-9), None);
        let bar = |x: f64| Mesh::uniform_bar(1.0, 10).unwrap().placed(&[x, 0.0, 0.0], 0.0).unwrap();
        let inside = bar(0.75).deepest_in(&bar(0.0), 1e-9).unwrap();
        assert!((inside.depth - 0.25).abs() < 1e-12 && inside.node.index() == 0, "{inside:?}");
    }
}
