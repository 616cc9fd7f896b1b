//! How two bodies lie to each other, and how they meet if nothing else acts on them.

use super::outline::{Outline, Vector};
use crate::contact::CORNER;
use crate::problem::alignment::unit;

/// Bodies that are nearer than this part of the larger one touch, wherever the origin is.
const TOUCHES: f64 = 1e-12;
/// Smaller parts of a speed, and of a time, are rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// Two bodies that a straight line separates.
#[derive(Debug, PartialEq)]
pub(super) struct Approach {
    /// Unit normal from the first body to the second one along which they are furthest apart, and how far (m).
    pub(super) normal: Vector,
    pub(super) gap: f64,
    /// The normal where they meet, and when (s), if their velocities at the start bring them together.
    pub(super) meeting: Option<(Vector, f64)>,
}

/// The way of two convex hulls to each other, `None` if they overlap: two convex polygons touch as soon as the edges of
/// neither separate them.
pub(super) fn approach(first: &Outline, second: &Outline) -> Option<Approach> {
    let mut normals = outward(&first.hull);
    normals.extend(outward(&second.hull).into_iter().map(|n| n.map(|x| -x)));
    let gap = |n: &Vector| {
        let reach = first.hull.iter().map(|p| dot(p, n)).fold(f64::NEG_INFINITY, f64::max);
        second.hull.iter().map(|p| dot(p, n)).fold(f64::INFINITY, f64::min) - reach
    };
    let relative: Vector = std::array::from_fn(|c| second.velocity[c] - first.velocity[c]);
    let gaps: Vec<f64> = normals.iter().map(gap).collect();
    let widest = (0..gaps.len()).reduce(|a, b| if gaps[b] > gaps[a] { b } else { a })?;
    let tolerance = TOUCHES * first.size.max(second.size);
    if gaps[widest] < -tolerance {
        return None;
    }
    // Where a node of a curve meets one, two edges on either side are as far: the normal is midway between theirs.
    let midway = |at: usize| {
        let is_alike = |k: &usize| (gaps[*k] - gaps[at]).abs() <= ROUNDING * gaps[at].abs() + tolerance;
        let turns_little = |k: &usize| dot(&normals[*k], &normals[at]) > CORNER.cos();
        let alike = (0..gaps.len()).filter(is_alike).filter(turns_little).map(|k| normals[k]);
        unit(&alike.fold([0.0; 2], |sum: Vector, normal| [sum[0] + normal[0], sum[1] + normal[1]]))
    };
    if gaps[widest] <= tolerance {
        // They touch: whatever moves them, there is contact.
        return Some(Approach { normal: midway(widest), gap: 0.0, meeting: Some((midway(widest), 0.0)) });
    }
    let speed = relative[0].hypot(relative[1]);
    let (mut latest, mut parting) = ((f64::NEG_INFINITY, widest), f64::INFINITY);
    for (k, (normal, &gap)) in normals.iter().zip(&gaps).enumerate() {
        let closing = -dot(&relative, normal);
        let closing = if closing.abs() > ROUNDING * speed { closing } else { 0.0 };
        match gap > 0.0 {
            true => {
                let time = if closing > 0.0 { gap / closing } else { f64::INFINITY };
                // Of several at once, the one along which they are further apart.
                let [before, after] = [1.0 - ROUNDING, 1.0 + ROUNDING].map(|part| part * latest.0);
                if time > after || (time >= before && gap > gaps[latest.1]) {
                    latest = (time, k);
                }
            }
            false if closing < 0.0 => parting = parting.min(gap / closing),
            false => {}
        }
    }
    let (time, at) = latest;
    let meeting = (time.is_finite() && time < parting).then_some((midway(at), time));
    Some(Approach { normal: midway(widest), gap: gaps[widest], meeting })
}

/// Outward normals of the edges of a convex polygon.
fn outward(corners: &[Vector]) -> Vec<Vector> {
    let normal = |k: usize| {
        let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let length = x.hypot(y);
        [y / length, -x / length]
    };
    (0..corners.len()).map(normal).collect()
}

pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box with this lower left corner and side.
    fn square(corner: Vector, side: f64, velocity: Vector) -> Outline {
        let [x, y] = corner;
        let hull = vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
        Outline { name: String::new(), edges: Vec::new(), hull, velocity, size: side * 2.0_f64.sqrt(), passage: 1.0 }
    }

    /// Polygons of 18 sides, one above the other, meet with a node of each: their normal is that of neither side.
    #[test]
    fn nodes_of_curves_meet_along_the_line_between_them() {
        let disc = |height: f64, speed: f64| {
            let corner = |k: usize| (k as f64 * std::f64::consts::TAU / 18.0 + std::f64::consts::FRAC_PI_2).sin_cos();
            let hull = (0..18).map(corner).map(|(sin, cos)| [cos, sin + height]).collect();
            Outline { hull, velocity: [0.0, speed], ..square([0.0, 0.0], 1.0, [0.0, 0.0]) }
        };
        for (height, speed) in [(2.5, -1.0), (2.5, 0.0), (2.0, 0.0)] {
            let found = approach(&disc(0.0, 0.0), &disc(height, speed)).unwrap();
            assert_eq!(found.meeting.is_some(), speed != 0.0 || height == 2.0);
            for normal in [Some(found.normal), found.meeting.map(|(normal, _)| normal)].into_iter().flatten() {
                // Rounding of some sines.
                assert!(normal[0].abs() < 1e-14 && (normal[1] - 1.0).abs() < 1e-14, "{height}: {normal:?}");
            }
        }
    }

    #[test]
    fn boxes_meet_at_the_sides_that_close_last() {
        let fixed = square([0.0, 0.0], 1.0, [0.0, 0.0]);
        let found = |corner, velocity| approach(&fixed, &square(corner, 1.0, velocity)).unwrap();
        let above = found([0.0, 1.5], [0.5, -1.0]);
        assert_eq!((above.normal, above.gap, above.meeting), ([0.0, 1.0], 0.5, Some(([0.0, 1.0], 0.5))));
        // Aside and above: down in 0.5 s, across in 1 s, so that the vertical sides meet; and the other way round.
        assert_eq!(found([3.0, 1.5], [-2.0, -1.0]).meeting, Some(([1.0, 0.0], 1.0)));
        assert_eq!(found([3.0, 1.5], [-6.0, -1.0]).meeting, Some(([0.0, 1.0], 0.5)));
        // It has passed the other side before it is down.
        assert_eq!(found([3.0, 1.5], [-16.0, -1.0]).meeting, None);
        // Away, and at rest.
        assert_eq!(found([0.0, 1.5], [0.0, 1.0]).meeting, None);
        assert_eq!(found([0.0, 1.5], [0.0, 0.0]).meeting, None);
        // In contact, and inside.
        assert_eq!(found([0.0, 1.0], [0.0, 0.0]).meeting, Some(([0.0, 1.0], 0.0)));
        assert_eq!(approach(&fixed, &square([0.5, 0.5], 1.0, [0.0, 0.0])), None);
    }
}
