//! Bodies that spin farther than small rotations until the end of the run.

use super::{PlausibilityWarning, at, plausibility_warning};
use crate::message::short;
use crate::problem::{Problem, RigidMotion};
use crate::time::TimeGrid;

/// Rotations up to this (rad) are small. A straight path ωt in place of an arc makes a body larger by θ²/2, here
/// 1.3e-3: about as much as metals strain before they yield.
pub const SMALL_ROTATION: f64 = 0.05;

/// The body that turns most until the end by its initial spin, if that is too far. Supports may end a spin.
pub(super) fn plausibility_warnings<const D: usize>(
    problem: &Problem<D>,
    times: &TimeGrid,
) -> Option<PlausibilityWarning> {
    if problem.is_finite() {
        return None;
    }
    let (mesh, spins) =
        (problem.mesh(), RigidMotion::new(problem).rotations(problem.initial_velocity().as_flattened()));
    let of_node = mesh.part_numbers();
    let mut held = vec![false; spins.len()];
    problem.prescribed().iter().for_each(|prescribed| held[of_node[prescribed.node.index()]] = true);
    let free = spins.iter().enumerate().filter(|(body, _)| !held[*body]);
    let (body, spin) = free.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let (spin, angle) = (spin.abs(), spin.abs() * times.end());
    if angle <= SMALL_ROTATION {
        return None;
    }
    let subject = if spins.len() == 1 { "the body".to_string() } else { format!("{:?}", mesh.part_names()[body]) };
    let [rate, turned, end, latest] = [spin, angle, times.end(), SMALL_ROTATION / spin].map(short);
    let message = format!(
        "spins {subject} at {rate} rad/s, which is {turned} rad until the end at {end} s: nodes move along straight \
         lines, so that a body which turns by more than {SMALL_ROTATION} rad grows and touches where it could not; \
         start later in the motion, or end by {latest} s"
    );
    let brief = format!("{subject} spins by {turned} rad: too far for small rotations");
    Some(plausibility_warning(at("initial", None, "velocity"), "spin", brief, message))
}
