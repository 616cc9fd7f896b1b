//! The friction part of η of densities that are linear over a step.

use crate::contact_density::{Densities, misfit_power};
use crate::kinematic::NodalMotion;
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
    for (f, facet) in problem.surface().facets().iter().enumerate() {
        let (start, end) = (&now.density[f], &density[f]);
        let mut middle = *start;
        (0..D).for_each(|p| (0..D).for_each(|c| middle[p][c] = 0.5 * (start[p][c] + end[p][c])));
        let power = |motion: &NodalMotion<D>, density| {
            let velocity = facet.nodes.map(|k| motion.velocity()[problem.surface().nodes()[k].node.index()]);
            misfit_power(problem, facet, density, &velocity)
        };
        let (a, b) = (power(&now.now.motion, start), power(&next.now, end));
        let m = next.mid.as_ref().map_or(0.0, |mid| power(mid, &middle));
        let so_far = now.friction[f][1];
        // 2∫[…], twice over half a step each.
        friction.push([so_far + 0.5 * length * (a + m), so_far + 0.5 * length * (a + 2.0 * m + b)]);
    }
    friction
}
