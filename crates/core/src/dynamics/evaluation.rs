//! From the steps of a history to states.

use super::Dynamics;
use super::moving::MovingBody;
use super::node_update::NodeMotion;
use super::update::advance_velocity;
use crate::border::vectors;
use crate::history::{SinkError, State, StateSink, Step, StepCheck, StepError, StepSource, half_of_last};
use crate::on_problem;
use crate::problem::{Problem, ProblemRef};
use crate::time::TimeGrid;
use std::fmt::Debug;

/// Checks the steps of a history and computes their states, with the functions of the integrator in their order: its
/// own steps give its own bits.
#[derive(Debug)]
pub struct Evaluation<'p>(Box<dyn Evaluate + 'p>);

trait Evaluate: Debug {
    fn advance<'a>(&'a mut self, step: &Step<'a>) -> Result<State<'a>, StepError>;
}

impl<'p> Evaluation<'p> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: impl Into<ProblemRef<'p>>, times: &'p TimeGrid) -> Self {
        Self::of(problem.into(), times)
    }

    fn of(problem: ProblemRef<'p>, times: &'p TimeGrid) -> Self {
        on_problem!(problem, problem => Self(Box::new(Evaluator::new(problem, times))))
    }

    /// The state of the next step.
    ///
    /// # Errors
    /// A step that does not fit.
    pub fn advance<'a>(&'a mut self, step: &Step<'a>) -> Result<State<'a>, StepError> {
        self.0.advance(step)
    }
}

/// That of a problem with its dimension.
#[derive(Clone, Debug)]
struct Evaluator<'p, const D: usize> {
    dynamics: Dynamics<'p, D>,
    check: StepCheck,
    body: MovingBody<D>,
    /// a_{n−1}, if the history brings it.
    given: Option<Vec<f64>>,
}

impl<'p, const D: usize> Evaluator<'p, D> {
    fn new(problem: &'p Problem<D>, times: &'p TimeGrid) -> Self {
        let dynamics = Dynamics::new(problem, times);
        let body = MovingBody::new(&dynamics);
        Self { dynamics, check: StepCheck::default(), body, given: None }
    }
}

impl<const D: usize> Evaluate for Evaluator<'_, D> {
    fn advance<'a>(&'a mut self, step: &Step<'a>) -> Result<State<'a>, StepError> {
        let Self { dynamics, check, body, given } = self;
        let (problem, times, n) = (dynamics.problem, dynamics.times, step.index);
        check.advance(problem, times, step)?;
        let mut h = n.checked_sub(1).map(|last| times.velocity_step(last));
        if let (Some(given), true) = (given.as_ref(), n > 0) {
            advance_velocity(times, n - 1, &mut body.velocity, vectors(given).iter().copied());
            h = None;
        }
        if !step.internal.is_empty() {
            body.internal.copy_from_slice(step.internal);
        }
        body.step(dynamics, n, NodeMotion::Follow { h, displacement: step.displacement() });
        for (contact, reaction) in problem.surface().nodes().iter().zip(step.reaction::<D>()) {
            (0..D).for_each(|c| body.forces.total[contact.node.index()][c] += reaction[c]);
        }
        body.sum_up(dynamics, n);
        *given = step.acceleration.map(<[f64]>::to_vec);
        if let (Some(velocity), true) = (step.velocity, n > 0) {
            // A history may bring its own v_n; v_{n−½} then lies ½Δt_{n−1} a_n before it.
            let (back, velocity, acceleration) =
                (half_of_last(times, n), vectors::<D>(velocity), step.acceleration.map(vectors));
            for (i, v) in body.velocity.iter_mut().enumerate() {
                let by_scheme = || body.forces.total[i].map(|f| dynamics.inverse_mass[i] * f);
                let a = acceleration.map_or_else(by_scheme, |a| a[i]);
                *v = std::array::from_fn(|c| velocity[i][c] - back * a[c]);
            }
        }
        Ok(State::new(
            Step { internal: &body.internal, ..*step },
            times,
            &body.forces,
            &body.velocity,
            &dynamics.inverse_mass,
        ))
    }
}

/// Hands the states of all steps of a history to `sink`.
pub(super) fn replay(
    problem: ProblemRef<'_>,
    source: &dyn StepSource,
    sink: &mut dyn StateSink,
) -> Result<(), SinkError> {
    let mut evaluation = Evaluation::new(problem, source.times());
    source.replay(&mut |step| sink.accept(&evaluation.advance(step)?))
}
