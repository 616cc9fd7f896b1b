//! The friction part of η of densities that are linear over a step.

use crate::contact_density::{Densities, hat_misfit_power, misfit_power};
use crate::time_level::{ForcesKnown, MotionKnown};
use percute_core::problem::Problem;

/// On each candidate facet (J), up to the middle and the end of the step from `now` to `next`, of this length (s), with
/// this density at its end: the trapezoidal rule over its three half-step instants.
pub(super) fn friction<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    length: f64,
    now: &ForcesKnown<D>,
    next: &MotionKnown<D>,
    density: &Densities<D>,
) -> Vec<[f64; 2]> {
    let mut friction = Vec::with_capacity(problem.surface().facets().len());
    for f in 0..problem.surface().facets().len() {
        let power = |velocity: &[[f64; D]], densities: &[&Densities<D>]| misfit(problem, f, velocity, densities);
        let (a, b) = (power(now.now.motion.velocity(), &[&now.density]), power(next.now.velocity(), &[density]));
        let m = next.mid_velocity.as_ref().map_or(0.0, |velocity| power(velocity, &[&now.density, density]));
        let so_far = now.friction[f][1];
        // 2∫[…], twice over half a step each.
        friction.push([so_far + 0.5 * length * (a + m), so_far + 0.5 * length * (a + 2.0 * m + b)]);
    }
    friction
}

/// The power of the mean of densities on a facet: hats keep their shapes.
fn misfit<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    f: usize,
    velocity: &[[f64; D]],
    densities: &[&Densities<D>],
) -> f64 {
    let (surface, share) = (problem.surface(), 1.0 / densities.len() as f64);
    let facet = &surface.facets()[f];
    let velocity = facet.nodes.map(|k| surface.against_obstacle(k, velocity));
    let mut mean = [[0.0; D]; D];
    let mut power = 0.0;
    for density in densities {
        let wide = &density.wide()[f];
        (0..D).for_each(|p| (0..D).for_each(|c| mean[p][c] += share * wide[p][c]));
        let hats = facet.nodes.iter().flat_map(|&k| density.hats_of(k)).filter(|hat| hat.facet == f);
        power += hats.map(|hat| share * hat_misfit_power(problem, hat, &velocity)).sum::<f64>();
    }
    surface.part_of_contact(facet.nodes[0]) * (power + misfit_power(problem, facet, &mean, &velocity))
}
