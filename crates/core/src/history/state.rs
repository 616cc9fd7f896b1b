//! A checked step with the fields that follow from it.

use super::{Checkpoint, Step, Sums};
use crate::border::vectors;
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
    pub(crate) fn new(problem: &Problem<D>) -> Self {
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
pub struct State<'a> {
    step: Step<'a>,
    strain: f64,
    energies: (f64, &'a [f64]),
    total: &'a [f64],
    before_contact: &'a [f64],
    supports: &'a [f64],
    half_step: &'a [f64],
    /// ½Δt_{n−1} (s), 0 at the start.
    back: f64,
    inverse_mass: &'a [f64],
    /// Of the balance, beside the integrator.
    sums: Option<&'a Sums>,
}

impl<'a> State<'a> {
    /// The state of a checked step; `half_step` is v_{n−½} (m/s), at the start v₀.
    pub(crate) fn new<const D: usize>(
        step: Step<'a>,
        times: &TimeGrid,
        forces: &'a StepForces<D>,
        half_step: &'a [[f64; D]],
        inverse_mass: &'a [f64],
    ) -> Self {
        Self {
            step,
            strain: forces.strain,
            energies: (forces.energies.0, &forces.energies.1),
            total: forces.total.as_flattened(),
            before_contact: forces.before_contact.as_flattened(),
            supports: &forces.supports,
            half_step: half_step.as_flattened(),
            back: half_of_last(times, step.index),
            inverse_mass,
            sums: None,
        }
    }

    /// The same state with the sums of the balance.
    pub(crate) fn with_sums(self, sums: &'a Sums) -> Self {
        Self { sums: Some(sums), ..self }
    }

    /// The state from which a run can go on. None for a step that is replayed: only the integrator has the sums of the
    /// balance.
    #[must_use]
    pub fn checkpoint(&self) -> Option<Checkpoint> {
        let Step { index: step, displacement, internal, .. } = self.step;
        self.sums.map(|sums| Checkpoint {
            step,
            displacement: displacement.to_vec(),
            half_step: self.half_step.to_vec(),
            internal: internal.to_vec(),
            sums: *sums,
        })
    }

    /// The step.
    #[must_use]
    pub fn step(&self) -> &Step<'a> {
        &self.step
    }

    /// Strain energy ½ u_n·K u_n (J); of materials that yield, with what they have stored and dissipated.
    #[must_use]
    pub fn strain(&self) -> f64 {
        self.strain
    }

    /// v_{n−½} (m/s), at the start v₀.
    #[must_use]
    pub fn half_step<const D: usize>(&self) -> &'a [[f64; D]] {
        vectors(self.half_step)
    }

    /// Reaction of each prescribed component (N).
    pub(crate) fn support_reaction(&self) -> &'a [f64] {
        self.supports
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
    pub fn acceleration_of<const D: usize>(&self, node: usize) -> [f64; D] {
        match self.step.acceleration {
            Some(given) => vectors(given)[node],
            None => vectors(self.total)[node].map(|f: f64| self.inverse_mass[node] * f),
        }
    }

    /// v_n of a node (m/s).
    #[inline]
    #[must_use]
    pub fn velocity_of<const D: usize>(&self, node: usize) -> [f64; D] {
        match self.step.velocity {
            Some(given) => vectors(given)[node],
            None => {
                let acceleration = self.acceleration_of::<D>(node);
                std::array::from_fn(|c| self.half_step[D * node + c] + self.back * acceleration[c])
            }
        }
    }

    /// a_n (m/s²), in rows.
    #[must_use]
    pub fn acceleration(&self) -> Vec<f64> {
        let components = self.total.len() / self.inverse_mass.len();
        let by_scheme = || self.total.iter().enumerate().map(|(i, f)| self.inverse_mass[i / components] * f).collect();
        self.step.acceleration.map_or_else(by_scheme, <[f64]>::to_vec)
    }

    /// v_n = v_{n−½} + ½Δt_{n−1} a_n (m/s), at the start v₀, in rows.
    #[must_use]
    pub fn velocity(&self) -> Vec<f64> {
        if let Some(given) = self.step.velocity {
            return given.to_vec();
        }
        let by_scheme = self.half_step.iter().zip(self.acceleration());
        by_scheme.map(|(half_step, acceleration)| half_step + self.back * acceleration).collect()
    }

    /// M a_n by the scheme but for contact, of all nodes (N).
    pub fn write_force_without_contact<const D: usize>(&self, surface: &ContactSurface<D>, force: &mut [[f64; D]]) {
        force.copy_from_slice(vectors(self.total));
        for (contact, before) in surface.nodes().iter().zip(vectors(self.before_contact)) {
            force[contact.node.index()] = *before;
        }
    }

    /// Kinetic energy (J) and momentum (kg m/s), with these masses of the nodes (kg).
    #[must_use]
    pub fn energies<const D: usize>(&self, mass: &[f64]) -> (f64, [f64; D]) {
        if self.step.velocity.is_none() && self.step.acceleration.is_none() {
            return (self.energies.0, vectors(self.energies.1)[0]);
        }
        let (mut kinetic, mut momentum) = ([0.0; D], [0.0; D]);
        for (node, mass) in mass.iter().enumerate() {
            let v = self.velocity_of::<D>(node);
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
