//! What contact did to several bodies: the velocity of each before and after, and the rebound at each interface.

use super::rebound::time_of_phases;
use crate::deformation::Deformation;
use percute_core::border::Vector;
use percute_core::contact::Frame;
use percute_core::contact_results::ContactResults;
use percute_core::problem::AnyProblem;
use serde::Serialize;
use std::collections::BTreeSet;

/// The bodies and the interfaces of a run in which bodies may strike each other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Impacts {
    /// The bodies, in the order of their first nodes.
    pub bodies: Vec<BodyMotion>,
    /// The interfaces, in their order.
    pub interfaces: Vec<InterfaceRebound>,
}

/// The motion of the centre of mass of a body, V = Σ m v / Σ m.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyMotion {
    /// Its name: that of the group of all its elements, or "body 0".
    pub name: String,
    /// Its mass (kg).
    pub mass: f64,
    /// V at the start (m/s).
    pub velocity_before: Vec<f64>,
    /// V at the last instant (m/s); none with supports or loads on the body, which change it, too.
    pub velocity_after: Option<Vec<f64>>,
    /// Its angular velocity there, counterclockwise (rad/s); none on a bar, or of a history alone.
    pub angular_velocity_after: Option<f64>,
}

/// How two bodies come together and part: their relative velocity along the normal of the interface. Of several bodies
/// on one side, it is that of their common centre of mass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InterfaceRebound {
    /// The groups of edges of both bodies.
    pub groups: [String; 2],
    /// The normal, from the second body to the first one.
    pub normal: Vec<f64>,
    /// (V₁ − V₂)·n at the last instant before the first contact force (m/s), negative while they come nearer.
    pub normal_before: Option<f64>,
    /// The same at the first instant after the last one (m/s); none if contact has not ended.
    pub normal_after: Option<f64>,
    /// Coefficient of restitution, the latter over the former, negative.
    pub restitution: Option<f64>,
    /// Why there is none.
    pub no_restitution: Option<&'static str>,
    /// First instant at which a pair of nodes touches (s); none without contact.
    pub first_touch: Option<f64>,
    /// Last instant at which a pair touches (s); none if contact has not ended.
    pub release: Option<f64>,
    /// For how long a pair touches: the sum of all phases (s).
    pub time_in_contact: f64,
    /// From the first touch to the release, or to the end of the run, with the flights between phases (s).
    pub span: f64,
    /// Whether contact has ended.
    pub ended: bool,
}

impl Impacts {
    /// Those of a run; none without interfaces.
    #[must_use]
    pub fn new(problem: &AnyProblem, contact: &ContactResults, deformation: Option<&Deformation>) -> Option<Self> {
        let interfaces = &problem.conditions().interfaces;
        if interfaces.is_empty() {
            return None;
        }
        let (centres, d) = (Centres::new(problem, contact), problem.dimension());
        let names = problem.mesh().part_names();
        let bodies = names.into_iter().enumerate().map(|(body, name)| BodyMotion {
            name,
            mass: centres.mass[body],
            velocity_before: centres.start[body][..d].to_vec(),
            velocity_after: centres.after[body].map(|v| v[..d].to_vec()),
            angular_velocity_after: deformation.filter(|_| d > 1).map(|all| all.bodies[body].angular_velocity),
        });
        let rebounds = interfaces.iter().zip(problem.sides_of_interfaces()).map(|(interface, sides)| {
            rebound(problem, contact, &centres, (interface.groups().map(str::to_string), sides))
        });
        Some(Self { bodies: bodies.collect(), interfaces: rebounds.collect() })
    }
}

/// What acts on a body beside contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OtherLoad {
    Nothing,
    /// Fixed supports alone.
    Fixed,
    /// Loads, or supports that move.
    Other,
}

/// What acts on each body beside contact.
fn beside_contact(problem: &AnyProblem, of_node: &[usize], bodies: usize) -> Vec<OtherLoad> {
    let mut beside = vec![OtherLoad::Nothing; bodies];
    for held in problem.prescribed().iter().filter(|held| held.motion.is_none()) {
        beside[of_node[held.node.index()]] = OtherLoad::Fixed;
    }
    let moved = problem.prescribed().iter().filter(|held| held.motion.is_some()).map(|held| held.node);
    let pulled = problem.face_loads().into_iter().map(|load| problem.mesh().face(load.face).nodes[0]);
    let weighed = problem.body_loads().iter().flat_map(|load| load.nodal_volume.iter().map(|(node, _)| *node));
    moved.chain(pulled).chain(weighed).for_each(|node| beside[of_node[node.index()]] = OtherLoad::Other);
    beside
}

/// The motion of the centres of mass: contact forces alone change it, unless there are supports or loads.
struct Centres<'c> {
    contact: &'c ContactResults,
    /// The bodies that each obstacle acts on, ascending.
    of_obstacle: Vec<BTreeSet<usize>>,
    mass: Vec<f64>,
    /// Velocity at the start (m/s), and at the last instant if contact alone changes it.
    start: Vec<Vector>,
    after: Vec<Option<Vector>>,
    /// What else acts on each body.
    beside: Vec<OtherLoad>,
}

impl<'c> Centres<'c> {
    fn new(problem: &AnyProblem, contact: &'c ContactResults) -> Self {
        let of_node = problem.mesh().part_numbers();
        let count = of_node.iter().max().map_or(0, |last| last + 1);
        let (mut mass, mut start) = (vec![0.0; count], vec![[0.0; 3]; count]);
        for ((&body, m), v) in
            of_node.iter().zip(problem.mass()).zip(problem.initial_velocity().chunks_exact(problem.dimension()))
        {
            mass[body] += m;
            start[body].iter_mut().zip(v).for_each(|(sum, v)| *sum += m * v);
        }
        start.iter_mut().zip(&mass).for_each(|(v, m)| *v = v.map(|x| x / m));
        let mut of_obstacle = vec![BTreeSet::new(); contact.obstacles.len()];
        for point in &contact.nodes {
            of_obstacle[point.obstacle].insert(of_node[point.node.index()]);
        }
        let beside = beside_contact(problem, &of_node, count);
        let mut after = start.clone();
        for (point, summary) in contact.nodes.iter().zip(&contact.summary) {
            let body = of_node[point.node.index()];
            (0..3).for_each(|c| after[body][c] += summary.impulse[c] / mass[body]);
        }
        let known = |(velocity, beside): (Vector, &OtherLoad)| (*beside == OtherLoad::Nothing).then_some(velocity);
        let after = after.into_iter().zip(&beside).map(known).collect();
        Self { contact, of_obstacle, mass, start, after, beside }
    }

    /// Velocity of the bodies of an obstacle at an instant (m/s), that of their common centre of mass; none if another
    /// obstacle acts on some of them and on others together.
    fn at(&self, obstacle: usize, n: usize) -> Option<Vector> {
        let bodies = &self.of_obstacle[obstacle];
        if bodies.iter().all(|&body| self.beside[body] == OtherLoad::Fixed) {
            // What holds it has no velocity.
            return Some([0.0; 3]);
        }
        let total: f64 = bodies.iter().map(|&body| self.mass[body]).sum();
        let mut velocity = [0.0; 3];
        for &body in bodies {
            (0..3).for_each(|c| velocity[c] += self.mass[body] / total * self.start[body][c]);
        }
        let all = self.contact.obstacles.iter().zip(&self.of_obstacle);
        for (over_time, of) in all.filter(|(_, of)| !of.is_disjoint(bodies)) {
            let impulse = over_time.get(n).filter(|_| of.is_subset(bodies))?.impulse;
            (0..3).for_each(|c| velocity[c] += impulse[c] / total);
        }
        self.moved_by_contact(obstacle).then_some(velocity)
    }

    /// Whether contact alone changes the velocity of all bodies of an obstacle.
    fn moved_by_contact(&self, obstacle: usize) -> bool {
        self.of_obstacle[obstacle].iter().all(|&body| self.beside[body] == OtherLoad::Nothing)
    }

    /// Whether the velocities of the bodies of two obstacles are known: contact alone changes them, or one side is
    /// held.
    fn are_known(&self, sides: [usize; 2]) -> bool {
        let held = |side: usize| self.of_obstacle[side].iter().all(|&body| self.beside[body] == OtherLoad::Fixed);
        let [first, second] = sides.map(|side| self.moved_by_contact(side));
        first && (second || held(sides[1])) || second && held(sides[0])
    }

    /// Whether another obstacle than these acts on one of their bodies between two instants.
    fn others_act(&self, sides: [usize; 2], [first, last]: [usize; 2]) -> bool {
        let bodies = sides.map(|side| &self.of_obstacle[side]);
        let mut others = (0..self.of_obstacle.len()).filter(|k| !sides.contains(k));
        others.any(|k| {
            let over_time = &self.contact.obstacles[k][first..=last];
            bodies.iter().any(|bodies| !bodies.is_disjoint(&self.of_obstacle[k]))
                && over_time.iter().any(|sum| sum.in_contact > 0)
        })
    }

    /// Relative velocity of the bodies of two obstacles along a normal (m/s).
    fn relative(&self, sides: [usize; 2], frame: &Frame<3>, n: usize) -> Option<f64> {
        let [first, second] = sides.map(|side| self.at(side, n));
        let (first, second) = (first?, second?);
        Some(frame.split(&std::array::from_fn(|c| first[c] - second[c])).0)
    }
}

fn rebound(
    problem: &AnyProblem,
    contact: &ContactResults,
    centres: &Centres<'_>,
    (groups, sides): ([String; 2], [usize; 2]),
) -> InterfaceRebound {
    let frame = problem.obstacle(sides[0]).frame();
    let normal = frame.normal()[..problem.dimension()].iter().map(|x| x + 0.0).collect();
    let over_time = &contact.obstacles[sides[0]];
    let acting = |n: &usize| over_time[*n].in_contact > 0;
    let steps = over_time.len();
    let Some((first, last)) = (0..steps).find(acting).zip((0..steps).rfind(acting)) else {
        return InterfaceRebound {
            groups,
            normal,
            normal_before: None,
            normal_after: None,
            restitution: None,
            no_restitution: Some("the bodies do not touch"),
            first_touch: None,
            release: None,
            time_in_contact: 0.0,
            span: 0.0,
            ended: false,
        };
    };
    // The reaction R_n holds the nodes together at t_{n+1}.
    let ended = last + 1 < steps;
    let time = |n: usize| contact.instants[n.min(steps - 1)];
    let before = centres.relative(sides, &frame, first.saturating_sub(1));
    let after = if ended { centres.relative(sides, &frame, last + 1) } else { None };
    let no_restitution = match (before, after) {
        _ if !centres.are_known(sides) => Some("supports or loads change the velocities, too"),
        _ if !ended => Some("contact has not ended"),
        (None, _) | (_, None) => Some("another contact changes the velocities, too"),
        _ if centres.others_act(sides, [first, last]) => Some("another contact changes the velocities, too"),
        (Some(before), _) if before >= 0.0 => Some("the bodies do not approach each other before contact"),
        (_, Some(after)) if after < 0.0 => Some("the bodies still approach each other, and will touch again"),
        _ => None,
    };
    let restitution = before.zip(after).filter(|_| no_restitution.is_none()).map(|(before, after)| -after / before);
    InterfaceRebound {
        groups,
        normal,
        normal_before: before,
        normal_after: after,
        restitution,
        no_restitution,
        first_touch: Some(time(first + 1)),
        release: ended.then(|| time(last + 1)),
        time_in_contact: time_of_phases(acting, [first, last], time),
        span: time(last + 1) - time(first + 1),
        ended,
    }
}
