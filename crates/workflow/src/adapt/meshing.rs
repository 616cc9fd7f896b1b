//! Meshes of plans.

use super::bisect::{bisected, expected};
use super::gmsh::{self, Geometry};
use crate::failure::Failure;
use crate::plan::{Basis, Branch, LARGEST, Plan, PlannedSizes, sizes};
use percute_core::ids::ElementId;
use percute_core::mesh::{Bisection, Locator, Mesh};
use percute_core::problem::AnyProblem;
use std::sync::Arc;

/// The way to make meshes.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Mesher {
    /// Bisection of the first mesh; where all elements become smaller alike, the generator of the first mesh, if it has
    /// one.
    #[default]
    Bisection,
    /// The program Gmsh.
    Gmsh(Geometry),
}

/// Makes the meshes of an adaptation from the first one.
#[derive(Clone, Debug)]
pub(super) struct Meshing {
    first: Bisection,
    mesher: Mesher,
}

impl Meshing {
    /// # Errors
    /// A mesh that the mesher cannot make.
    pub(super) fn new(problem: &AnyProblem, mesher: Mesher) -> Result<Self, Failure> {
        let pairs = problem.facing_nodes();
        let told = match &mesher {
            Mesher::Bisection => None,
            Mesher::Gmsh(_) if problem.dimension() == 1 => Some("a bar is not meshed by Gmsh"),
            Mesher::Gmsh(_) if !pairs.is_empty() => {
                Some("nodes of bodies that face each other in pairs would not do so in a mesh of Gmsh")
            }
            Mesher::Gmsh(geometry) => {
                gmsh::check(geometry)?;
                None
            }
        };
        let refused = told.map(|told| Failure::Argument(format!("{told}; take the mesher \"bisect\"")));
        refused.map_or(Ok(()), Err)?;
        Ok(Self { first: Bisection::new(problem.mesh().clone(), &pairs), mesher })
    }

    /// Whether the outline of the first mesh stays.
    pub(super) fn keeps_polygons(&self) -> bool {
        !matches!(self.mesher, Mesher::Gmsh(Geometry::File(..)))
    }

    /// The mesh of a plan for the mesh of a run, and the mean error that is expected on it, over that of the run. It
    /// has about `most` elements at most.
    pub(super) fn next(
        &self,
        run: &Mesh,
        (basis, plan): (&Basis, &Plan),
        most: usize,
    ) -> Result<(Arc<Mesh>, f64), Failure> {
        let Mesher::Gmsh(geometry) = &self.mesher else {
            return bisected(&self.first, run, (basis, plan), most);
        };
        let next = gmsh::meshed(self.first.mesh(), geometry, run, (basis, plan), most)?;
        let expected = expected(&PlannedSizes::new(run, basis, plan), &next, basis, plan);
        Ok((next.into(), expected))
    }

    /// The same by the generator of the first mesh, if all elements become smaller alike.
    pub(super) fn generated(&self, run: &Mesh, plan: &Plan) -> Option<(Arc<Mesh>, f64)> {
        if plan.branch != Branch::Uniform || self.mesher != Mesher::Bisection {
            return None;
        }
        let next = run.resized(1.0 / plan.ratio.first()?)?;
        let finer = next.element_count() as f64 / run.element_count() as f64;
        Some((next.into(), finer.powf(-plan.exponents.far / run.dimension() as f64)))
    }

    /// How much larger than in a run each of its elements may become: with bisection not larger than in the first mesh.
    pub(super) fn largest(&self, run: &Mesh) -> Vec<f64> {
        let mesh = self.first.mesh();
        let (locator, first) = (Locator::new(mesh), sizes(mesh));
        let most = if self.mesher == Mesher::Bisection { 1.0 } else { LARGEST };
        let of = |(e, h): (usize, f64)| {
            let in_first = locator.element_near(&run.centroid(ElementId::new(e)));
            (most * first[in_first.index()] / h).clamp(1.0, LARGEST)
        };
        sizes(run).into_iter().enumerate().map(of).collect()
    }
}
