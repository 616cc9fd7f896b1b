//! Densities on the candidate facets, and the forces that they do on nodes.

use percute_core::problem::Problem;
use std::ops::Deref;

/// Nodal values of a density on each candidate facet (Pa). Only a reconstruction makes one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Densities<const D: usize>(pub(super) Vec<[[f64; D]; D]>);

impl<const D: usize> Deref for Densities<D> {
    type Target = [[[f64; D]; D]];

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<const D: usize> Densities<D> {
    /// No force anywhere.
    pub(super) fn none<const N: usize>(problem: &Problem<D, N>) -> Self {
        Self(vec![[[0.0; D]; D]; problem.surface().facets().len()])
    }
}

/// ∫F φ_k over all facets, for each node of the contact surface (N).
pub(crate) fn nodal_forces<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    densities: &Densities<D>,
) -> Vec<[f64; D]> {
    let mut forces = vec![[0.0; D]; problem.surface().nodes().len()];
    for (facet, density) in problem.surface().facets().iter().zip(densities.iter()) {
        let moments = Problem::<D, N>::facet_moments(facet.area, density);
        for (node, moment) in facet.nodes.iter().zip(moments) {
            (0..D).for_each(|c| forces[*node][c] += moment[c]);
        }
    }
    forces
}

/// The forces that move the nodes of the contact surface under a density (N): [`nodal_forces`] without the tangential
/// part at guided nodes, whose tangential motion is prescribed.
pub(crate) fn driving_forces<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    densities: &Densities<D>,
) -> Vec<[f64; D]> {
    let mut forces = nodal_forces(problem, densities);
    for (contact, force) in problem.surface().nodes().iter().zip(&mut forces).filter(|(contact, _)| contact.guided) {
        let frame = problem.obstacles()[contact.obstacle].flat_frame();
        *force = frame.normal().map(|n| n * frame.split(force).0);
    }
    forces
}
