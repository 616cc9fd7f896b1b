//! The whole reaction as a density on all candidate facets of its node.

mod auxiliary_solution;
mod impulse_smoothing;
mod moment_correction;
mod normal_misfit;
mod traction_minimisation;

pub(crate) use auxiliary_solution::{AuxiliarySolution, kinetic_energy};
pub(crate) use impulse_smoothing::ImpulseSmoothing;
use moment_correction::MomentCorrection;
pub(crate) use normal_misfit::{FacetPressures, NormalMisfit};
pub(crate) use traction_minimisation::{Form, MOMENTS, TractionMinimisation};

use super::{Densities, Interval, SurfaceStep, none};
use percute_core::problem::{ContactFacet, ContactNode, Problem};

/// What is fixed in time.
#[derive(Clone, Debug)]
pub(crate) struct Corrected<const D: usize> {
    /// Tributary area (m²) of each node of the contact surface.
    tributary: Vec<f64>,
    moment_correction: MomentCorrection<D>,
}

/// Normal pressures (Pa) at the nodes of a facet at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pressure<const D: usize> {
    /// Of the density.
    pub(crate) acting: [f64; D],
    /// Of the density that the reactions alone give, their impulses not spread in time.
    pub(crate) sudden: [f64; D],
}

impl<const D: usize> Pressure<D> {
    /// Halfway between two: pressures are linear in time over a step.
    pub(crate) fn middle(start: &Self, end: &Self) -> Self {
        let mean = |a: &[f64; D], b: &[f64; D]| std::array::from_fn(|p| 0.5 * (a[p] + b[p]));
        Self { acting: mean(&start.acting, &end.acting), sudden: mean(&start.sudden, &end.sudden) }
    }
}

impl<const D: usize> Corrected<D> {
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        Self { tributary: problem.surface().tributary_areas(), moment_correction: MomentCorrection::new(problem) }
    }

    /// The same with densities whose moment is not that of the reactions.
    pub(super) fn without_moment_correction(self) -> Self {
        Self { moment_correction: MomentCorrection::none(), ..self }
    }

    /// Densities at one instant: R_k/ℓ_k at the nodes, whether they touch or are about to, linear along each
    /// facet, tilted so that they have the moment of the reactions too. Their resultant is that of the reactions,
    /// and where those are in the cone, so is every mean of two of them.
    pub(crate) fn densities<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        smoothed_reaction: &[[f64; D]],
    ) -> Densities<D> {
        let mut densities = none(problem);
        // Reactions of the integrator are in the cone; those of a foreign history need not be.
        let held = |(contact, force): (&ContactNode, &[f64; D])| {
            problem.obstacles()[contact.obstacle].project_into_cone(force)
        };
        let mut smoothed_reaction: Vec<[f64; D]> =
            problem.surface().nodes().iter().zip(smoothed_reaction).map(held).collect();
        self.moment_correction.apply(&mut smoothed_reaction);
        for (facet, density) in problem.surface().facets().iter().zip(&mut densities) {
            *density = facet.nodes.map(|k| smoothed_reaction[k].map(|r| r / self.tributary[k]));
        }
        densities
    }

    /// The normal pressures of a step on each facet, at its beginning and its end.
    pub(crate) fn pressures<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        now: &SurfaceStep<D>,
        next: &SurfaceStep<D>,
        interval: &Interval<D>,
    ) -> Vec<[Pressure<D>; 2]> {
        let sudden = [now, next].map(|step| self.densities(problem, &step.reaction));
        let acting = [&interval.start, &interval.end];
        let one = |(f, facet): (usize, &ContactFacet<D>)| {
            let plane = &problem.obstacles()[facet.obstacle];
            let normal = |densities: &Densities<D>| densities[f].map(|force| plane.split(&force).0);
            [0, 1].map(|end| Pressure { acting: normal(acting[end]), sudden: normal(&sudden[end]) })
        };
        problem.surface().facets().iter().enumerate().map(one).collect()
    }
}
