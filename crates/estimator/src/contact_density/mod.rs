//! Contact densities F_DA on the candidate facets: the forces that they do on nodes, and their misfit of the contact law.

mod friction_misfit;
mod normal_misfit;

pub(crate) use friction_misfit::{along, misfit_power, tangent};
pub(crate) use normal_misfit::{FacetPressures, NormalMisfit, OffContact};
use percute_core::contact::ContactFacet;
use percute_core::problem::Problem;
use std::ops::Deref;

/// Nodal values of a density on each candidate facet (Pa). Constant once a reconstruction has made them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Densities<const D: usize>(Vec<[[f64; D]; D]>);

impl<const D: usize> Deref for Densities<D> {
    type Target = [[[f64; D]; D]];

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<const D: usize> Densities<D> {
    /// The values on each candidate facet, by its position.
    pub(crate) fn new<const N: usize>(
        problem: &Problem<D, N>,
        value: impl Fn(usize, &ContactFacet<D>) -> [[f64; D]; D],
    ) -> Self {
        Self(problem.surface().facets().iter().enumerate().map(|(f, facet)| value(f, facet)).collect())
    }

    /// No force anywhere.
    pub(crate) fn none<const N: usize>(problem: &Problem<D, N>) -> Self {
        Self::new(problem, |_, _| [[0.0; D]; D])
    }

    /// For tests that change them.
    #[cfg(test)]
    pub(crate) fn values_mut(&mut self) -> &mut [[[f64; D]; D]] {
        &mut self.0
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
