//! Local refinement, again and again, that keeps surfaces matching.

use super::{Mesh, MeshError};
use crate::ids::{ElementId, NodeId};
use std::collections::BTreeMap;
use std::sync::Arc;

/// For each node of an interface the node that it faces.
pub(super) type Twins = BTreeMap<usize, usize>;

/// A mesh that is cut again and again. Where nodes of two bodies face each other in pairs, an edge and the one that it
/// faces are cut together, so that they go on facing each other.
#[derive(Clone, Debug)]
pub struct Bisection {
    mesh: Arc<Mesh>,
    /// Of each interface.
    twins: Vec<Twins>,
}

impl Bisection {
    /// From a mesh and the pairs of nodes that face each other at each interface.
    #[must_use]
    pub fn new(mesh: Arc<Mesh>, interfaces: &[Vec<[NodeId; 2]>]) -> Self {
        let both = |[a, b]: &[NodeId; 2]| [(a.index(), b.index()), (b.index(), a.index())];
        Self { mesh, twins: interfaces.iter().map(|pairs| pairs.iter().flat_map(both).collect()).collect() }
    }

    /// The mesh as it is now.
    #[must_use]
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The mesh as it is now.
    #[must_use]
    pub fn into_mesh(self) -> Arc<Mesh> {
        self.mesh
    }

    /// Cuts each chosen element as [`Mesh::refined_where`] does.
    ///
    /// # Errors
    /// As for [`Mesh::refined`].
    pub fn cut(&mut self, chosen: impl Fn(ElementId) -> bool) -> Result<(), MeshError> {
        let cuts = self.mesh.cuts(chosen, &self.twins);
        for twins in &mut self.twins {
            let facing = |[a, b]: &[usize; 2]| {
                let image = [*twins.get(a)?, *twins.get(b)?];
                Some((cuts.middle([*a, *b])?, cuts.middle(image)?))
            };
            let middles: Vec<(usize, usize)> = cuts.edges().iter().filter_map(facing).collect();
            twins.extend(middles);
        }
        self.mesh = Arc::new(self.mesh.cut(&cuts)?);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{ElementGroups, FaceGroups, Mesh};

    /// Two squares, one above the other, whose nodes face each other across a gap.
    fn pair() -> (Mesh, Vec<[NodeId; 2]>) {
        let lower = Mesh::rectangle(1.0, 1.0, 3, 2).unwrap();
        let count = lower.node_count();
        let points = lower
            .points_in::<2>()
            .iter()
            .copied()
            .chain(lower.points_in::<2>().iter().map(|p| [p[0], 1.01 + p[1]]))
            .collect();
        let cells: Vec<_> = lower.nodes_of::<3>().iter().map(|cell| cell.map(|n| n.index())).collect();
        let cells: Vec<_> = cells.iter().copied().chain(cells.iter().map(|cell| cell.map(|n| count + n))).collect();
        let mesh = Mesh::of_bodies(points, &cells, &FaceGroups::new(), &ElementGroups::new()).unwrap();
        (mesh, (0..4).map(|k| [NodeId::new(8 + k), NodeId::new(count + k)]).collect())
    }

    /// The places along the line of nodes at this height, in order.
    fn along(mesh: &Mesh, height: f64) -> Vec<f64> {
        let mut found: Vec<f64> = mesh.points_in::<2>().iter().filter(|p| p[1] == height).map(|p| p[0]).collect();
        found.sort_unstable_by(f64::total_cmp);
        found
    }

    /// Elements of one body alone are chosen, at its side: both sides keep facing nodes; without pairs they do not.
    #[test]
    fn surfaces_keep_facing_each_other() {
        let (mesh, pairs) = pair();
        let refined = |interfaces: &[Vec<[NodeId; 2]>]| {
            let mut bisection = Bisection::new(Arc::new(mesh.clone()), interfaces);
            for _ in 0..4 {
                let touches = |e: ElementId| {
                    let points = bisection.mesh().corners::<2, 3>(e);
                    points.iter().any(|p| p[0] == 0.0 && p[1] == 1.0)
                };
                bisection.clone().cut(touches).unwrap();
                let chosen: Vec<bool> =
                    (0..bisection.mesh().element_count()).map(|e| touches(ElementId::new(e))).collect();
                bisection.cut(|e| chosen[e.index()]).unwrap();
            }
            bisection.into_mesh()
        };
        let together = refined(&[pairs]);
        assert_eq!(along(&together, 1.0), along(&together, 1.01));
        assert!(along(&together, 1.0).len() >= 8);
        let apart = refined(&[]);
        assert_ne!(along(&apart, 1.0), along(&apart, 1.01));
        assert_eq!(along(&apart, 1.01).len(), 4);
    }
}
