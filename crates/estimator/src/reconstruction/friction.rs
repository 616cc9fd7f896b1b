//! The friction part of η of densities that are linear over a step.

use crate::contact_density::{Densities, FacetDensity, facet_power, trapezoids};
use crate::time_level::{ForcesKnown, MotionKnown};
use percute_core::problem::Problem;

/// On each candidate facet (J), up to the middle and the end of the step from `now` to `next`, of this length (s), with
/// this density at its end: the trapezoidal rule over its three half-step instants. Facets with a node at two planes
/// wait, see [`CornerSliding`](crate::contact_density::CornerSliding).
pub(super) fn friction<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    length: f64,
    now: &ForcesKnown<D>,
    next: &MotionKnown<D>,
    density: &Densities<D>,
) -> Vec<[f64; 2]> {
    let surface = problem.surface();
    let mut friction = Vec::with_capacity(surface.facets().len());
    for (f, facet) in surface.facets().iter().enumerate() {
        if surface.reaches_a_corner(facet) {
            friction.push([0.0; 2]);
            continue;
        }
        let [start, end] = [&now.density, density].map(|densities| FacetDensity {
            wide: &densities.wide()[f],
            hats: facet.nodes.map(|k| densities.hats_of(k)),
        });
        let power = |velocity: &[[f64; D]], densities: &[&FacetDensity<'_, D, D>]| {
            let velocity = facet.nodes.map(|k| surface.against_obstacle(k, velocity));
            facet_power(problem, f, &velocity, densities)
        };
        let (a, b) = (power(now.now.motion.velocity(), &[&start]), power(next.now.velocity(), &[&end]));
        let m = next.mid_velocity.as_ref().map_or(0.0, |velocity| power(velocity, &[&start, &end]));
        let so_far = now.friction[f][1];
        friction.push(trapezoids(length, [a, m, b]).map(|work| so_far + work));
    }
    friction
}
