//! The friction part of η of densities that are linear over a step.

use crate::contact_density::{Densities, FaceDensity, NonMatchingDensity, NonMatchingFaces, face_power, trapezoids};
use crate::direction::along;
use crate::time_level::{ForcesKnown, MotionKnown};
use percute_core::contact::Side;
use percute_core::problem::Problem;
use std::sync::Arc;

/// On each candidate face (J), up to the middle and the end of the step from `now` to `next`, of this length (s), with
/// this density at its end: the trapezoidal rule over its three half-step instants. Faces with a node at two planes
/// wait, see [`CornerSliding`](crate::contact_density::CornerSliding), and those of non-matching interfaces have
/// [`add_non_matching`].
pub(super) fn friction<const D: usize>(
    problem: &Problem<D>,
    length: f64,
    now: &ForcesKnown<D>,
    next: &MotionKnown<D>,
    density: &Densities<D>,
) -> Vec<[f64; 2]> {
    let surface = problem.surface();
    let mut friction = Vec::with_capacity(surface.faces().len());
    for (f, face) in surface.faces().iter().enumerate() {
        if surface.reaches_a_corner(face) || surface.non_matching_of(face.nodes[0]).is_some() {
            friction.push([0.0; 2]);
            continue;
        }
        let [start, end] = [&now.density, density].map(|densities| FaceDensity {
            wide: &densities.wide()[f],
            hats: face.nodes.map(|k| densities.hats_of(k)),
        });
        let so_far = now.friction[f][1];
        if start.is_zero() && end.is_zero() {
            friction.push([so_far; 2]);
            continue;
        }
        let power = |velocity: &[[f64; D]], densities: &[&FaceDensity<'_, D, D>]| {
            let velocity = face.nodes.map(|k| surface.against_obstacle(k, velocity));
            face_power(problem, f, &velocity, densities)
        };
        let (a, b) = (power(now.now.motion.velocity(), &[&start]), power(next.now.velocity(), &[&end]));
        let m = next.mid_velocity.as_ref().map_or(0.0, |velocity| power(velocity, &[&start, &end]));
        friction.push(trapezoids(length, [a, m, b]).map(|work| so_far + work));
    }
    friction
}

/// Adds the same of non-matching interfaces: half of each piece on each of its faces.
pub(super) fn add_non_matching<const D: usize>(
    (problem, faces): (&Problem<D>, &[NonMatchingFaces]),
    length: f64,
    now: &ForcesKnown<D>,
    next: &MotionKnown<D>,
    density: &Densities<D>,
    friction: &mut [[f64; 2]],
) {
    let surface = problem.surface();
    let all =
        surface.non_matching().iter().zip(faces).zip(now.density.non_matching().iter().zip(density.non_matching()));
    for ((non_matching, faces), (start, end)) in all {
        if non_matching.law().friction() == 0.0 || (start.is_zero() && end.is_zero()) {
            continue;
        }
        let tangential = |field: &[[f64; D]], side: &Side| -> Vec<f64> {
            let node = |k: usize| surface.nodes()[side.position(k)].node.index();
            (0..side.len()).map(|k| along(&field[node(k)], non_matching.tangent())).collect()
        };
        let both =
            |field: &[[f64; D]]| [non_matching.slave(), non_matching.master()].map(|side| tangential(field, side));
        let [from, to] = [now.now.motion.velocity(), next.now.velocity()].map(both);
        let mut add = |density: &NonMatchingDensity<D>, slip: &[Vec<f64>; 2], parts: [f64; 2]| {
            density.friction_power(non_matching, slip, |piece, power| {
                for face in faces.of(piece) {
                    (0..2).for_each(|k| friction[face][k] += 0.5 * parts[k] * power);
                }
            });
        };
        // The weights of three powers in the integrals over the first half and all of the step.
        let [half, all] = [0.5 * length, length];
        add(start, &from, [half, 0.5 * all]);
        add(end, &to, [0.0, 0.5 * all]);
        if let Some(middle) = &next.mid_velocity {
            let slip = both(middle);
            let place = both(next.now.displacement());
            let quarter = 0.25 * length;
            let at_middle = |k: usize, node: usize| place[k][node] - quarter * (slip[k][node] + to[k][node]);
            let shifts = non_matching.shifts(|node| at_middle(0, node), |node| at_middle(1, node));
            let mean = NonMatchingDensity::mean(start, end, &Arc::new(non_matching.coupling_at(&shifts)));
            add(&mean, &slip, [half, all]);
        }
    }
}
