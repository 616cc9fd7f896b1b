//! A body that cannot touch before the end, does not move at all, or moves faster than waves.

use super::{PlausibilityWarning, at, plausibility_warning};
use crate::contact::{ContactNode, dot};
use crate::material::Law;
use crate::message::short;
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Values that differ by less, relatively, are the same but for rounding.
const SAME: f64 = 1e-9;
/// A plane so many times the size of the body away is more likely one in other units.
const FAR: f64 = 10.0;

pub(super) fn plausibility_warnings<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
) -> Vec<PlausibilityWarning> {
    let mut all: Vec<PlausibilityWarning> = [initial_speed(problem), at_rest(problem)].into_iter().flatten().collect();
    all.extend(support_speed(problem));
    all.extend(no_contact(problem));
    if all.iter().all(|plausibility_warning| plausibility_warning.name != "at_rest") {
        all.extend(no_touch(problem, times));
    }
    all
}

/// The slowest wave of all materials (m/s).
fn wave_speed<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    problem.materials().iter().map(|material| material.wave_speed()).fold(f64::INFINITY, f64::min)
}

fn too_fast(speed: f64, waves: f64) -> Option<(String, String)> {
    let (shown, waves) = (speed > waves).then(|| (short(speed), short(waves)))?;
    let millimetres = short(1e-3 * speed);
    let message = format!(
        "reaches {shown} m/s, faster than waves in the body ({waves} m/s), beyond small strains; speeds are in m/s: if \
         it is in mm/s, write {millimetres}"
    );
    Some((format!("a speed of {shown} m/s, above that of waves"), message))
}

fn initial_speed<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Option<PlausibilityWarning> {
    let speed = |v: &[f64; D]| dot(v, v).sqrt();
    let largest = problem.initial_velocity().iter().map(speed).fold(0.0, f64::max);
    let (brief, message) = too_fast(largest, wave_speed(problem))?;
    Some(plausibility_warning(at("initial", None, "velocity"), "supersonic", brief, message))
}

/// A body that moves against others, and for which no contact with any of them is stated.
fn no_contact<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Option<PlausibilityWarning> {
    if problem.mesh().parts() < 2 {
        return None;
    }
    let part = problem.mesh().part_of_nodes();
    let mut touches = vec![false; part.len()];
    let is_plane = |contact: &&ContactNode| problem.obstacles()[contact.obstacle].as_plane().is_some();
    for contact in problem.surface().nodes().iter().filter(|contact| !is_plane(contact)) {
        touches[part[contact.node.index()].index()] = true;
    }
    let velocity = problem.initial_velocity();
    let bodies: Vec<usize> = (0..part.len()).filter(|&node| node == part[node].index()).collect();
    let moves = |a: usize| bodies.iter().any(|&b| velocity[a] != velocity[b]);
    let alone = *bodies.iter().find(|&&a| !touches[a] && moves(a))?;
    let message = format!(
        "the body of node {alone} moves against others, but no contact with them is stated: it moves through them; \
         give the groups of edges that may touch"
    );
    Some(plausibility_warning(
        at("contact", None, ""),
        "no_contact_stated",
        "a body without contact with others",
        message,
    ))
}

fn support_speed<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Option<PlausibilityWarning> {
    let waves = wave_speed(problem);
    problem.statement().supports.iter().enumerate().find_map(|(index, support)| {
        let largest = support.velocity.as_ref()?.value().iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        let (brief, message) = too_fast(largest, waves)?;
        Some(plausibility_warning(at("support", Some(index), "velocity"), "supersonic", brief, message))
    })
}

/// Whether nothing will ever move: no velocity, no load, no moving support, and no strain that is released.
fn at_rest<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Option<PlausibilityWarning> {
    let still = |field: &[[f64; D]]| field.iter().flatten().all(|x| *x == 0.0);
    let moving = problem.motions().iter().any(|motion| motion.acting_components()[0]);
    if problem.is_loaded() || moving || !still(problem.initial_velocity()) || !still(problem.initial_displacement()) {
        return None;
    }
    let message = "nothing moves: there is no initial velocity, no load and no moving support; give the body a \
                   velocity (m/s), a load or a moving support";
    Some(plausibility_warning(at("initial", None, "velocity"), "at_rest", "nothing moves", message))
}

/// How a body moves that is not strained until it touches: velocity (m/s) and acceleration (m/s²).
struct Flight<const D: usize> {
    velocity: [f64; D],
    acceleration: [f64; D],
}

/// The flight of a body that nothing strains; `None` if that cannot be told beforehand.
fn flight<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Option<Flight<D>> {
    let velocity = uniform(problem.initial_velocity())?;
    uniform(problem.initial_displacement())?;
    let steady = |motion: &crate::load::Table<1>| motion.value().iter().all(|v| v == &motion.value()[0]);
    if !problem.facet_loads().is_empty() || !problem.motions().iter().all(steady) {
        return None;
    }
    if problem.body_loads().is_empty() {
        return Some(Flight { velocity, acceleration: [0.0; D] });
    }
    if !problem.prescribed().is_empty() || problem.body_loads().iter().any(|load| load.value.value().len() > 1) {
        return None;
    }
    let mut acceleration = vec![[0.0; D]; problem.mesh().node_count()];
    for load in problem.body_loads() {
        let force = load.value.at(0.0);
        for &(node, volume) in &load.nodal_volume {
            for c in 0..D {
                acceleration[node.index()][c] += force[c] * volume / problem.mass()[node.index()];
            }
        }
    }
    Some(Flight { velocity, acceleration: uniform(&acceleration)? })
}

/// The value of a field that is the same everywhere.
fn uniform<const D: usize>(field: &[[f64; D]]) -> Option<[f64; D]> {
    let first = *field.first()?;
    let largest = field.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    let same = |value: &[f64; D]| value.iter().zip(&first).all(|(a, b)| (a - b).abs() <= SAME * largest);
    field.iter().all(same).then_some(first)
}

/// The nearest candidate node of a plane, and when it will touch.
struct Approach {
    obstacle: usize,
    /// The smallest gap (m).
    gap: f64,
    /// Speed towards the plane (m/s).
    speed: f64,
    /// When the gap closes (s), infinite if it never does.
    time: f64,
}

/// A body in flight that reaches no plane before the end, or whose plane is very far. Its motion
/// after a first touch is not predicted.
fn no_touch<const D: usize, const N: usize>(problem: &Problem<D, N>, times: &TimeGrid) -> Option<PlausibilityWarning> {
    let flight = flight(problem)?;
    let approach = |obstacle: usize| {
        let (at, gap) = problem.nearest(obstacle)?;
        let node = problem.surface().nodes()[at].node.index();
        let frame = problem.surface().frame(at, &problem.initial_displacement()[node]);
        let (speed, push) = (-dot(&flight.velocity, frame.normal()), -dot(&flight.acceleration, frame.normal()));
        // A gap within rounding is closed.
        let gap = if gap <= problem.contact_tolerance() { 0.0 } else { gap };
        Some(Approach { obstacle, gap, speed, time: closing_time(gap, speed, push) })
    };
    let first = (0..problem.obstacles().len()).filter_map(approach).min_by(|a, b| a.time.total_cmp(&b.time))?;
    if first.time > times.end() { never(&first, times.end()) } else { far(&first, problem.mesh().size()) }
}

/// When gap − speed t − push t²/2 becomes 0 (s).
fn closing_time(gap: f64, speed: f64, push: f64) -> f64 {
    if gap == 0.0 {
        // On the plane: it is pressed against it, or leaves it and may fall back.
        let pressed = speed > 0.0 || (speed == 0.0 && push > 0.0);
        return if pressed {
            0.0
        } else if push > 0.0 {
            -2.0 * speed / push
        } else {
            f64::INFINITY
        };
    }
    let root = speed + (speed * speed + 2.0 * push * gap).sqrt();
    // NaN, where there is no root, is not above 0 either.
    if root > 0.0 { 2.0 * gap / root } else { f64::INFINITY }
}

fn never(first: &Approach, end: f64) -> Option<PlausibilityWarning> {
    let Approach { obstacle, gap, speed, time } = *first;
    let (gap, towards, end) = (short(gap), short(speed), short(end));
    if time.is_finite() {
        let when = short(time);
        let message = format!(
            "the gap of {gap} m closes after {when} s (the body starts at {towards} m/s towards the plane), but the \
             run ends at {end} s: use a later `end`, start nearer, or check the units of gap and velocity"
        );
        let brief = format!("no contact before {when} s");
        return Some(plausibility_warning(at("obstacle", Some(obstacle), "point"), "never_touches", brief, message));
    }
    let away = short(-speed);
    let message = if speed < 0.0 {
        format!("moves the body away from the plane at {away} m/s, so the body never touches: is the sign correct?")
    } else {
        format!(
            "does not move the body towards the plane, {gap} m away: it never touches; give it a velocity towards the \
             plane"
        )
    };
    Some(plausibility_warning(
        at("initial", None, "velocity"),
        "never_touches",
        "the body never touches the plane",
        message,
    ))
}

fn far(first: &Approach, size: f64) -> Option<PlausibilityWarning> {
    let Approach { obstacle, gap, time, .. } = *first;
    if gap <= FAR * size {
        return None;
    }
    let (gap, size, time) = (short(gap), short(size), short(time));
    let message = format!(
        "the plane is {gap} m away from a body of {size} m, which takes {time} s to reach it: is the point in metres? \
         Start nearer to save the steps before contact"
    );
    Some(plausibility_warning(
        at("obstacle", Some(obstacle), "point"),
        "far_plane",
        format!("a gap of {gap} m"),
        message,
    ))
}

#[cfg(test)]
mod tests {
    use super::closing_time;

    #[test]
    fn a_gap_closes_by_speed_and_by_push() {
        assert_eq!(closing_time(6.0, 3.0, 0.0), 2.0);
        assert_eq!(closing_time(8.0, 0.0, 4.0), 2.0);
        // Up first, and back: 2 + 2 t − 2 t² = 0 at (1 + √5)/2.
        assert!((closing_time(2.0, -2.0, 4.0) - 0.5 * (1.0 + 5.0_f64.sqrt())).abs() < 1e-15);
        // At rest on the plane under its weight; thrown up from it, back after 2 v/g; sliding along it without weight.
        assert_eq!([closing_time(0.0, 0.0, 4.0), closing_time(0.0, -6.0, 4.0)], [0.0, 3.0]);
        assert_eq!(closing_time(0.0, 0.0, 0.0), f64::INFINITY);
        assert_eq!(closing_time(1.0, -3.0, 0.0), f64::INFINITY);
        assert_eq!(closing_time(1.0, 0.0, 0.0), f64::INFINITY);
        // Thrown up to the plane, and back before it gets there.
        assert_eq!(closing_time(1.0, 1.0, -4.0), f64::INFINITY);
    }
}
