//! The planes of symmetry of a solid of which one half is there.
//!
//! A support that holds the faces of a plane across it alone is such a plane. Of the whole body, the mean strain at an
//! edge or around a node in the plane has no shear strain across it; the half has it too, once this is left out.

use percute_core::ids::{FaceId, NodeId};
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
use std::collections::{BTreeMap, BTreeSet};

/// The nodes and edges in planes of symmetry, with the axes across which these are, one bit each.
#[derive(Clone, Debug, Default)]
pub(super) struct Mirrors {
    nodes: BTreeMap<NodeId, u8>,
    edges: BTreeMap<[NodeId; 2], u8>,
}

impl Mirrors {
    pub(super) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let (mesh, mut all) = (problem.mesh(), Self::default());
        let mut others: BTreeMap<NodeId, u8> = BTreeMap::new();
        let loaded: BTreeSet<FaceId> = problem.face_loads().iter().map(|load| load.face).collect();
        for face in mesh.boundary() {
            let held = problem.supported(face);
            for c in (0..D).filter(|&c| mesh.stands_across(face, c)) {
                let is_mirror = (0..D).all(|d| held[d] == (c == d)) && !loaded.contains(&face);
                let nodes = &mesh.face(face).nodes;
                if !is_mirror {
                    nodes.iter().for_each(|&node| *others.entry(node).or_default() |= 1 << c);
                    continue;
                }
                for (i, &a) in nodes.iter().enumerate() {
                    *all.nodes.entry(a).or_default() |= 1 << c;
                    nodes[..i].iter().for_each(|&b| *all.edges.entry([a.min(b), a.max(b)]).or_default() |= 1 << c);
                }
            }
        }
        for (node, axes) in &mut all.nodes {
            *axes &= !others.get(node).copied().unwrap_or(0);
            (0..D).filter(|c| !is_beside::<D>(mesh, *node, *c)).for_each(|c| *axes &= !(1 << c));
        }
        all
    }

    /// The axes across which a plane of symmetry passes through an edge, or through a node: then both are the node.
    pub(super) fn across(&self, [a, b]: [NodeId; 2]) -> u8 {
        let of = |node: NodeId| self.nodes.get(&node).copied().unwrap_or(0);
        let along = if a == b { u8::MAX } else { self.edges.get(&[a.min(b), a.max(b)]).copied().unwrap_or(0) };
        if along == 0 { 0 } else { along & of(a) & of(b) }
    }
}

/// Whether the elements around a node are on one side of the plane across an axis there.
fn is_beside<const D: usize>(mesh: &Mesh, node: NodeId, axis: usize) -> bool {
    let points = mesh.points_in::<D>();
    let place = points[node.index()][axis];
    let cells = mesh.stars().star(node).elements.iter().map(|element| mesh.cell(*element));
    let ends = cells.flatten().fold([0.0_f64; 3], |[low, high, size], other| {
        let at = points[other.index()][axis];
        [low.min(at - place), high.max(at - place), size.max(at.abs())]
    });
    // Rounding of places of a mesh that was moved.
    let rounding = 64.0 * f64::EPSILON * (ends[2] + ends[1] - ends[0]);
    ends[0] >= -rounding || ends[1] <= rounding
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::load::{Profile, Support, Table, Traction};
    use percute_core::material::Elastic;

    fn support(group: &str, components: [bool; 3]) -> Support {
        Support { group: group.into(), components, velocity: None }
    }

    /// Of a box held across x and across y: the nodes of both sides, each with its axes, and the edges in them. A side
    /// that is held otherwise, or loaded, is no mirror.
    #[test]
    fn planes_of_symmetry_of_a_box() {
        let problem = |loaded: bool| {
            let mut builder = Problem::<3>::builder(Mesh::cuboid([1.0, 1.0, 1.0], [2, 1, 2]).unwrap())
                .material(Elastic::solid(70.0, 0.3, 2.0).unwrap())
                .support(support("left", [true, false, false]))
                .support(support("front", [false, true, false]))
                .support(support("bottom", [true, true, true]));
            if loaded {
                let value = Table::new(vec![0.0, 1.0], vec![[0.0, 0.0, 1.0]; 2]).unwrap();
                let profile = Profile { value: 1.0, gradient: [0.0; 3] };
                builder = builder.traction(Traction { group: "left".into(), value, profile });
            }
            builder.build().unwrap()
        };
        let (mirrored, loaded) = (problem(false), problem(true));
        let (mirrors, fewer) = (Mirrors::new(&mirrored), Mirrors::new(&loaded));
        let points = mirrored.mesh().points_in::<3>();
        for (i, p) in points.iter().enumerate() {
            let expected = u8::from(p[0] == 0.0) | u8::from(p[1] == 0.0) << 1;
            assert_eq!(mirrors.across([NodeId::new(i); 2]), expected, "{p:?}");
            assert_eq!(fewer.across([NodeId::new(i); 2]), expected & 2, "{p:?}");
        }
        for cell in mirrored.mesh().nodes_of::<4>() {
            for (a, b) in (0..4).flat_map(|b| (0..b).map(move |a| (cell[a], cell[b]))) {
                let both = |c: usize| u8::from(points[a.index()][c] == 0.0 && points[b.index()][c] == 0.0) << c;
                assert_eq!(mirrors.across([a, b]), both(0) | both(1));
            }
        }
    }
}
