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

pub(super) fn plausibility_warnings<const D: usize>(
    problem: &Problem<D>,
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
fn wave_speed<const D: usize>(problem: &Problem<D>) -> f64 {
    problem.materials().iter().map(|material| material.wave_speed()).fold(f64::INFINITY, f64::min)
}

fn too_fast(speed: f64, wave_speed: f64) -> Option<(String, String)> {
    let (shown, waves) = (speed > wave_speed).then(|| (short(speed), short(wave_speed)))?;
    let mut message = format!(
        "reaches {shown} m/s, faster than waves in the body ({waves} m/s), beyond small strains; speeds are in m/s"
    );
    // Without this a speed is more likely a slip than one in mm/s; it may have no number, either.
    if 1e-3 * speed <= wave_speed {
        message += &format!(": if it is in mm/s, write {}", short(1e-3 * speed));
    }
    Some((format!("a speed of {shown} m/s, above that of waves"), message))
}

fn initial_speed<const D: usize>(problem: &Problem<D>) -> Option<PlausibilityWarning> {
    let speed = |v: &[f64; D]| dot(v, v).sqrt();
    let largest = problem.initial_velocity().iter().map(speed).fold(0.0, f64::max);
    let (brief, message) = too_fast(largest, wave_speed(problem))?;
    Some(plausibility_warning(at("initial", None, "velocity"), "supersonic", brief, message))
}

/// A body that moves against others, and for which no contact with any of them is stated.
fn no_contact<const D: usize>(problem: &Problem<D>) -> Option<PlausibilityWarning> {
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
        "the body of node {alone} moves against others, but no contact with them is stated or found: the run ends with \
         an error where it enters one; give the groups of edges that may touch"
    );
    Some(plausibility_warning(
        at("contact", None, ""),
        "no_contact_defined",
        "a body without contact with others",
        message,
    ))
}

fn support_speed<const D: usize>(problem: &Problem<D>) -> Option<PlausibilityWarning> {
    let waves = wave_speed(problem);
    problem.conditions().supports.iter().enumerate().find_map(|(index, support)| {
        let largest = support.velocity.as_ref()?.value().iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        let (brief, message) = too_fast(largest, waves)?;
        Some(plausibility_warning(at("support", Some(index), "velocity"), "supersonic", brief, message))
    })
}

/// Whether nothing will ever move: no velocity, no load, no moving support, and no strain that is released.
fn at_rest<const D: usize>(problem: &Problem<D>) -> Option<PlausibilityWarning> {
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

/// The flight of each body, if nothing strains them; `None` if that cannot be told beforehand.
fn flights<const D: usize>(problem: &Problem<D>, bodies: &SeparateBodies) -> Option<Vec<Flight<D>>> {
    let velocity = bodies.uniform(problem.initial_velocity())?;
    bodies.uniform(problem.initial_displacement())?;
    let steady = |motion: &crate::load::Table| motion.value().iter().all(|v| v == &motion.value()[0]);
    if !problem.face_loads().is_empty() || !problem.motions().iter().all(steady) {
        return None;
    }
    let mut acceleration = vec![[0.0; D]; problem.mesh().node_count()];
    if !problem.body_loads().is_empty()
        && (!problem.prescribed().is_empty() || problem.body_loads().iter().any(|load| load.value.value().len() > 1))
    {
        return None;
    }
    for load in problem.body_loads() {
        let force = load.value.at(0.0);
        for &(node, volume) in &load.nodal_volume {
            for c in 0..D {
                acceleration[node.index()][c] += force[c] * volume / problem.mass()[node.index()];
            }
        }
    }
    let flight = |(velocity, acceleration)| Flight { velocity, acceleration };
    Some(velocity.into_iter().zip(bodies.uniform(&acceleration)?).map(flight).collect())
}

/// The separate bodies of a mesh.
struct SeparateBodies {
    /// The body of each node, and the nodes of each body.
    of_node: Vec<usize>,
    nodes: Vec<Vec<usize>>,
}

impl SeparateBodies {
    fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let mesh = problem.mesh();
        let of_node = if mesh.parts() == 1 { vec![0; mesh.node_count()] } else { mesh.part_numbers() };
        let mut nodes = vec![Vec::new(); mesh.parts()];
        of_node.iter().enumerate().for_each(|(node, &body)| nodes[body].push(node));
        Self { of_node, nodes }
    }

    /// The values of a field that is the same all over each body.
    fn uniform<const D: usize>(&self, field: &[[f64; D]]) -> Option<Vec<[f64; D]>> {
        let largest = field.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let same = |a: &[f64; D], b: &[f64; D]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * largest);
        let of_body = |nodes: &Vec<usize>| {
            let first = field[*nodes.first()?];
            nodes.iter().all(|&node| same(&field[node], &first)).then_some(first)
        };
        self.nodes.iter().map(of_body).collect()
    }

    /// Diagonal of the largest bounding box of a body (m).
    fn largest<const D: usize>(&self, points: &[[f64; D]]) -> f64 {
        let extent = |nodes: &Vec<usize>, c: usize| {
            let ends = |[low, high]: [f64; 2], &node: &usize| [low.min(points[node][c]), high.max(points[node][c])];
            let [low, high] = nodes.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends);
            high - low
        };
        let diagonal = |nodes| (0..D).map(|c| extent(nodes, c).powi(2)).sum::<f64>().sqrt();
        self.nodes.iter().map(diagonal).fold(0.0, f64::max)
    }
}

/// The nearest candidate node of a plane or of another body, and when it will touch.
struct Encounter {
    obstacle: usize,
    /// "plane", or "other body".
    what: &'static str,
    /// The smallest gap (m).
    gap: f64,
    /// Speed towards the obstacle (m/s).
    speed: f64,
    /// When the gap closes (s), infinite if it never does.
    time: f64,
}

/// Bodies in flight that reach no plane and no other body before the end, or the first of them from very far. Their
/// motion after a first touch is not predicted, nor where surfaces face each other that do not do so at the start.
fn no_touch<const D: usize>(problem: &Problem<D>, times: &TimeGrid) -> Option<PlausibilityWarning> {
    let bodies = SeparateBodies::new(problem);
    let flights = flights(problem, &bodies)?;
    let on = |obstacle: usize| {
        let nodes = problem.surface().nodes().iter().filter(move |contact| contact.obstacle == obstacle);
        nodes.map(|contact| bodies.of_node[contact.node.index()])
    };
    let flight = |obstacle: usize| Some(&flights[on(obstacle).next()?]);
    let several = |obstacle: usize| on(obstacle).any(|body| Some(body) != on(obstacle).next());
    let approach = |leading: usize| {
        let obstacle = problem.slave_of(leading);
        let (at, gap) = problem.nearest(obstacle)?;
        let node = problem.surface().nodes()[at].node.index();
        let normal = *problem.obstacles()[obstacle].flat_frame().normal();
        let partner = problem.partner_obstacle(obstacle);
        // Of several bodies on one side, the nearest is not the first to touch.
        if partner.is_some_and(|partner| several(obstacle) || several(partner)) {
            return None;
        }
        let (own, other) = (&flights[bodies.of_node[node]], partner.and_then(flight));
        let towards =
            |of: fn(&Flight<D>) -> &[f64; D]| other.map_or(0.0, |o| dot(of(o), &normal)) - dot(of(own), &normal);
        let (speed, push) = (towards(|flight| &flight.velocity), towards(|flight| &flight.acceleration));
        // A gap within rounding is closed.
        let gap = if gap <= problem.contact_tolerance() { 0.0 } else { gap };
        let what = if partner.is_some() { "other body" } else { "plane" };
        Some(Encounter { obstacle, what, gap, speed, time: closing_time(gap, speed, push) })
    };
    let leading = (0..problem.obstacles().len()).filter(|&obstacle| problem.leads_interface(obstacle));
    let (interfaces, planes): (Vec<usize>, Vec<usize>) =
        leading.partition(|&obstacle| problem.partner_obstacle(obstacle).is_some());
    let mut approaches = interfaces.into_iter().map(approach).collect::<Option<Vec<_>>>()?;
    approaches.extend(planes.into_iter().filter_map(approach));
    let first = approaches.into_iter().min_by(|a, b| a.time.total_cmp(&b.time))?;
    if first.time > times.end() {
        never(problem, &first, times.end())
    } else {
        far(problem, &first, bodies.largest(problem.mesh().points_in::<D>()))
    }
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

fn never<const D: usize>(problem: &Problem<D>, first: &Encounter, end: f64) -> Option<PlausibilityWarning> {
    let Encounter { obstacle, what, gap, speed, time } = *first;
    let place = problem.place_of_obstacle(obstacle);
    let (gap, towards, end) = (short(gap), short(speed), short(end));
    if time.is_finite() {
        let when = short(time);
        let message = format!(
            "the gap of {gap} m closes after {when} s (the body starts at {towards} m/s towards the {what}), but the \
             run ends at {end} s: use a later `end`, start nearer, or check the units of gap and velocity"
        );
        let brief = format!("no contact before {when} s");
        return Some(plausibility_warning(place, "never_touches", brief, message));
    }
    let away = short(-speed);
    let (message, place) = match (what, speed < 0.0) {
        ("plane", true) => (
            format!(
                "moves the body away from the plane at {away} m/s, so the body never touches: is the sign correct?"
            ),
            at("initial", None, "velocity"),
        ),
        ("plane", false) => (
            format!(
                "does not move the body towards the plane, {gap} m away: it never touches; give it a velocity towards \
                 the plane"
            ),
            at("initial", None, "velocity"),
        ),
        (_, true) => (format!("the bodies move apart at {away} m/s and never touch: is a sign wrong?"), place),
        (_, false) => (
            format!(
                "the bodies do not move towards each other, {gap} m apart, and never touch; give one of them a \
                 velocity towards the other one"
            ),
            place,
        ),
    };
    let brief = if what == "plane" { "the body never touches the plane" } else { "the bodies never touch" };
    Some(plausibility_warning(place, "never_touches", brief, message))
}

fn far<const D: usize>(problem: &Problem<D>, first: &Encounter, size: f64) -> Option<PlausibilityWarning> {
    let Encounter { obstacle, what, gap, time, .. } = *first;
    if gap <= FAR * size {
        return None;
    }
    let (gap, size, time) = (short(gap), short(size), short(time));
    let (name, subject, point) = match what {
        "plane" => ("far_plane", "the plane is", "is the point in metres?"),
        _ => ("far_body", "the other body is", "is its place in metres?"),
    };
    let message = format!(
        "{subject} {gap} m away from a body of {size} m, which takes {time} s to reach it: {point} Start nearer to \
         save the steps before contact"
    );
    Some(plausibility_warning(problem.place_of_obstacle(obstacle), name, format!("a gap of {gap} m"), message))
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
