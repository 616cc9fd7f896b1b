//! Polygons in the place of curves.

use crate::message::short;
use crate::plan::{Basis, Branch};
use percute_core::ids::NodeId;
use percute_core::mesh::Mesh;

/// A boundary that turns at nodes that touch by an angle between these (degrees) may be that of a curve: a smaller one
/// is rounding or a fine polygon, a larger one a corner.
const CURVE: [f64; 2] = [1.0, 30.0];

/// What to say of a mesh that is to be graded towards nodes of a polygon that is likely in the place of a curve.
pub(super) fn warning(mesh: &Mesh, basis: &Basis) -> Option<String> {
    if mesh.dimension() != 2 || basis.branch() != Branch::Graded {
        return None;
    }
    let turns = basis.nodes().iter().filter_map(|node| turn(mesh, *node));
    let turn = turns.filter(|turn| (CURVE[0]..=CURVE[1]).contains(turn)).reduce(f64::max)?;
    Some(format!(
        "the outline turns by up to {}° at contact nodes: if it approximates a curve, its vertices become corners as \
         elements become smaller; mesh the curve (--mesher gmsh with --geometry FILE.geo), or begin with a finer \
         outline",
        short(turn, 2)
    ))
}

/// The angle between the directions of the two edges of the boundary at a node (degrees).
fn turn(mesh: &Mesh, node: NodeId) -> Option<f64> {
    Some((180.0 - mesh.angle_of_outline(node)?.to_degrees()).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc of n rings is a polygon of 6 n edges.
    #[test]
    fn the_outline_of_a_disc_turns_at_its_nodes() {
        let disc = Mesh::disc(1.0, 6).unwrap();
        let lowest = NodeId::new(3 * 6 * 5 + 1);
        assert!((turn(&disc, lowest).unwrap() - 10.0).abs() < 1e-9);
        assert_eq!(turn(&disc, NodeId::new(0)), None, "a node inside");
        let square = Mesh::rectangle(1.0, 1.0, 2, 2).unwrap();
        let turns = [0, 1].map(|node| turn(&square, NodeId::new(node)).unwrap());
        assert!((turns[0] - 90.0).abs() < 1e-9 && turns[1].abs() < 1e-9, "{turns:?}");
    }
}
