//! What contact did to several bodies: the velocity of each before and after, and the rebound at each interface.

use percute_core::contact::{ContactResults, Frame};
use percute_core::problem::Problem;
use serde::Serialize;

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
    /// V at the last instant (m/s); none with supports or loads, which change it, too.
    pub velocity_after: Option<Vec<f64>>,
}

/// How two bodies come together and part: their relative velocity along the normal of the interface.
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
    /// From the first touch to the release, or to the end of the run (s).
    pub time_in_contact: f64,
    /// Whether contact has ended.
    pub ended: bool,
}

impl Impacts {
    /// Those of a run; none without interfaces.
    #[must_use]
    pub fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, contact: &ContactResults<D>) -> Option<Self> {
        let interfaces = &problem.statement().interfaces;
        if interfaces.is_empty() {
            return None;
        }
        let centres = Centres::new(problem, contact);
        let last = contact.instants.len().saturating_sub(1);
        let names = problem.mesh().part_names();
        let bodies = names.into_iter().enumerate().map(|(body, name)| BodyMotion {
            name,
            mass: centres.mass[body],
            velocity_before: centres.start[body].to_vec(),
            velocity_after: centres.at(body, last).map(|v| v.to_vec()),
        });
        let sides = (0..problem.obstacles().len()).filter(|&k| problem.obstacles()[k].as_plane().is_none());
        let sides: Vec<usize> = sides.collect();
        let rebounds = interfaces.iter().zip(sides.chunks_exact(2)).map(|(interface, sides)| {
            let groups = interface.groups().map(str::to_string);
            rebound(problem, contact, &centres, (groups, [sides[0], sides[1]]))
        });
        Some(Self { bodies: bodies.collect(), interfaces: rebounds.collect() })
    }
}

/// The motion of the centres of mass: contact forces alone change it, unless there are supports or loads.
struct Centres<'c, const D: usize> {
    contact: &'c ContactResults<D>,
    /// The body that each obstacle acts on.
    of_obstacle: Vec<usize>,
    mass: Vec<f64>,
    /// Velocity at the start (m/s).
    start: Vec<[f64; D]>,
    /// Whether contact alone changes velocities.
    alone: bool,
}

impl<'c, const D: usize> Centres<'c, D> {
    fn new<const N: usize>(problem: &Problem<D, N>, contact: &'c ContactResults<D>) -> Self {
        let of_node = problem.mesh().part_numbers();
        let count = of_node.iter().max().map_or(0, |last| last + 1);
        let (mut mass, mut start) = (vec![0.0; count], vec![[0.0; D]; count]);
        for ((&body, m), v) in of_node.iter().zip(problem.mass()).zip(problem.initial_velocity()) {
            mass[body] += m;
            (0..D).for_each(|c| start[body][c] += m * v[c]);
        }
        start.iter_mut().zip(&mass).for_each(|(v, m)| *v = v.map(|x| x / m));
        let mut of_obstacle = vec![0; contact.obstacles.len()];
        contact.nodes.iter().for_each(|point| of_obstacle[point.obstacle] = of_node[point.node.index()]);
        let alone =
            problem.prescribed().is_empty() && problem.facet_loads().is_empty() && problem.body_loads().is_empty();
        Self { contact, of_obstacle, mass, start, alone }
    }

    /// Velocity of a body at an instant (m/s).
    fn at(&self, body: usize, n: usize) -> Option<[f64; D]> {
        let acting = self.contact.obstacles.iter().zip(&self.of_obstacle).filter(|(_, of)| **of == body);
        let mut velocity = self.start[body];
        for (over_time, _) in acting {
            let impulse = over_time.get(n)?.impulse;
            (0..D).for_each(|c| velocity[c] += impulse[c] / self.mass[body]);
        }
        self.alone.then_some(velocity)
    }

    /// Whether another obstacle than these acts on one of their bodies between two instants.
    fn others_act(&self, sides: [usize; 2], [first, last]: [usize; 2]) -> bool {
        let bodies = sides.map(|side| self.of_obstacle[side]);
        let mut others = (0..self.of_obstacle.len()).filter(|k| !sides.contains(k));
        others.any(|k| {
            let over_time = &self.contact.obstacles[k][first..=last];
            bodies.contains(&self.of_obstacle[k]) && over_time.iter().any(|sum| sum.in_contact > 0)
        })
    }

    /// Relative velocity of the bodies of two obstacles along a normal (m/s).
    fn relative(&self, sides: [usize; 2], frame: &Frame<D>, n: usize) -> Option<f64> {
        let [first, second] = sides.map(|side| self.at(self.of_obstacle[side], n));
        let (first, second) = (first?, second?);
        Some(frame.split(&std::array::from_fn(|c| first[c] - second[c])).0)
    }
}

fn rebound<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    contact: &ContactResults<D>,
    centres: &Centres<'_, D>,
    (groups, sides): ([String; 2], [usize; 2]),
) -> InterfaceRebound {
    let frame = problem.obstacles()[sides[0]].flat_frame();
    let normal = frame.normal().map(|x| x + 0.0).to_vec();
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
            ended: false,
        };
    };
    // The reaction R_n holds the nodes together at t_{n+1}.
    let ended = last + 1 < steps;
    let time = |n: usize| contact.instants[n.min(steps - 1)];
    let before = centres.relative(sides, &frame, first.saturating_sub(1));
    let after = if ended { centres.relative(sides, &frame, last + 1) } else { None };
    let no_restitution = match (before, after) {
        (None, _) => Some("supports or loads change the velocities, too"),
        (_, None) => Some("contact has not ended"),
        _ if centres.others_act(sides, [first, last]) => Some("another contact changes the velocities, too"),
        (Some(before), _) if before >= 0.0 => Some("the bodies do not come nearer before they touch"),
        (_, Some(after)) if after < 0.0 => Some("the bodies still come nearer, and will touch again"),
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
        time_in_contact: time(last + 1) - time(first + 1),
        ended,
    }
}
