//! The rebound of the body: the velocities of its centre of mass before the first contact and after the last.

use super::Impacts;
use crate::deformation::Deformation;
use crate::flight::NextTouch;
use percute_core::border::Vector;
use percute_core::contact::Frame;
use percute_core::contact_results::{ContactResults, Resultant};
use percute_core::dynamics::Balance;
use percute_core::problem::AnyProblem;
use serde::Serialize;

/// Velocities of the centre of mass, V = Σ m v / Σ m (m/s), before the first contact and after the last one.
///
/// Normal components are those along the normal of the plane that gives the largest impulse, positive away from it. The
/// coefficient of restitution is −V′·n / V·n.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rebound {
    /// Velocity at the last instant before the first contact force (m/s).
    pub velocity_before: Vec<f64>,
    /// Velocity at the first instant after the last contact force (m/s); none if contact has not ended.
    pub velocity_after: Option<Vec<f64>>,
    /// Normal component of `velocity_before` (m/s).
    pub normal_before: f64,
    /// Normal component of `velocity_after` (m/s).
    pub normal_after: Option<f64>,
    /// Coefficient of restitution, from 0 on.
    pub restitution: Option<f64>,
    /// Why there is none.
    pub no_restitution: Option<&'static str>,
    /// First instant at which a node touches (s).
    pub first_touch: f64,
    /// Last instant at which a node touches (s); none if contact has not ended.
    pub release: Option<f64>,
    /// For how long a node touches: the sum of all phases (s).
    pub time_in_contact: f64,
    /// From the first touch to the release, or to the end of the run, with the flights between phases (s).
    pub span: f64,
    /// Whether contact has ended.
    pub ended: bool,
    /// Angular velocity at the last instant, counterclockwise (rad/s); none if contact has not ended, on a bar, or of a
    /// history alone.
    pub angular_velocity_after: Option<f64>,
    /// The first point that would reach a plane again by turning, if the run went on; without loads.
    pub touches_again: Option<NextTouch>,
}

/// The velocity along the normal of one plane is not its alone.
const SEVERAL_PLANES: &str = "several planes change the velocity";
/// Loads change the velocity in contact.
const LOADED: &str = "loads change the velocity during contact, too";
/// Loads with more than this part of the impulse of contact are named.
const OF_IMPULSE: f64 = 0.01;
/// The reason that a longer run takes away.
const NOT_ENDED: &str = "contact has not ended";

impl Rebound {
    /// Whether it is the rebound of a body, be it complete or not: else contact is not all that moves the body.
    #[must_use]
    pub fn is_rebound(&self) -> bool {
        self.no_restitution.is_none_or(|reason| [NOT_ENDED, SEVERAL_PLANES].contains(&reason))
    }

    /// The rebound of a run from rigid planes; none without contact.
    #[must_use]
    pub fn new(
        problem: &AnyProblem,
        balance: &[Balance],
        contact: &ContactResults,
        deformation: Option<&Deformation>,
    ) -> Option<Self> {
        if !problem.conditions().interfaces.is_empty() {
            // Bodies that strike each other have velocities of their own.
            return None;
        }
        let acting = |n: &usize| contact.total[*n].in_contact > 0;
        let steps = contact.total.len().min(balance.len());
        let (first, last) = ((0..steps).find(acting)?, (0..steps).rfind(acting)?);
        let mass: f64 = problem.mass().iter().sum();
        let velocity = |n: usize| -> Vector { std::array::from_fn(|c| balance[n].momentum[c] / mass) };
        let (frame, d) = (strongest(problem, contact)?, problem.dimension());
        let before = velocity(first.saturating_sub(1));
        // The reaction R_n holds a node to the plane at t_{n+1}.
        let ended = last + 1 < steps;
        let time = |n: usize| contact.instants[n.min(steps - 1)];
        let after = ended.then(|| velocity(last + 1));
        let (normal_before, normal_after) = (frame.split(&before).0, after.map(|v| frame.split(&v).0));
        let pushes = |over_time: &Vec<Resultant>| over_time.last().is_some_and(|last| last.impulse != [0.0; 3]);
        let planes = contact.obstacles.iter().filter(|over_time| pushes(over_time)).count();
        let no_restitution = match normal_after {
            _ if !problem.prescribed().is_empty() => Some("supports change the velocity, too"),
            None => Some(NOT_ENDED),
            _ if problem.is_loaded() && loaded(contact, &balance[first.saturating_sub(1)], &balance[last + 1]) => {
                Some(LOADED)
            }
            _ if normal_before >= 0.0 => Some("the body does not move towards the plane"),
            Some(after) if after < 0.0 => Some("the body still moves towards the plane, which it will touch again"),
            _ if planes > 1 => Some(SEVERAL_PLANES),
            Some(_) => None,
        };
        let restitution = normal_after.filter(|_| no_restitution.is_none()).map(|v| -v / normal_before);
        let (first_touch, release) = (time(first + 1), time(last + 1));
        let turning =
            deformation.filter(|deformation| ended && problem.dimension() > 1 && deformation.bodies.len() == 1);
        Some(Self {
            velocity_before: before[..d].to_vec(),
            velocity_after: after.map(|v| v[..d].to_vec()),
            normal_before,
            normal_after,
            restitution,
            no_restitution,
            first_touch,
            release: ended.then_some(release),
            time_in_contact: time_of_phases(acting, [first, last], time),
            span: release - first_touch,
            ended,
            angular_velocity_after: turning.map(|deformation| deformation.bodies[0].angular_velocity),
            touches_again: turning.filter(|_| restitution.is_some()).and_then(|deformation| deformation.next_touch),
        })
    }
}

/// Whether loads have more than a hundredth of the impulse between two instants, before contact and after it.
fn loaded(contact: &ContactResults, before: &Balance, after: &Balance) -> bool {
    let Some(given) = contact.total.last().map(|sum| sum.impulse) else { return false };
    let norm = |x: Vector| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    norm(std::array::from_fn(|c| after.momentum[c] - before.momentum[c] - given[c])) > OF_IMPULSE * norm(given)
}

/// How long the phases last between the first and the last instant at which contact acts (s). The reaction R_n holds a
/// node to the plane at t_{n+1}.
pub(super) fn time_of_phases(
    acting: impl Fn(&usize) -> bool,
    [first, last]: [usize; 2],
    time: impl Fn(usize) -> f64,
) -> f64 {
    let (mut sum, mut begun) = (0.0, None);
    for n in first..=last + 1 {
        match (n <= last && acting(&n), begun) {
            (true, None) => begun = Some(time(n + 1)),
            (false, Some(from)) => {
                sum += time(n) - from;
                begun = None;
            }
            _ => {}
        }
    }
    sum
}

/// The rebound of one body and the impacts of several as a JSON document; `null` where there is none.
///
/// # Errors
/// None that is known; whatever the serialiser reports.
pub fn rebound_to_json(rebound: Option<&Rebound>, impacts: Option<&Impacts>) -> Result<String, std::io::Error> {
    let document = serde_json::json!({ "rebound": rebound, "impacts": impacts });
    serde_json::to_string(&document).map_err(std::io::Error::from)
}

/// The frame of the plane that gives the largest normal impulse.
pub(super) fn strongest(problem: &AnyProblem, contact: &ContactResults) -> Option<Frame<3>> {
    let frames = problem.obstacles().map(|obstacle| obstacle.frame());
    let impulse = |frame: &Frame<3>, last: Option<&Resultant>| last.map_or(0.0, |r| frame.split(&r.impulse).0);
    let all = frames.zip(&contact.obstacles).map(|(frame, over_time)| (impulse(&frame, over_time.last()), frame));
    all.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, frame)| frame)
}
