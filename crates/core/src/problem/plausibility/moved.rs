//! Planes that were moved away from the bodies.

use super::{PlausibilityWarning, at, plausibility_warning};
use crate::message::short;
use crate::problem::{MovedPlane, Problem};

pub(super) fn plausibility_warnings<const D: usize>(
    problem: &Problem<D>,
) -> impl Iterator<Item = PlausibilityWarning> + '_ {
    problem.moved_planes().iter().map(|&MovedPlane { plane, distance, speed, step }| {
        let [distance, speed, step] = [distance, speed, step].map(short);
        let brief = format!("plane {plane} moved back by {distance} m, the least gap");
        let message = format!(
            "plane {plane} was moved back along its normal by {distance} m: the body starts on it and moves into it at \
             {speed} m/s, and this is the least gap in which a node can come to rest in a step of {step} s"
        );
        plausibility_warning(at("obstacle", Some(plane), "point"), "moved_plane", brief, message)
    })
}
