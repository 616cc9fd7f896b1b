//! Two surfaces that lean together, so that one normal does not stand for both.

use super::{PlausibilityWarning, at, plausibility_warning};
use crate::message::short;
use crate::problem::Problem;

/// Surfaces that lean by more than this (degrees) face each other along another direction than their common normal.
/// Between chevrons of aluminium of 5, 15 and 30°, without friction, the motion differs by 2, 9 and 24 % from that with
/// a contact for each slope.
pub const MOST_COMMON_SLOPE: f64 = 10.0;

pub(super) fn plausibility_warnings<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
) -> Option<PlausibilityWarning> {
    let (sliding, slope) = problem.surface().common_slope()?;
    let slope = Some(slope.to_degrees()).filter(|slope| *slope > MOST_COMMON_SLOPE)?;
    let names = [sliding.slave(), sliding.master()].map(|side| {
        let contact = &problem.surface().nodes()[side.position(0)];
        problem.obstacles()[contact.obstacle].group().unwrap_or_default().to_string()
    });
    let message = format!(
        "the surfaces \"{}\" and \"{}\" lean together by up to {}° from their common normal, along which contact \
         forces act; give each slope a contact with groups of its own, without the edges between the slopes",
        names[0],
        names[1],
        short(slope)
    );
    Some(plausibility_warning(at("contact", None, ""), "two_slopes", "surfaces that lean together", message))
}
