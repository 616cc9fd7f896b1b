//! Displacement and velocity at the instants of a simulation.

use super::ReferenceError;
use percute_core::dynamics::Dynamics;
use percute_core::history::{SinkError, Step, StepSink};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// Nodal displacements and velocities at all t_n.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion<const D: usize> {
    /// t_n (s).
    pub times: Vec<f64>,
    /// u_n (m).
    pub displacement: Vec<Vec<[f64; D]>>,
    /// v_n (m/s).
    pub velocity: Vec<Vec<[f64; D]>>,
}

/// Takes the steps of a simulation and keeps its motion.
#[derive(Debug)]
pub struct Recorder<'p, const D: usize, const N: usize> {
    kinematics: Kinematics<'p, D, N>,
    motion: Motion<D>,
}

impl<'p, const D: usize, const N: usize> Recorder<'p, D, N> {
    /// An empty record of a problem over a time grid.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self { kinematics: Kinematics::new(problem, times), motion: Motion::default() }
    }

    /// What was recorded.
    #[must_use]
    pub fn finish(self) -> Motion<D> {
        self.motion
    }
}

impl<const D: usize, const N: usize> StepSink<D> for Recorder<'_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        let velocity = self.kinematics.velocity(step)?;
        self.motion.times.push(step.time);
        self.motion.displacement.push(step.displacement.to_vec());
        self.motion.velocity.push(velocity);
        Ok(())
    }
}

/// Derives v_n from the steps by the scheme, method of eq. \[28\]–\[32\].
#[derive(Debug)]
pub(super) struct Kinematics<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    dynamics: Dynamics<'p, D, N>,
    /// v_{n−½}.
    half_step: Vec<[f64; D]>,
    next: usize,
}

impl<'p, const D: usize, const N: usize> Kinematics<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self {
            problem,
            times,
            dynamics: Dynamics::new(problem, times),
            half_step: problem.initial_velocity().to_vec(),
            next: 0,
        }
    }

    /// v_n = v_{n−½} + ½Δt_{n−1} a_n (m/s), at the start v₀; then on to v_{n+½} = v_{n−½} + h_n a_n.
    pub(super) fn velocity(&mut self, step: &Step<'_, D>) -> Result<Vec<[f64; D]>, ReferenceError> {
        self.check(step)?;
        let n = step.index;
        self.next += 1;
        let mut acceleration = vec![[0.0; D]; step.displacement.len()];
        self.dynamics.forces_without_contact(n, step.displacement, &mut acceleration);
        for (contact, reaction) in self.problem.surface().nodes().iter().zip(step.reaction) {
            (0..D).for_each(|c| acceleration[contact.node.index()][c] += reaction[c]);
        }
        for (a, inverse) in acceleration.iter_mut().zip(self.dynamics.inverse_mass()) {
            a.iter_mut().for_each(|x| *x *= inverse);
        }
        let back = if n == 0 { 0.0 } else { 0.5 * self.times.step(n - 1) };
        let whole = self.times.velocity_step(n);
        let mut velocity = self.half_step.clone();
        for ((v, half), a) in velocity.iter_mut().zip(&mut self.half_step).zip(&acceleration) {
            for c in 0..D {
                v[c] += back * a[c];
                half[c] += whole * a[c];
            }
        }
        Ok(velocity)
    }

    /// Refuses a step that does not fit.
    fn check(&self, step: &Step<'_, D>) -> Result<(), ReferenceError> {
        let (given, last) = (step.index, self.times.step_count());
        if given != self.next || given > last {
            return Err(ReferenceError::Order { given, expected: self.next, last });
        }
        let lengths = [
            ("displacement", step.displacement.len(), self.problem.mesh().node_count()),
            ("reaction", step.reaction.len(), self.problem.surface().nodes().len()),
        ];
        match lengths.into_iter().find(|(_, given, needed)| given != needed) {
            Some((field, given, needed)) => Err(ReferenceError::Length { field, given, needed }),
            None => Ok(()),
        }
    }
}
