//! Work of nodal forces.

use crate::ids::NodeId;

/// Work of a set of nodal forces: Σ ½(F_n + F_{n+1})·(u_{n+1} − u_n), for which the central
/// differences balance to O(Δt²).
#[derive(Clone, Debug)]
pub(super) struct WorkMeter<const D: usize> {
    nodes: Vec<NodeId>,
    force: Vec<[f64; D]>,
    displacement: Vec<[f64; D]>,
}

impl<const D: usize> WorkMeter<D> {
    pub(super) fn new(nodes: Vec<NodeId>) -> Self {
        Self { force: vec![[0.0; D]; nodes.len()], displacement: vec![[0.0; D]; nodes.len()], nodes }
    }

    /// Work since the last call, node by node where a force acts; `force` gives F_n of the i-th node.
    pub(super) fn advance(
        &mut self,
        u: &[[f64; D]],
        force: impl Fn(usize) -> [f64; D],
        mut each: impl FnMut(usize, [f64; D], [f64; D]),
    ) {
        for (i, node) in self.nodes.iter().enumerate() {
            let (now, at) = (force(i), u[node.index()]);
            let (mut mean, mut path) = ([0.0; D], [0.0; D]);
            for c in 0..D {
                mean[c] = 0.5 * (self.force[i][c] + now[c]);
                path[c] = at[c] - self.displacement[i][c];
            }
            if mean != [0.0; D] {
                each(i, mean, path);
            }
            self.force[i] = now;
            self.displacement[i] = at;
        }
    }
}
