//! Admissible contact forces F_DA (§6.2.1), in three readings.
//!
//! A density lives on the candidate facets, linear on each and linear in time inside each step.
//! An [`Interval`] holds it at both ends of a step; at an instant where the touching facets change,
//! the `consistent` reading has one value before and another after.

mod consistent;
mod corrected;
mod published;

use crate::options::{Ablation, Reconstruction};
use crate::residual::{Residuals, worse};
use corrected::Corrected;
pub(crate) use corrected::{
    AuxiliarySolution, FacetPressures, Form, ImpulseSmoothing, MOMENTS, NormalMisfit, Pressure, TractionMinimisation,
    kinetic_energy,
};
use percute_core::obstacle::Plane;
use percute_core::problem::{ContactFacet, Problem};
use percute_core::simplex::{Shape, Simplex};
use published::Published;

/// Nodal values of a density on each candidate facet (Pa).
pub(crate) type Densities<const D: usize> = Vec<[[f64; D]; D]>;

/// What the contact surface did at t_n.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceStep<const D: usize> {
    pub(crate) reaction: Vec<[f64; D]>,
    /// What the densities of `corrected` are made of: the reactions, with the impulses that stop a node spread.
    pub(crate) smoothed_reaction: Vec<[f64; D]>,
    pub(crate) touching: Vec<bool>,
}

/// F_DA at the beginning and the end of one step.
#[derive(Clone, Debug)]
pub(crate) struct Interval<const D: usize> {
    pub(crate) start: Densities<D>,
    pub(crate) end: Densities<D>,
}

/// Makes densities from reactions.
#[derive(Clone, Debug)]
pub(crate) enum Reading<const D: usize> {
    Published(Published),
    Consistent,
    Corrected(Corrected<D>),
}

impl<const D: usize> Reading<D> {
    pub(crate) fn new<const N: usize>(choice: Reconstruction, problem: &Problem<D, N>) -> Self {
        match choice {
            Reconstruction::Published => Self::Published(Published::new(problem)),
            Reconstruction::Consistent => Self::Consistent,
            Reconstruction::Corrected => Self::Corrected(Corrected::new(problem)),
        }
    }

    /// The same, and where it is asked for without the moments of the reactions.
    pub(crate) fn without(self, ablation: Ablation) -> Self {
        match self {
            Self::Corrected(whole) if ablation == Ablation::Moment => {
                Self::Corrected(whole.without_moment_correction())
            }
            other => other,
        }
    }

    /// Whether forces may act where a node does not touch.
    pub(crate) fn acts_off_contact(&self) -> bool {
        matches!(self, Self::Corrected(_))
    }

    /// The densities of the step from `now` to `next`. `before` and `after` are the steps around
    /// them; there is none before the first, nor after the last.
    pub(crate) fn interval<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        before: Option<&SurfaceStep<D>>,
        now: &SurfaceStep<D>,
        next: &SurfaceStep<D>,
        after: Option<&SurfaceStep<D>>,
    ) -> Interval<D> {
        match self {
            Self::Published(paper) => Interval {
                start: before.map_or_else(
                    || none(problem),
                    |before| paper.densities(problem, &before.touching, now, Some(&next.touching)),
                ),
                end: paper.densities(problem, &now.touching, next, after.map(|a| a.touching.as_slice())),
            },
            Self::Consistent => consistent::interval(problem, now, next),
            Self::Corrected(whole) => Interval {
                start: whole.densities(problem, &now.smoothed_reaction),
                end: whole.densities(problem, &next.smoothed_reaction),
            },
        }
    }
}

/// No force anywhere.
pub(crate) fn none<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Densities<D> {
    vec![[[0.0; D]; D]; problem.surface().facets().len()]
}

/// ∫F φ_k over all facets, for each node of the contact surface (N).
pub(crate) fn nodal_forces<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    densities: &Densities<D>,
) -> Vec<[f64; D]> {
    let mut forces = vec![[0.0; D]; problem.surface().nodes().len()];
    for (facet, density) in problem.surface().facets().iter().zip(densities) {
        let moments = Problem::<D, N>::facet_moments(facet.area, density);
        for (node, moment) in facet.nodes.iter().zip(moments) {
            (0..D).for_each(|c| forces[*node][c] += moment[c]);
        }
    }
    forces
}

/// Power of ∫[b(−w, F) + w·F] on a facet: μF_n‖w_t‖ + w_t·F_t (W). The normal part vanishes, for F
/// is zero unless both nodes stay on the plane, or [`normal_power`] has it. In 2D both factors are linear along the
/// edge.
pub(crate) fn misfit_power<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    facet: &ContactFacet<D>,
    density: &[[f64; D]; D],
    velocity: &[[f64; D]; D],
) -> f64 {
    let simplex = problem.mesh().simplex();
    match simplex.shape() {
        Shape::Bar => return 0.0,
        Shape::Triangle => {}
    }
    if density.iter().flatten().all(|f| *f == 0.0) {
        return 0.0;
    }
    let plane = &problem.obstacles()[facet.obstacle];
    let tangent = tangent(plane);
    let (normal, tangential) = (density.map(|f| plane.split(&f).0), density.map(|f| along(&f, &tangent)));
    let sliding = velocity.map(|v| along(&v, &tangent));
    let power = |weights: &[f64; D]| {
        let w = along(weights, &sliding);
        plane.friction() * along(weights, &normal) * w.abs() + w * along(weights, &tangential)
    };
    facet.area * simplex.facet_mean(&sliding, &power)
}

/// Along a plane in 2D: its normal turned back by a quarter.
fn tangent<const D: usize>(plane: &Plane<D>) -> [f64; D] {
    let mut tangent = [0.0; D];
    (tangent[0], tangent[1]) = (plane.normal()[1], -plane.normal()[0]);
    tangent
}

/// The component of a vector along a direction, or a value from those at the nodes with their weights.
fn along<const D: usize>(vector: &[f64; D], direction: &[f64; D]) -> f64 {
    vector.iter().zip(direction).map(|(a, b)| a * b).sum()
}

/// ∫F_n gap over a facet (J), both linear, the force in Pa.
pub(crate) fn gap_energy<const D: usize>(area: f64, force: &[f64; D], gap: &[f64; D]) -> f64 {
    let products: f64 = force.iter().zip(gap).map(|(f, g)| f * g).sum();
    area * (products + force.iter().sum::<f64>() * gap.iter().sum::<f64>()) / (D * (D + 1)) as f64
}

/// ∫F_n|w_n| over a facet (W), both linear, the force in Pa.
pub(crate) fn normal_power<const D: usize, const N: usize>(
    simplex: &dyn Simplex<D, N>,
    area: f64,
    force: &[f64; D],
    speed: &[f64; D],
) -> f64 {
    area * simplex.facet_mean(speed, &|weights| along(weights, force) * along(weights, speed).abs())
}

/// Checks that a step's densities are in the cone and, unless they may act `off_contact`, act only where both nodes
/// of a facet touch throughout the step.
pub(crate) fn check<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    now: &SurfaceStep<D>,
    next: &SurfaceStep<D>,
    interval: &Interval<D>,
    off_contact: bool,
    residuals: &mut Residuals,
) {
    for densities in [&interval.start, &interval.end] {
        let size = |f: &[f64; D]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
        let largest = densities.iter().flatten().map(size).fold(0.0, worse);
        if largest == 0.0 {
            continue;
        }
        for (facet, density) in problem.surface().facets().iter().zip(densities) {
            let plane = &problem.obstacles()[facet.obstacle];
            let touches = facet.nodes.iter().all(|&k| now.touching[k] && next.touching[k]);
            for f in density {
                let scale = size(f).max(1e-12 * largest);
                let (normal, tangential) = plane.split(f);
                let outside = worse(size(&tangential) - plane.friction() * normal, -normal);
                residuals.cone = worse(residuals.cone, outside / scale);
                let off = if touches || off_contact { 0.0 } else { size(f) / scale };
                residuals.force_off_contact = worse(residuals.force_off_contact, off);
            }
        }
    }
}

#[cfg(test)]
mod tests;
