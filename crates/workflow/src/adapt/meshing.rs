//! Meshes of plans.

use super::bisect::bisected;
use crate::failure::Failure;
use crate::plan::{Basis, Branch, LARGEST, Plan, sizes};
use percute_core::ids::ElementId;
use percute_core::mesh::{Bisection, Generated, Locator, Mesh};
use percute_core::problem::Problem;

/// Makes the meshes of an adaptation from the first one.
#[derive(Clone, Debug)]
pub(super) struct Meshing<const D: usize, const N: usize> {
    first: Bisection<D, N>,
}

impl<const D: usize, const N: usize> Meshing<D, N>
where
    Mesh<D, N>: Generated,
{
    pub(super) fn new(problem: &Problem<D, N>) -> Self {
        Self { first: Bisection::new(problem.mesh().clone(), &problem.facing_nodes()) }
    }

    /// The mesh of a plan for the mesh of a run, and the mean error that is expected on it, over that of the run. It has
    /// about `most` elements at most.
    pub(super) fn next(
        &self,
        run: &Mesh<D, N>,
        (basis, plan): (&Basis, &Plan),
        most: usize,
    ) -> Result<(Mesh<D, N>, f64), Failure> {
        generated(run, plan).map_or_else(|| bisected(&self.first, run, (basis, plan), most), Ok)
    }

    /// How much larger than in a run each of its elements may become: not larger than in the first mesh, of which all
    /// meshes are bisections.
    pub(super) fn largest(&self, run: &Mesh<D, N>) -> Vec<f64> {
        let (locator, first) = (Locator::new(self.first.mesh()), sizes(self.first.mesh()));
        let of = |(e, h): (usize, f64)| {
            let corners = run.cell_points(ElementId::new(e));
            let middle = std::array::from_fn(|c| corners.iter().map(|p| p[c]).sum::<f64>() / N as f64);
            (first[locator.element_near(&middle).index()] / h).clamp(1.0, LARGEST)
        };
        sizes(run).into_iter().enumerate().map(of).collect()
    }
}

/// Of a uniform plan for a mesh of a generator, its mesh with smaller elements.
fn generated<const D: usize, const N: usize>(run: &Mesh<D, N>, plan: &Plan) -> Option<(Mesh<D, N>, f64)>
where
    Mesh<D, N>: Generated,
{
    if plan.branch != Branch::Uniform {
        return None;
    }
    let next = run.resized(1.0 / plan.ratio.first()?)?;
    let finer = next.element_count() as f64 / run.element_count() as f64;
    Some((next, finer.powf(-plan.exponents.far / D as f64)))
}
