//! The forces of a solid: nodal sums of those of its elements, which have rooms of their own. The same bits for any
//! number of threads.

use super::lumping::LumpingGraph;
use crate::element::Element;
use crate::inertia::{arms, lumping_stress};
use crate::parallel::by_pieces;
use crate::smoothing::{Smoothed, SmoothedStrains, Smoothing};
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Law;
use percute_core::problem::Problem;
use std::array::from_fn;
use std::sync::Arc;

/// What does not change in time.
#[derive(Debug)]
pub(super) struct SolidOperator<'p, const D: usize, const N: usize> {
    pub(super) problem: &'p Problem<D>,
    pub(super) smoothing: Arc<Smoothing>,
    pub(super) elements: Vec<Element<D, N>>,
    pub(super) lumping: LumpingGraph,
    /// 1/m of the components of nodes, 0 of prescribed ones: supports carry any force.
    pub(super) inverse_mass: Vec<[f64; D]>,
    /// Where the corners at each node begin.
    starts: Vec<u32>,
    /// The corners of elements at nodes: corner i of element e has the number Ne + i.
    corners: Vec<u32>,
}

/// Forces on the nodes of each element.
pub(super) type CornerForces<const D: usize, const N: usize> = Vec<[[f64; D]; N]>;

impl<'p, const D: usize, const N: usize> SolidOperator<'p, D, N> {
    /// Without the data of the elements.
    pub(super) fn new(problem: &'p Problem<D>, smoothing: Arc<Smoothing>) -> Self {
        let (mesh, mut starts, mut corners) = (problem.mesh(), vec![0], Vec::new());
        for node in (0..mesh.node_count()).map(NodeId::new) {
            let of = |id: &ElementId| mesh.local_node(*id, node).map(|corner| (N * id.index() + corner) as u32);
            corners.extend(mesh.stars().star(node).elements.iter().filter_map(of));
            starts.push(corners.len() as u32);
        }
        let mut inverse_mass: Vec<[f64; D]> = problem.mass().iter().map(|m| [1.0 / m; D]).collect();
        problem.prescribed().iter().for_each(|p| inverse_mass[p.node.index()][p.component] = 0.0);
        let lumping = LumpingGraph::new(problem);
        Self { problem, smoothing, elements: Vec::new(), lumping, inverse_mass, starts, corners }
    }

    /// The sum of corner forces at a node.
    #[inline(always)]
    pub(super) fn sum(&self, node: usize, forces: &[[[f64; D]; N]]) -> [f64; D] {
        let (all, mut sum) = (forces.as_flattened(), [0.0; D]);
        for &corner in &self.corners[self.starts[node] as usize..self.starts[node + 1] as usize] {
            let force = &all[corner as usize];
            (0..D).for_each(|c| sum[c] += force[c]);
        }
        sum
    }

    /// The internal forces of displacements (N), of smoothed strains or of plain ones.
    pub(super) fn internal_forces(
        &self,
        displacement: &[[f64; D]],
        strains: Option<&mut SmoothedStrains<f64>>,
        forces: &mut [[[f64; D]; N]],
    ) {
        let of = Smoothed { problem: self.problem, smoothing: &self.smoothing, elements: &self.elements };
        let Some(strains) = strains else {
            by_pieces((forces, &self.elements[..]), &|first, (forces, elements)| {
                for (k, (forces, element)) in forces.iter_mut().zip(elements).enumerate() {
                    let gradient = element.gradient(&element.gather(displacement));
                    *forces = self.forces_of(first + k, element, &gradient);
                }
            });
            return;
        };
        strains.fill_one(of, displacement);
        let strains = &*strains;
        by_pieces((forces, &self.elements[..]), &|first, (forces, elements)| {
            for (k, (forces, element)) in forces.iter_mut().zip(elements).enumerate() {
                *forces = self.forces_of(first + k, element, &strains.of(0.0, of, ElementId::new(first + k)));
            }
        });
    }

    /// The forces of the stress of a strain or displacement gradient of an element.
    #[inline(always)]
    fn forces_of(&self, e: usize, element: &Element<D, N>, gradient: &[[f64; D]; D]) -> [[f64; D]; N] {
        let stress = self.problem.material(ElementId::new(e)).stress(gradient);
        from_fn(|i| element.internal_force(i, &stress))
    }

    /// The forces |E|(τ − τˢ)∇φ of the skew part of the stress τ = ρ/(D+2) Σ w_i ⊗ d_i that lumping the mass is for a
    /// motion w (m/s²), d_i from the centroid.
    pub(super) fn skew_forces(&self, w: &[[f64; D]], forces: &mut [[[f64; D]; N]]) {
        let mesh = self.problem.mesh();
        by_pieces((forces, &self.elements[..]), &|first, (forces, elements)| {
            for (k, (forces, element)) in forces.iter_mut().zip(elements).enumerate() {
                let id = ElementId::new(first + k);
                let (arms, density) = (arms(&mesh.corners::<D, N>(id)), self.problem.material(id).density());
                let stress = lumping_stress(density, &arms, &element.gather(w));
                let skew = from_fn(|a| from_fn(|b| 0.5 * (stress[a][b] - stress[b][a])));
                *forces = from_fn(|i| element.internal_force(i, &skew));
            }
        });
    }
}
