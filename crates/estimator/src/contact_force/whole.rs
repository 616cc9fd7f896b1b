//! The whole reaction as a density on all candidate facets of its node.

use super::{Densities, none};
use percute_core::problem::Problem;

/// Areas, fixed in time.
#[derive(Clone, Debug)]
pub(crate) struct Whole {
    /// Tributary area (m²) of each node of the contact surface.
    tributary: Vec<f64>,
}

impl Whole {
    pub(super) fn new<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Self {
        let mut tributary = vec![0.0; problem.surface().nodes().len()];
        for facet in problem.surface().facets() {
            facet.nodes.iter().for_each(|&k| tributary[k] += facet.area / D as f64);
        }
        Self { tributary }
    }

    /// Densities at one instant: R_k/ℓ_k at the nodes, whether they touch or are about to, linear along each
    /// facet. Their resultant is that of the reactions, and where those are in the cone, so is every mean of
    /// two of them.
    pub(crate) fn densities<const D: usize, const N: usize>(
        &self,
        problem: &Problem<D, N>,
        reaction: &[[f64; D]],
    ) -> Densities<D> {
        let mut densities = none(problem);
        for (facet, density) in problem.surface().facets().iter().zip(&mut densities) {
            let plane = &problem.obstacles()[facet.obstacle];
            // Reactions of the integrator are in the cone; those of a foreign history need not be.
            *density = facet.nodes.map(|k| plane.project_into_cone(&reaction[k].map(|r| r / self.tributary[k])));
        }
        densities
    }
}
