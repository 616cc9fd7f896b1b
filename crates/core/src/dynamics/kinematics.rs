//! Velocities and accelerations, from displacements and reactions by the scheme.

use super::Dynamics;
use crate::history::{Step, StepCheck, StepError};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Derives v_n and a_n from the steps of a history, eq. \[28\]–\[32\], with the functions of the
/// integrator in their order: from its own steps come its own bits. Where the history brings
/// velocities or accelerations, they are taken instead.
#[derive(Clone, Debug)]
pub struct Kinematics<'p, const D: usize, const N: usize> {
    pub(super) dynamics: Dynamics<'p, D, N>,
    check: StepCheck,
    /// M a_n by the scheme (N).
    pub(super) force: Vec<[f64; D]>,
    /// v_{n−½} by the scheme (m/s).
    pub(super) half_step: Vec<[f64; D]>,
    velocity: Option<Vec<[f64; D]>>,
    acceleration: Option<Vec<[f64; D]>>,
}

impl<'p, const D: usize, const N: usize> Kinematics<'p, D, N> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self {
            dynamics: Dynamics::new(problem, times),
            check: StepCheck::default(),
            force: vec![[0.0; D]; problem.mesh().node_count()],
            half_step: problem.initial_velocity().to_vec(),
            velocity: None,
            acceleration: None,
        }
    }

    /// Goes on to a step. Returns the strain energy (J).
    ///
    /// # Errors
    /// A step that does not fit.
    pub fn advance(&mut self, step: &Step<'_, D>) -> Result<f64, StepError> {
        self.advance_with(step, |_, _| ())
    }

    /// The same, handing each support reaction on.
    pub(super) fn advance_with(
        &mut self,
        step: &Step<'_, D>,
        support_reaction: impl FnMut(usize, f64),
    ) -> Result<f64, StepError> {
        self.check.check(self.dynamics.problem, self.dynamics.times, step)?;
        self.check.accept(step);
        let n = step.index;
        if n > 0 {
            let h = self.dynamics.times.velocity_step(n - 1);
            for (i, v) in self.half_step.iter_mut().enumerate() {
                (0..D).for_each(|c| v[c] += h * accelerate(&self.dynamics, &self.acceleration, &self.force, i, c));
            }
        }
        let strain = self.dynamics.forces(n, step.displacement, &mut self.force);
        self.dynamics.apply_supports(n, &mut self.force, support_reaction);
        for (contact, reaction) in self.dynamics.problem.surface().nodes().iter().zip(step.reaction) {
            (0..D).for_each(|c| self.force[contact.node.index()][c] += reaction[c]);
        }
        self.velocity = step.velocity.map(<[_]>::to_vec);
        self.acceleration = step.acceleration.map(<[_]>::to_vec);
        Ok(strain)
    }

    /// a_n (m/s²).
    #[must_use]
    pub fn acceleration(&self) -> Vec<[f64; D]> {
        let one = |i, c| accelerate(&self.dynamics, &self.acceleration, &self.force, i, c);
        (0..self.force.len()).map(|i| std::array::from_fn(|c| one(i, c))).collect()
    }

    /// v_n = v_{n−½} + ½Δt_{n−1} a_n (m/s), at the start v₀.
    #[must_use]
    pub fn velocity(&self) -> Vec<[f64; D]> {
        if let Some(given) = &self.velocity {
            return given.clone();
        }
        let back = self.back();
        let one = |i: usize, c: usize| {
            self.half_step[i][c] + back * accelerate(&self.dynamics, &self.acceleration, &self.force, i, c)
        };
        (0..self.force.len()).map(|i| std::array::from_fn(|c| one(i, c))).collect()
    }

    /// Whether the history brings velocities, and accelerations.
    #[must_use]
    pub fn given(&self) -> [bool; 2] {
        self.check.given()
    }

    /// ½Δt_{n−1}, 0 at the start.
    pub(super) fn back(&self) -> f64 {
        match self.check.count() {
            0 | 1 => 0.0,
            count => 0.5 * self.dynamics.times.step(count - 2),
        }
    }
}

/// One component of a_n: given, or the force over the mass.
#[inline]
fn accelerate<const D: usize, const N: usize>(
    dynamics: &Dynamics<'_, D, N>,
    given: &Option<Vec<[f64; D]>>,
    force: &[[f64; D]],
    node: usize,
    component: usize,
) -> f64 {
    match given {
        Some(given) => given[node][component],
        None => dynamics.inverse_mass[node] * force[node][component],
    }
}
