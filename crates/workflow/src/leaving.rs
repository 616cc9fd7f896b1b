//! When all contact has ended: bodies have left their planes and each other.

use percute_core::border::row;
use percute_core::contact::Frame;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::problem::AnyProblem;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Bodies that stay at rest to each other after an impact, as the first ones of a cradle, still approach each other by
/// some part of the speed of the impact: the oscillations that it leaves. Slower approach is none.
const SLOW: f64 = 1e-2;

/// Two bodies, or a body and a plane, that may touch: the normal points to the first body.
struct Meeting {
    frame: Frame<3>,
    body: usize,
    other: Option<usize>,
}

/// What goes on at the end of a run in which contact has not ended for good; instants in s, speeds in m/s.
pub(crate) enum GoingOn {
    /// No contact force has acted.
    NoContact,
    /// A contact force acts.
    Contact,
    /// The last one acted a short while before the end.
    Waiting { last: f64 },
    /// None acts, but a body moves towards another one, or without it towards a plane.
    Nearing { last: f64, body: String, other: Option<String>, speed: f64 },
}

/// Sees when all contact has ended.
pub(crate) struct Leaving<'a> {
    problem: &'a AnyProblem,
    after: f64,
    body_of_node: Vec<usize>,
    meetings: Vec<Meeting>,
    /// The largest speed at which bodies met (m/s).
    fastest: f64,
    /// Last instant with a contact force (s).
    pub(crate) last: Option<f64>,
    /// When all had left (s).
    pub(crate) left: Option<f64>,
    /// The last instant (s).
    now: f64,
    /// Which two approached each other most at the last look, and at which speed (m/s).
    nearing: Option<(usize, f64)>,
    seen: &'a AtomicBool,
}

impl<'a> Leaving<'a> {
    pub(crate) fn new(problem: &'a AnyProblem, after: f64, seen: &'a AtomicBool) -> Self {
        let body_of_node = problem.mesh().part_numbers();
        let meetings = meetings(problem, &body_of_node);
        Self {
            problem,
            after,
            body_of_node,
            meetings,
            fastest: 0.0,
            last: None,
            left: None,
            now: 0.0,
            nearing: None,
            seen,
        }
    }

    /// What goes on at the end of a run in which not all had left.
    pub(crate) fn going_on(&self) -> GoingOn {
        let Some(last) = self.last else { return GoingOn::NoContact };
        match self.nearing {
            Some((meeting, speed)) if last < self.now => {
                let Meeting { body, other, .. } = &self.meetings[meeting];
                let names = self.problem.mesh().part_names();
                GoingOn::Nearing { last, body: names[*body].clone(), other: other.map(|of| names[of].clone()), speed }
            }
            None if last < self.now => GoingOn::Waiting { last },
            _ => GoingOn::Contact,
        }
    }

    /// How fast the centres of mass of each two that may touch move away from each other (m/s).
    fn away(&self, state: &State<'_>) -> Vec<f64> {
        let bodies = self.body_of_node.iter().max().map_or(0, |last| last + 1);
        let (mut mass, mut momentum) = (vec![0.0; bodies], vec![[0.0; 3]; bodies]);
        let (velocities, d) = (state.velocity(), self.problem.dimension());
        for (node, (&body, m)) in self.body_of_node.iter().zip(self.problem.mass()).enumerate() {
            let velocity = row(&velocities, node, d);
            mass[body] += m;
            (0..3).for_each(|c| momentum[body][c] += m * velocity[c]);
        }
        let velocity = |body: usize| momentum[body].map(|p| p / mass[body]);
        let away = |Meeting { frame, body, other }: &Meeting| {
            let (own, other) = (velocity(*body), other.map_or([0.0; 3], velocity));
            frame.split(&std::array::from_fn(|c| own[c] - other[c])).0
        };
        self.meetings.iter().map(away).collect()
    }
}

/// The bodies of each obstacle, each with the body whose surface it is.
fn meetings(problem: &AnyProblem, body_of_node: &[usize]) -> Vec<Meeting> {
    let mut bodies = vec![Vec::new(); problem.obstacle_count()];
    for contact in problem.contact_nodes() {
        let body = body_of_node[contact.node.index()];
        if !bodies[contact.obstacle].contains(&body) {
            bodies[contact.obstacle].push(body);
        }
    }
    let of_obstacle = |(at, of): (usize, &Vec<usize>)| {
        let (partner, frame) = (problem.partner_obstacle(at), problem.obstacle(at).frame());
        let others: Vec<Option<usize>> =
            partner.map_or(vec![None], |partner| bodies[partner].iter().copied().map(Some).collect());
        let first = partner.is_none_or(|partner| at < partner);
        let of = if first { of.clone() } else { Vec::new() };
        of.into_iter().flat_map(move |body| others.clone().into_iter().map(move |other| Meeting { frame, body, other }))
    };
    bodies.iter().enumerate().flat_map(of_obstacle).collect()
}

impl StateSink for Leaving<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        self.now = step.time;
        let touches = step.reaction.iter().any(|force| *force != 0.0);
        if step.index == 0 || (touches && self.last.is_none()) {
            self.fastest = self.away(state).into_iter().fold(self.fastest, |most, away| most.max(away.abs()));
        }
        if touches {
            (self.last, self.nearing) = (Some(step.time), None);
        } else if let Some(last) = self.last
            && self.left.is_none()
            && step.time - last >= self.after
        {
            let several = self.meetings.iter().any(|meeting| meeting.other.is_some());
            let slow = if several { SLOW * self.fastest } else { 0.0 };
            let away = self.away(state).into_iter().enumerate();
            let slowest = away.min_by(|(_, one), (_, other)| one.total_cmp(other));
            self.nearing = slowest.filter(|(_, away)| *away <= -slow).map(|(meeting, away)| (meeting, -away));
            if self.nearing.is_none() {
                self.left = Some(step.time);
                self.seen.store(true, Relaxed);
            }
        }
        Ok(())
    }
}
