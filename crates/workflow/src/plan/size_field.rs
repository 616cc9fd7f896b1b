//! The sizes of a plan at the nodes of a mesh, for mesh generators.

use super::{Basis, Branch, Plan, PlannedSizes};
use percute_core::ids::{ElementId, NodeId};
use percute_core::mesh::{Mesh, MeshError};

/// Sizes grow by this part of the distance at most.
const GRADATION: f64 = 0.3;
/// The mesh that carries the field is cut until its elements have at most so many times the wanted size.
const COARSE: f64 = 2.0;
/// How often it is cut at most.
const ROUNDS: usize = 40;

/// Sizes of elements at the nodes of a mesh, linear between them.
#[derive(Clone, Debug)]
pub struct SizeField {
    /// The mesh that carries the sizes.
    pub mesh: Mesh,
    /// The size at each node (m): the root of the area of an element, or its length.
    pub size: Vec<f64>,
}

impl SizeField {
    /// Of a plan for the mesh of a run; on about `most` elements at most.
    ///
    /// # Errors
    /// A mesh that cannot be cut as often as needed.
    pub fn new(run: &Mesh, basis: &Basis, plan: &Plan, most: usize) -> Result<Self, MeshError> {
        if plan.branch == Branch::Uniform {
            let squares: f64 = basis.size.iter().map(|h| h * h).sum();
            let size = plan.ratio.first().copied().unwrap_or(1.0) * (squares / basis.size.len() as f64).sqrt();
            return Ok(Self { mesh: run.clone(), size: vec![size; run.node_count()] });
        }
        let wanted = PlannedSizes::new(run, basis, plan);
        let mut mesh = run.clone();
        for _ in 0..ROUNDS {
            let chosen = wanted.too_large(&mesh, COARSE);
            if !chosen.contains(&true) || chosen.len() > most {
                break;
            }
            mesh = mesh.refined_where(|e| chosen[e.index()])?;
        }
        let mut size = vec![f64::INFINITY; mesh.node_count()];
        for (e, cell) in mesh.cells().enumerate() {
            let planned = wanted.planned_in(wanted.element_of(&mesh, ElementId::new(e)));
            cell.iter().for_each(|node| size[node.index()] = size[node.index()].min(planned));
        }
        limit_growth(&mesh, &mut size);
        for (size, point) in size.iter_mut().zip(mesh.places()) {
            *size = size.min(wanted.at(&point));
        }
        Ok(Self { mesh, size })
    }
}

/// Makes sizes smaller until none grows faster than it may along an edge.
fn limit_growth(mesh: &Mesh, size: &mut [f64]) {
    let mut changed = true;
    while changed {
        changed = false;
        for cell in mesh.cells() {
            for &a in cell {
                for &b in cell {
                    let ([p, q], [a, b]) = ([a, b].map(|node| mesh.point(node)), [a, b].map(NodeId::index));
                    let square: f64 = (0..3).map(|c| (p[c] - q[c]).powi(2)).sum();
                    let most = size[b] + GRADATION * square.sqrt();
                    // Changes of rounding would go on.
                    if size[a] > most * (1.0 + 1e-9) {
                        (size[a], changed) = (most, true);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small size in a corner: elsewhere it grows by 0.3 of the distance along edges, and each size is the least that
    /// some edge allows.
    #[test]
    fn sizes_grow_slowly() {
        let mesh = Mesh::rectangle(1.0, 1.0, 9, 9).unwrap();
        let mut size = vec![f64::INFINITY; mesh.node_count()];
        size[0] = 0.01;
        limit_growth(&mesh, &mut size);
        for (size, p) in size.iter().zip(mesh.places()) {
            // Along edges a way is longer than the straight one, by less than a factor of √2.
            let straight = GRADATION * p[0].hypot(p[1]);
            assert!(*size >= 0.01 + straight - 1e-12 && *size <= 0.01 + 1.5 * straight + 1e-12, "{size} at {p:?}");
        }
    }
}
