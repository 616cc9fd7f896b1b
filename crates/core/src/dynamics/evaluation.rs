//! From the steps of a history to states.

use super::Dynamics;
use super::moving::MovingBody;
use super::node_update::Motion;
use super::update::advance_velocity;
use crate::history::{SinkError, State, StateSink, Step, StepCheck, StepError, StepSource, half_of_last};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Checks the steps of a history and computes their states, with the functions of the integrator in their order: its
/// own steps give its own bits.
#[derive(Clone, Debug)]
pub struct Evaluation<'p, const D: usize, const N: usize> {
    dynamics: Dynamics<'p, D, N>,
    check: StepCheck,
    body: MovingBody<D>,
    /// a_{n−1}, if the history brings it.
    given: Option<Vec<[f64; D]>>,
}

impl<'p, const D: usize, const N: usize> Evaluation<'p, D, N> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        let dynamics = Dynamics::new(problem, times);
        let body = MovingBody::new(&dynamics);
        Self { dynamics, check: StepCheck::default(), body, given: None }
    }

    /// The state of the next step.
    ///
    /// # Errors
    /// A step that does not fit.
    pub fn advance<'a>(&'a mut self, step: &Step<'a, D>) -> Result<State<'a, D>, StepError> {
        let Self { dynamics, check, body, given } = self;
        let (problem, times, n) = (dynamics.problem, dynamics.times, step.index);
        check.advance(problem, times, step)?;
        let mut h = n.checked_sub(1).map(|last| times.velocity_step(last));
        if let (Some(given), true) = (given.as_ref(), n > 0) {
            advance_velocity(times, n - 1, &mut body.velocity, given.iter().copied());
            h = None;
        }
        body.step(dynamics, n, Motion::Follow { h, displacement: step.displacement });
        for (contact, reaction) in problem.surface().nodes().iter().zip(step.reaction) {
            (0..D).for_each(|c| body.forces.total[contact.node.index()][c] += reaction[c]);
        }
        body.sum_up(dynamics, n);
        *given = step.acceleration.map(<[_]>::to_vec);
        if let (Some(velocity), true) = (step.velocity, n > 0) {
            // A history may bring its own v_n; v_{n−½} then lies ½Δt_{n−1} a_n before it.
            let back = half_of_last(times, n);
            for (i, v) in body.velocity.iter_mut().enumerate() {
                let a = step
                    .acceleration
                    .map_or_else(|| body.forces.total[i].map(|f| dynamics.inverse_mass[i] * f), |a| a[i]);
                *v = std::array::from_fn(|c| velocity[i][c] - back * a[c]);
            }
        }
        Ok(State::new(*step, times, &body.forces, &body.velocity, &dynamics.inverse_mass))
    }
}

/// Hands the states of all steps of a history to `sink`.
pub(super) fn replay<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    source: &dyn StepSource<D>,
    sink: &mut dyn StateSink<D>,
) -> Result<(), SinkError> {
    let mut evaluation = Evaluation::new(problem, source.times());
    source.replay(&mut |step| sink.accept(&evaluation.advance(step)?))
}
