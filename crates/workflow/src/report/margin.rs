//! How near a material is to yielding that has not yielded, and whether the run shows that it stays elastic.
//!
//! studies/elastic_margin.py compares the largest stress with that of finer meshes: see docs/verdict.md.

use super::linearity::element;
use super::touches::{FirstContact, Surface, Touches};
use crate::deformation::{Deformation, Extreme, MaterialStress};
use crate::message::{percent, short, trimmed};
use percute_core::contact::CORNER;
use percute_core::contact_results::ContactResults;
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Hypothesis;
use percute_core::problem::AnyProblem;
use percute_estimator::Estimate;
use serde::Serialize;
use std::f64::consts::PI;

/// The material that is nearest to yielding among those with a yield stress that have not yielded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ElasticMargin {
    /// Its group of elements; none if it is that of all.
    pub group: Option<String>,
    /// Its yield stress (Pa).
    pub yield_stress: f64,
    /// Its largest von Mises stress (Pa).
    pub von_mises: Extreme,
    /// This stress over the yield stress.
    pub stress_ratio: f64,
    /// The relative error that is expected of the stress: the largest relative error of the run, or that of the element
    /// if it is larger.
    pub error: f64,
    /// Whether a sharp corner is at this element, or strikes first: the stress there grows with each refinement.
    pub sharp_corner: bool,
    /// Whether the run shows that the material stays elastic: without a sharp corner, a stress below 1 − error of the
    /// yield stress.
    pub is_shown: bool,
    /// Whether the law has plasticity.
    #[serde(skip)]
    pub(super) plastic: bool,
}

impl ElasticMargin {
    pub(super) fn new(
        problem: &AnyProblem,
        deformation: &Deformation,
        estimate: &Estimate,
        results: &ContactResults,
    ) -> Option<Self> {
        let ratio = |material: &MaterialStress| material.yielding.as_ref().map_or(0.0, |found| found.stress_ratio);
        let elastic =
            |material: &&MaterialStress| material.yielding.as_ref().is_some_and(|found| found.first.is_none());
        let materials = deformation.materials.iter();
        let nearest = materials.filter(elastic).max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
        let (MaterialStress { group, von_mises, .. }, yielding) = (nearest, nearest.yielding.as_ref()?);
        let (stress_ratio, id) = (yielding.stress_ratio, ElementId::new(von_mises.element));
        let error = estimate.error.relative_sup.max(local_error(problem, estimate, von_mises));
        let sharp_corner =
            FirstContact::new(problem, results).touches == Touches::Corner || is_at_corner(problem, results, id);
        Some(Self {
            group: group.clone(),
            yield_stress: yielding.yield_stress,
            von_mises: von_mises.clone(),
            stress_ratio,
            error,
            sharp_corner,
            // An error that is no number shows nothing.
            is_shown: !sharp_corner && stress_ratio < 1.0 - error,
            plastic: yielding.plastic.is_some(),
        })
    }

    /// Whether the material may yield, by a law with plasticity.
    pub(super) fn may_flow(&self) -> bool {
        self.plastic && !self.is_shown
    }

    /// The stress over the yield stress, and what follows.
    pub(super) fn sentence(&self) -> String {
        let Self { von_mises: Extreme { element: at, centroid, time, .. }, stress_ratio, error, .. } = self;
        let of = self.group.as_ref().map_or_else(String::new, |group| format!(" of group {group:?}"));
        let subject = self.group.as_ref().map_or("the body", |_| "it");
        let margin = percent(1.0 - stress_ratio);
        let result = match (self.sharp_corner, self.is_shown) {
            (true, _) => format!(
                "the stress at a sharp corner grows with each refinement, so that the run does not show that {subject} \
                 stays elastic; round the corner"
            ),
            (false, true) => format!("the margin of {margin} is more than the error of {}", percent(*error)),
            (false, false) => format!(
                "the margin of {margin} is less than the error of {}, so that the run does not show that {subject} \
                 stays elastic; refine the mesh",
                percent(*error)
            ),
        };
        format!(
            "The von Mises stress{of} is at most {} of the yield stress of {} Pa, in {} at {} s: {result}.",
            percent(*stress_ratio),
            short(self.yield_stress, 3),
            element(*at, centroid),
            trimmed(*time, 4)
        )
    }
}

/// The error of an element over the root of the energy of shape change of its largest von Mises stress, V q²/(6G) (of a
/// bar V σ²/(2E)).
fn local_error(problem: &AnyProblem, estimate: &Estimate, largest: &Extreme) -> f64 {
    let element = ElementId::new(largest.element);
    let law = problem.material(element);
    let modulus = match law.hypothesis() {
        Hypothesis::Bar => 2.0 * law.young(),
        Hypothesis::PlaneStress | Hypothesis::PlaneStrain | Hypothesis::Solid => {
            3.0 * law.young() / (1.0 + law.poisson())
        }
    };
    let energy = problem.volume(element) * largest.value.powi(2) / modulus;
    let error = estimate.by_element.get(largest.element).copied().unwrap_or_default();
    if energy > 0.0 { error / energy.sqrt() } else { 0.0 }
}

/// Whether an element has a node at a re-entrant corner, or at another corner that touches.
pub(super) fn is_at_corner(problem: &AnyProblem, results: &ContactResults, element: ElementId) -> bool {
    let mesh = problem.mesh();
    if mesh.dimension() == 1 {
        return false;
    }
    let surface = Surface::new(problem, results);
    let mut sharp: Vec<NodeId> = mesh.corners_above(PI + CORNER);
    sharp.extend(surface.touched_corners());
    mesh.cell(element).iter().any(|node| sharp.contains(node))
}
