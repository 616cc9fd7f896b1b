//! The facets that carry prescribed tractions.

use percute_core::ids::FacetId;
use percute_core::problem::Problem;
use std::collections::BTreeMap;

/// All facets with a load, each once, in ascending order.
#[derive(Debug)]
pub(crate) struct LoadedFacets<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    facets: Vec<FacetId>,
}

impl<'p, const D: usize, const N: usize> LoadedFacets<'p, D, N> {
    pub(crate) fn new(problem: &'p Problem<D, N>) -> Self {
        let mut facets: Vec<FacetId> = problem.facet_loads().iter().map(|l| l.facet).collect();
        facets.sort_unstable();
        facets.dedup();
        Self { problem, facets }
    }

    pub(crate) fn facets(&self) -> &[FacetId] {
        &self.facets
    }

    /// Moments of the tractions on them at an instant (N).
    pub(crate) fn moments(&self, t: f64) -> Vec<[[f64; D]; D]> {
        let mut sums: BTreeMap<FacetId, [[f64; D]; D]> = self.facets.iter().map(|&f| (f, [[0.0; D]; D])).collect();
        for load in self.problem.facet_loads() {
            let area = self.problem.facet_area(load.facet);
            let moments = Problem::<D, N>::facet_moments(area, &self.problem.facet_traction_at(load, t));
            if let Some(sum) = sums.get_mut(&load.facet) {
                (0..D).for_each(|i| (0..D).for_each(|c| sum[i][c] += moments[i][c]));
            }
        }
        sums.into_values().collect()
    }
}
