//! Contact of a curve that is narrower than the elements there.

use super::touches::Surface;
use percute_core::contact::{CORNER, ContactResults};
use percute_core::material::{Elastic, Hypothesis, Law};
use percute_core::problem::Problem;
use std::f64::consts::PI;

/// So many edges within the half-width resolve a contact.
const EDGES: f64 = 2.0;

/// A contact whose width is less than the length of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report) struct NarrowContact {
    /// Half of its width at the averaged peak force (m), by Hertz: b² = 4F'/(πE*κ), with the force F' per length, the
    /// curvature κ of both surfaces together, and 1/E* the sum of (1 − ν²)/E.
    pub(in crate::report) half_width: f64,
    /// The longest edge at the nodes that touch first (m).
    pub(in crate::report) edge: f64,
    /// An edge that would resolve it (m).
    pub(in crate::report) needed: f64,
}

impl NarrowContact {
    /// None of a contact that is wider, of corners and flat surfaces, and of several contacts, which share the force.
    pub(in crate::report) fn new<const D: usize, const N: usize>(
        problem: &Problem<D, N>,
        results: &ContactResults<D>,
    ) -> Option<Self> {
        let planes = problem.obstacles().iter().filter(|obstacle| obstacle.as_plane().is_some()).count();
        let force = results.averaged_peak.filter(|_| D == 2)?.force;
        if planes + problem.statement().interfaces.len() != 1 {
            return None;
        }
        let surface = Surface::new(problem, results);
        let (mut curvature, mut compliance, mut edge, mut thickness) = (0.0, 0.0, 0.0_f64, f64::INFINITY);
        for obstacle in 0..problem.obstacles().len() {
            let Some(at) = surface.first_of(obstacle) else { continue };
            let turn = surface.turn(at);
            let (length, law) = surface.edges(at)?;
            if turn > CORNER {
                return None;
            }
            curvature += turn.max(0.0) / length;
            compliance += plane_compliance(law);
            edge = edge.max(length);
            thickness = thickness.min(law.extent());
        }
        let half_width = (4.0 * force / thickness * compliance / (PI * curvature)).sqrt();
        let is_narrow = curvature > 0.0 && 2.0 * half_width < edge;
        is_narrow.then_some(Self { half_width, edge, needed: half_width / EDGES })
    }
}

/// (1 − ν²)/E in plane strain, 1/E in plane stress (1/Pa).
fn plane_compliance(law: &Elastic) -> f64 {
    match law.hypothesis() {
        Hypothesis::PlaneStrain => (1.0 - law.poisson().powi(2)) / law.young(),
        _ => 1.0 / law.young(),
    }
}
