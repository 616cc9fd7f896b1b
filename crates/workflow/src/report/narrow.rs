//! Contact of a curve that is narrower than the elements there.

use super::touches::Surface;
use percute_core::contact::CORNER;
use percute_core::contact_results::ContactResults;
use percute_core::material::{Elastic, Hypothesis, Law};
use percute_core::problem::AnyProblem;
use std::f64::consts::PI;

/// So many edges within the half-width resolve a contact.
const EDGES: f64 = 2.0;

/// A contact whose width is less than the length of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NarrowContact {
    /// Half of its width at the averaged peak force (m), by Hertz: b² = 4F'/(πE*κ), with the force F' per length, the
    /// curvature κ of both surfaces together, and 1/E* the sum of (1 − ν²)/E.
    pub(super) half_width: f64,
    /// The longest edge at the nodes that touch first (m).
    pub(super) edge: f64,
    /// An edge that would resolve it (m).
    pub(super) needed: f64,
}

impl NarrowContact {
    /// None of contacts that are wider, of corners and of flat surfaces. Where several contacts share the force, each
    /// counts as if it had all: none is called narrow that is not.
    pub(super) fn new(problem: &AnyProblem, results: &ContactResults) -> Option<Self> {
        let force = results.averaged_peak.filter(|_| problem.dimension() == 2)?.force;
        let surface = Surface::new(problem, results);
        let planes = (0..problem.obstacle_count()).filter(|&k| problem.obstacle(k).is_plane());
        let interfaces = problem.sides_of_interfaces().into_iter().map(|sides| sides.to_vec());
        planes.map(|plane| vec![plane]).chain(interfaces).find_map(|sides| Self::of(&surface, &sides, force))
    }

    /// That of one contact, by the nodes that touch first on its sides, under a force (N).
    fn of(surface: &Surface<'_>, sides: &[usize], force: f64) -> Option<Self> {
        let (mut curvature, mut compliance, mut edge, mut thickness) = (0.0, 0.0, 0.0_f64, f64::INFINITY);
        for at in sides.iter().filter_map(|&side| surface.first_of(side)) {
            let (turn, (length, law)) = (surface.turn(at), surface.edges(at)?);
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

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::contact::Obstacle;
    use percute_core::contact_results::ContactRecorder;
    use percute_core::dynamics::{critical_time_step, simulate};
    use percute_core::history::History;
    use percute_core::mesh::Mesh;
    use percute_core::observer::Unobserved;
    use percute_core::problem::{Initial, Problem};
    use percute_core::time::TimeGrid;

    /// A disc of 10 mm that comes down on a plane at this speed (m/s), until the force is about largest.
    fn lands(rings: usize, speed: f64) -> Option<NarrowContact> {
        let mesh = Mesh::disc(0.01, rings).unwrap();
        let build = |gap: f64| {
            Problem::<2>::builder(mesh.clone())
                .material(Elastic::plane_strain(70e9, 0.3, 2700.0, 0.5).unwrap())
                .initial_velocity(Initial::Uniform([0.0, -speed]))
                .obstacle(Obstacle::plane([0.0, -0.01 - gap], [0.0, 1.0], 0.0, None).unwrap())
                .build()
                .map(AnyProblem::from)
                .unwrap()
        };
        let dt = 0.9 * critical_time_step(&build(1.0));
        let problem = build(1.3 * speed * dt);
        let steps = (2e-5 / dt).ceil() as usize;
        let times = TimeGrid::uniform(dt * steps as f64, steps).unwrap();
        let (mut history, mut contact) = (History::new(&times), ContactRecorder::new(&problem, &times));
        simulate(&problem, &times, &mut (&mut history, &mut contact), &mut Unobserved).unwrap();
        NarrowContact::new(&problem, &contact.finish())
    }

    /// A slow disc touches with one node; with edges as small as it says, the contact has several. A fast one is wider.
    #[test]
    fn a_slow_disc_touches_on_less_than_an_edge() {
        let found = lands(4, 0.2).unwrap();
        // The outline has 24 edges, each a chord of 15°.
        assert!((found.edge - 0.02 * (PI / 24.0).sin()).abs() < 1e-12, "{found:?}");
        assert!(2.0 * found.half_width < found.edge && found.needed == 0.5 * found.half_width);
        assert_eq!(lands(4, 60.0), None);
    }
}
