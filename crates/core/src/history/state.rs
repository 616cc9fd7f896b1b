//! A checked step with the fields that follow from it.

use super::{Checkpoint, Step, Sums};
use crate::contact::ContactSurface;
use crate::problem::Problem;
use crate::time::TimeGrid;

/// The forces at an instant by the scheme.
#[derive(Clone, Debug)]
pub(crate) struct StepForces<const D: usize> {
    /// Strain energy ½ u_n·K u_n (J).
    pub(crate) strain: f64,
    /// Kinetic energy (J) and momentum (kg m/s) of v_n by the scheme.
    pub(crate) energies: (f64, [f64; D]),
    /// M a_n (N).
    pub(crate) total: Vec<[f64; D]>,
    /// The same but for contact at the nodes of the contact surface (N).
    pub(crate) before_contact: Vec<[f64; D]>,
    /// Reaction of each prescribed component (N).
    pub(crate) supports: Vec<f64>,
}

impl<const D: usize> StepForces<D> {
    pub(crate) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        Self {
            strain: 0.0,
            energies: (0.0, [0.0; D]),
            total: vec![[0.0; D]; problem.mesh().node_count()],
            before_contact: vec![[0.0; D]; problem.surface().nodes().len()],
            supports: vec![0.0; problem.prescribed().len()],
        }
    }
}

/// A step that fits its problem, with its nodal forces and v_{n−½} by the scheme, eq. \[28\]–\[32\]. These fields are
/// computed once for all sinks; acceleration, velocity and energies follow from them at each call. Velocities or
/// accelerations that the step brings replace those of the scheme. Only `dynamics` makes states.
#[derive(Clone, Copy, Debug)]
pub struct State<'a, const D: usize> {
    step: Step<'a, D>,
    forces: &'a StepForces<D>,
    half_step: &'a [[f64; D]],
    /// ½Δt_{n−1} (s), 0 at the start.
    back: f64,
    inverse_mass: &'a [f64],
    /// Of the balance, beside the integrator.
    sums: Option<&'a Sums>,
}

impl<'a, const D: usize> State<'a, D> {
    /// The state of a checked step; `half_step` is v_{n−½} (m/s), at the start v₀.
    pub(crate) fn new(
        step: Step<'a, D>,
        times: &TimeGrid,
        forces: &'a StepForces<D>,
        half_step: &'a [[f64; D]],
        inverse_mass: &'a [f64],
    ) -> Self {
        Self { step, forces, half_step, back: half_of_last(times, step.index), inverse_mass, sums: None }
    }

    /// The same state with the sums of the balance.
    pub(crate) fn with_sums(self, sums: &'a Sums) -> Self {
        Self { sums: Some(sums), ..self }
    }

    /// The state from which a run can go on. None for a step that is replayed: only the integrator has the sums of the
    /// balance.
    #[must_use]
    pub fn checkpoint(&self) -> Option<Checkpoint<D>> {
        let Step { index: step, displacement, .. } = self.step;
        self.sums.map(|sums| Checkpoint {
            step,
            displacement: displacement.to_vec(),
            half_step: self.half_step.to_vec(),
            sums: *sums,
        })
    }

    /// The step.
    #[must_use]
    pub fn step(&self) -> &Step<'a, D> {
        &self.step
    }

    /// Strain energy ½ u_n·K u_n (J).
    #[must_use]
    pub fn strain(&self) -> f64 {
        self.forces.strain
    }

    /// v_{n−½} (m/s), at the start v₀.
    #[must_use]
    pub fn half_step(&self) -> &'a [[f64; D]] {
        self.half_step
    }

    /// Reaction of each prescribed component (N).
    pub(crate) fn support_reaction(&self) -> &'a [f64] {
        &self.forces.supports
    }

    /// ½Δt_{n−1} (s), 0 at the start.
    pub(crate) fn back(&self) -> f64 {
        self.back
    }

    /// 1/m of each node (1/kg).
    pub(crate) fn inverse_mass(&self) -> &'a [f64] {
        self.inverse_mass
    }

    /// a_n of a node (m/s²).
    #[inline]
    #[must_use]
    pub fn acceleration_of(&self, node: usize) -> [f64; D] {
        match self.step.acceleration {
            Some(given) => given[node],
            None => self.forces.total[node].map(|f| self.inverse_mass[node] * f),
        }
    }

    /// a_n (m/s²).
    #[must_use]
    pub fn acceleration(&self) -> Vec<[f64; D]> {
        (0..self.forces.total.len()).map(|node| self.acceleration_of(node)).collect()
    }

    /// v_n of a node (m/s).
    #[inline]
    #[must_use]
    pub fn velocity_of(&self, node: usize) -> [f64; D] {
        match self.step.velocity {
            Some(given) => given[node],
            None => {
                let acceleration = self.acceleration_of(node);
                std::array::from_fn(|c| self.half_step[node][c] + self.back * acceleration[c])
            }
        }
    }

    /// M a_n by the scheme but for contact, of all nodes (N), as `force`.
    pub fn write_force_without_contact(&self, surface: &ContactSurface<D>, force: &mut [[f64; D]]) {
        force.copy_from_slice(&self.forces.total);
        for (contact, before) in surface.nodes().iter().zip(&self.forces.before_contact) {
            force[contact.node.index()] = *before;
        }
    }

    /// M a_n by the scheme but for contact (N).
    #[must_use]
    pub fn force_without_contact(&self, surface: &ContactSurface<D>) -> Vec<[f64; D]> {
        let mut force = self.forces.total.clone();
        for (contact, before) in surface.nodes().iter().zip(&self.forces.before_contact) {
            force[contact.node.index()] = *before;
        }
        force
    }

    /// v_n = v_{n−½} + ½Δt_{n−1} a_n (m/s), at the start v₀.
    #[must_use]
    pub fn velocity(&self) -> Vec<[f64; D]> {
        (0..self.forces.total.len()).map(|node| self.velocity_of(node)).collect()
    }

    /// Kinetic energy (J) and momentum (kg m/s), with these masses of the nodes (kg).
    #[must_use]
    pub fn energies(&self, mass: &[f64]) -> (f64, [f64; D]) {
        if self.step.velocity.is_none() && self.step.acceleration.is_none() {
            return self.forces.energies;
        }
        let (mut kinetic, mut momentum) = ([0.0; D], [0.0; D]);
        for (v, mass) in self.velocity().iter().zip(mass) {
            for c in 0..D {
                momentum[c] += mass * v[c];
                kinetic[c] += mass * v[c] * v[c];
            }
        }
        (0.5 * kinetic.iter().sum::<f64>(), momentum)
    }
}

/// ½Δt_{n−1} (s), 0 at the start.
pub(crate) fn half_of_last(times: &TimeGrid, n: usize) -> f64 {
    if n == 0 { 0.0 } else { 0.5 * times.step(n - 1) }
}
