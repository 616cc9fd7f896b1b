//! From the steps of a history to states.

use super::Dynamics;
use super::update::advance_velocity;
use crate::history::{State, Step, StepCheck, StepError};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Checks the steps of a history and computes their states, with the functions of the integrator in their order: its own
/// steps give its own bits.
#[derive(Clone, Debug)]
pub struct Evaluation<'p, const D: usize, const N: usize> {
    dynamics: Dynamics<'p, D, N>,
    check: StepCheck,
    force: Vec<[f64; D]>,
    force_before_contact: Vec<[f64; D]>,
    support_reaction: Vec<f64>,
    half_step: Vec<[f64; D]>,
    /// a_{n−1}, if the history brings it.
    given: Option<Vec<[f64; D]>>,
}

impl<'p, const D: usize, const N: usize> Evaluation<'p, D, N> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self {
            dynamics: Dynamics::new(problem, times),
            check: StepCheck::default(),
            force: vec![[0.0; D]; problem.mesh().node_count()],
            force_before_contact: vec![[0.0; D]; problem.surface().nodes().len()],
            support_reaction: vec![0.0; problem.prescribed().len()],
            half_step: problem.initial_velocity().to_vec(),
            given: None,
        }
    }

    /// The state of the next step.
    ///
    /// # Errors
    /// A step that does not fit.
    pub fn advance<'a>(&'a mut self, step: &Step<'a, D>) -> Result<State<'a, D>, StepError> {
        let Self { dynamics, check, force, support_reaction, half_step, .. } = self;
        let (problem, times, n) = (dynamics.problem, dynamics.times, step.index);
        check.check(problem, times, step)?;
        check.accept(step);
        if n > 0 {
            match &self.given {
                Some(given) => advance_velocity(times, n - 1, half_step, given.iter().copied()),
                None => advance_velocity(times, n - 1, half_step, dynamics.accelerations(force)),
            }
        }
        let strain = dynamics.forces(n, step.displacement, force);
        dynamics.apply_supports(n, force, |i, reaction| support_reaction[i] = reaction);
        let surface = problem.surface().nodes();
        for (contact, before) in surface.iter().zip(&mut self.force_before_contact) {
            *before = force[contact.node.index()];
        }
        for (contact, reaction) in surface.iter().zip(step.reaction) {
            (0..D).for_each(|c| force[contact.node.index()][c] += reaction[c]);
        }
        self.given = step.acceleration.map(<[_]>::to_vec);
        let back = if n == 0 { 0.0 } else { 0.5 * times.step(n - 1) };
        if let (Some(velocity), true) = (step.velocity, n > 0) {
            // A history may bring its own v_n; v_{n−½} then lies ½Δt_{n−1} a_n before it.
            for (i, v) in half_step.iter_mut().enumerate() {
                let a = step.acceleration.map_or_else(|| force[i].map(|f| dynamics.inverse_mass[i] * f), |a| a[i]);
                *v = std::array::from_fn(|c| velocity[i][c] - back * a[c]);
            }
        }
        Ok(State {
            step: *step,
            strain,
            force: &self.force,
            force_before_contact: &self.force_before_contact,
            support_reaction: &self.support_reaction,
            half_step: &self.half_step,
            back,
            inverse_mass: &self.dynamics.inverse_mass,
        })
    }
}
