//! How two bodies lie to each other, and how they meet if nothing else acts on them.

use super::outline::{Outline, PlaneVector};
use crate::contact::CORNER;
use crate::problem::alignment::unit;

/// Bodies that are nearer than this part of the larger one touch.
const TOUCHES: f64 = 1e-12;
/// Smaller parts of a speed, and of a time, are rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// Two bodies that a straight line separates.
#[derive(Debug, PartialEq)]
pub(super) struct Approach {
    /// Unit normal from the first body to the second one along which they are furthest apart, and how far (m).
    pub(super) normal: PlaneVector,
    pub(super) gap: f64,
    /// The normal where they meet, and when (s), if their velocities at the start bring them together.
    pub(super) meeting: Option<(PlaneVector, f64)>,
    /// Of halves, the direction across which their line of symmetry stands.
    pub(super) across: Option<usize>,
}

/// The way of two convex hulls to each other, `None` if they overlap: two convex polygons touch as soon as the edges of
/// neither separate them. Halves of a symmetric model meet along its line of symmetry: of all directions, the hulls of
/// the whole bodies are furthest apart along it.
pub(super) fn approach(first: &Outline, second: &Outline) -> Option<Approach> {
    let all = Directions::new(first, second);
    let Directions { normals, across, tolerance, relative, .. } = &all;
    let (across, tolerance) = (*across, *tolerance);
    let gaps: Vec<f64> = normals.iter().map(|n| all.gap(n)).collect();
    let widest = (0..gaps.len()).reduce(|a, b| if gaps[b] > gaps[a] { b } else { a })?;
    if gaps[widest] < -tolerance {
        return None;
    }
    let normal = all.normal_of(widest, 0.0);
    if gaps[widest] <= tolerance {
        // They touch: whatever moves them, there is contact.
        return Some(Approach { normal, gap: 0.0, meeting: Some((normal, 0.0)), across });
    }
    let speed = relative[0].hypot(relative[1]);
    let (mut latest, mut parting) = ((f64::NEG_INFINITY, widest), f64::INFINITY);
    for (k, (normal, &gap)) in normals.iter().zip(&gaps).enumerate() {
        let closing = -dot(relative, normal);
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
    let (last, at) = latest;
    let meeting = (last.is_finite() && last < parting).then(|| (all.normal_of(at, last), last));
    Some(Approach { normal, gap: gaps[widest], meeting, across })
}

/// The directions from one body to another one along which they may be apart.
struct Directions<'o> {
    bodies: [&'o Outline; 2],
    /// Those of the edges of the first body, then those of the second.
    normals: Vec<PlaneVector>,
    /// How many the first body has.
    edges: usize,
    /// Of halves, the direction across which their line of symmetry stands.
    across: Option<usize>,
    /// Velocity of the second body against the first one (m/s).
    relative: PlaneVector,
    /// Shorter lengths are rounding (m).
    tolerance: f64,
}

impl<'o> Directions<'o> {
    fn new(first: &'o Outline, second: &'o Outline) -> Self {
        let across = first.line_with(second);
        let own = match across {
            Some(0) => vec![[0.0, 1.0], [0.0, -1.0]],
            Some(_) => vec![[1.0, 0.0], [-1.0, 0.0]],
            None => outward(&first.hull),
        };
        let other = if across.is_none() { outward(&second.hull) } else { Vec::new() };
        let (edges, mut normals) = (own.len(), own);
        normals.extend(other.into_iter().map(|n| n.map(|x| -x)));
        let farthest = first.hull.iter().chain(&second.hull).flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        Self {
            bodies: [first, second],
            normals,
            edges,
            across,
            relative: std::array::from_fn(|c| second.velocity[c] - first.velocity[c]),
            tolerance: TOUCHES * first.size.max(second.size) + 4.0 * f64::EPSILON * farthest,
        }
    }

    /// How far the bodies are apart along a direction (m).
    fn gap(&self, n: &PlaneVector) -> f64 {
        let [first, second] = self.bodies.map(|body| body.hull.iter().map(|p| dot(p, n)));
        second.fold(f64::INFINITY, f64::min) - first.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The direction of an edge where the other body faces it, after some time (s).
    fn normal_of(&self, k: usize, time: f64) -> PlaneVector {
        if self.across.is_some() {
            return self.normals[k];
        }
        let [first, second] = self.bodies;
        let is_of_first = k < self.edges;
        let (edge, [own, other]) = if is_of_first { (k, [first, second]) } else { (k - self.edges, [second, first]) };
        let sign = if is_of_first { 1.0 } else { -1.0 };
        let places = other.hull.iter().map(|p| std::array::from_fn(|c| p[c] + sign * time * self.relative[c]));
        let places: Vec<PlaneVector> = places.collect();
        let reach = |p: &PlaneVector| sign * dot(p, &self.normals[k]);
        let least = places.iter().map(reach).fold(f64::INFINITY, f64::min);
        let nearest: Vec<PlaneVector> = places.into_iter().filter(|p| reach(p) <= least + self.tolerance).collect();
        normal_at(&own.hull, edge, &nearest).map(|x| sign * x)
    }
}

/// Nearer to a node than this part of an edge, curves meet there. With a quarter, normals of polygons that strike each
/// other in any position would be 0.037 rad off the line of their centres, in the mean, instead of 0.029.
const AT_NODE: f64 = 0.05;

/// The outward normal on an edge of a convex polygon where these places face it. At a node at which it turns by less
/// than a corner, as a curve, it is midway between both edges; elsewhere it is that of the edge. With a direction in
/// between, one more edge on one side than on the other would be within 60° of it, and their mean is the normal.
fn normal_at(polygon: &[PlaneVector], edge: usize, places: &[PlaneVector]) -> PlaneVector {
    let (normals, count) = (outward(polygon), polygon.len());
    let [start, end] = [polygon[edge], polygon[(edge + 1) % count]];
    let along = [end[0] - start[0], end[1] - start[1]];
    let part = |place: &PlaneVector| {
        let part = dot(&[place[0] - start[0], place[1] - start[1]], &along) / dot(&along, &along);
        part.clamp(0.0, 1.0)
    };
    let part = places.iter().map(part).sum::<f64>() / places.len() as f64;
    let beside = match part {
        _ if part < AT_NODE => edge + count - 1,
        _ if part > 1.0 - AT_NODE => edge + 1,
        _ => edge,
    };
    let (own, other) = (&normals[edge], &normals[beside % count]);
    if dot(own, other) > CORNER.cos() { unit(&[own[0] + other[0], own[1] + other[1]]) } else { *own }
}

/// Outward normals of the edges of a convex polygon.
fn outward(corners: &[PlaneVector]) -> Vec<PlaneVector> {
    let normal = |k: usize| {
        let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let length = x.hypot(y);
        [y / length, -x / length]
    };
    (0..corners.len()).map(normal).collect()
}

pub(super) fn dot(a: &PlaneVector, b: &PlaneVector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::symmetry::{LineMotion, SymmetryLine};

    /// A box with this lower left corner and side.
    fn square(corner: PlaneVector, side: f64, velocity: PlaneVector) -> Outline {
        let [x, y] = corner;
        let hull = vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
        let (name, size) = (String::new(), side * 2.0_f64.sqrt());
        Outline { name, edges: Vec::new(), hull, lines: Vec::new(), velocity, size, passage: 1.0 }
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

    /// Polygons of 36 and 42 sides meet node on node: a little speed aside does not turn their normal.
    #[test]
    fn normals_of_curves_do_not_jump() {
        let disc = |sides: u32, height: f64, turn: f64, velocity: PlaneVector| {
            let corner = |k: u32| (f64::from(k) * std::f64::consts::TAU / f64::from(sides) + turn).sin_cos();
            let hull = (0..sides).map(corner).map(|(sin, cos)| [cos, sin + height]).collect();
            Outline { hull, ..square([0.0, 0.0], 1.0, velocity) }
        };
        let up = std::f64::consts::FRAC_PI_2;
        for aside in [0.0, 1e-9, 1e-6, 1e-3, 1.0, 5.0] {
            let pair = [disc(36, 0.0, up, [0.0; 2]), disc(42, 2.01, -up, [aside, -10.0])];
            let (normal, time) = approach(&pair[0], &pair[1]).unwrap().meeting.unwrap();
            // They meet after a millisecond, at most 5 mm beside the nodes of edges of 0.15 and 0.17 m.
            assert!((time - 1e-3).abs() < 1e-4 && normal[0].abs() < 1e-14, "{aside}: {normal:?}");
        }
    }

    /// Two slopes beside a line of symmetry meet along it, unless they are on different sides of it or on other lines.
    #[test]
    fn halves_meet_along_their_line() {
        let line = |across: usize, place: f64| SymmetryLine { across, place, motion: LineMotion::Uniform(0.0) };
        let halves = |at: f64, lines: [Vec<SymmetryLine>; 2]| {
            let [of_first, own] = lines;
            let hull = vec![[at, 0.0], [at + 1.0, 0.0], [at + 1.0, 0.5], [at, 1.0]];
            let fixed = Outline { hull, lines: of_first, ..square([0.0, 0.0], 1.0, [0.0, 0.0]) };
            let hull = vec![[0.0, 1.5], [1.0, 2.0], [0.0, 2.5]];
            let slope = Outline { hull, lines: own, ..square([0.0, 0.0], 1.0, [0.0, -1.0]) };
            let found = approach(&fixed, &slope).unwrap();
            (found.normal, found.meeting)
        };
        let along = ([0.0, 1.0], Some(([0.0, 1.0], 0.5)));
        assert_eq!(halves(0.0, [vec![line(0, 0.0)], vec![line(0, 0.0)]]), along);
        // Beside rounding.
        assert_eq!(halves(1e-16, [vec![line(0, 1e-16)], vec![line(0, 0.0)]]), along);
        let whole = |at: f64| halves(at, [vec![], vec![]]);
        assert_ne!(whole(0.0).0, along.0);
        assert_eq!(halves(-1.0, [vec![line(0, 0.0)], vec![line(0, 0.0)]]), whole(-1.0));
        assert_eq!(halves(0.0, [vec![line(0, 1.0)], vec![line(0, 0.0)]]), whole(0.0));
        assert_eq!(halves(0.0, [vec![line(0, 0.0), line(1, 0.0)], vec![line(0, 0.0), line(1, 0.0)]]), whole(0.0));
    }

    /// After an oblique way nodes meet in the same direction, although other gaps are between them at the start.
    #[test]
    fn nodes_of_curves_meet_at_any_speed() {
        let disc = |at: PlaneVector, velocity: PlaneVector| {
            let corner = |k: usize| (k as f64 * std::f64::consts::TAU / 18.0 + std::f64::consts::FRAC_PI_2).sin_cos();
            let hull = (0..18).map(corner).map(|(sin, cos)| [cos + at[0], sin + at[1]]).collect();
            Outline { hull, ..square([0.0, 0.0], 1.0, velocity) }
        };
        let (normal, time) =
            approach(&disc([0.0; 2], [0.0; 2]), &disc([0.5, 2.1], [-5.0, -1.0])).unwrap().meeting.unwrap();
        // Rounding of a time of 0.1 s.
        assert!((time - 0.1).abs() < 1e-14 && normal[0].abs() < 1e-13, "{time}, {normal:?}");
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
