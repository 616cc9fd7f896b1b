//! The body as it moves from step to step.

use super::Dynamics;
use super::node_update::{NodeMotion, StripSums};
use super::pass::{Fields, Pass};
use crate::history::{StepForces, half_of_last};
use crate::kernel::{Kernel, on_kernel};
use crate::problem::Problem;

/// The fields of an instant.
#[derive(Clone, Debug)]
pub(super) struct MovingBody<const D: usize> {
    /// u_n (m).
    pub(super) displacement: Vec<[f64; D]>,
    /// v_{n−½} (m/s), v₀ at the start.
    pub(super) velocity: Vec<[f64; D]>,
    pub(super) forces: StepForces<D>,
    external: Vec<[f64; D]>,
    /// Internal variables of the elements, in rows.
    pub(super) internal: Vec<f64>,
    sums: Vec<StripSums<D>>,
    total: StripSums<D>,
}

impl<const D: usize> MovingBody<D> {
    /// At rest in its initial fields.
    pub(super) fn new(dynamics: &Dynamics<'_, D>) -> Self {
        let problem: &Problem<D> = dynamics.problem;
        let loaded = if problem.is_loaded() { problem.mesh().node_count() } else { 0 };
        Self {
            displacement: problem.initial_displacement().to_vec(),
            velocity: problem.initial_velocity().to_vec(),
            forces: StepForces::new(problem),
            external: vec![[0.0; D]; loaded],
            internal: vec![
                0.0;
                on_kernel!(&dynamics.kernel, kernel => Kernel::<D>::variables(kernel))
                    * problem.mesh().element_count()
            ],
            sums: vec![StripSums::ZERO; dynamics.strips().count()],
            total: StripSums::ZERO,
        }
    }

    /// Moves to t_n and computes the forces there but for contact.
    pub(super) fn step(&mut self, dynamics: &Dynamics<'_, D>, n: usize, motion: NodeMotion<'_, D>) {
        if !self.external.is_empty() {
            dynamics.problem.external_forces(dynamics.times.instants()[n], &mut self.external);
        }
        self.total = on_kernel!(&dynamics.kernel, kernel => self.pass(kernel, dynamics, n, motion));
        let StepForces { strain, total, before_contact, supports, .. } = &mut self.forces;
        *strain = self.total.strain();
        dynamics.apply_supports(n, total, |i, reaction| supports[i] = reaction);
        for (contact, before) in dynamics.problem.surface().nodes().iter().zip(before_contact) {
            *before = total[contact.node.index()];
        }
    }

    /// The pass over the mesh.
    fn pass<K: Kernel<D>>(
        &mut self,
        kernel: &K,
        dynamics: &Dynamics<'_, D>,
        n: usize,
        motion: NodeMotion<'_, D>,
    ) -> StripSums<D> {
        let pass = Pass {
            kernel,
            mass: dynamics.problem.mass(),
            inverse_mass: &dynamics.inverse_mass,
            apart: &dynamics.apart,
            external: &self.external,
            motion,
            back: half_of_last(dynamics.times, n),
            parallel: dynamics.parallel,
        };
        pass.run(Fields {
            start: 0,
            displacement: &mut self.displacement,
            velocity: &mut self.velocity,
            force: &mut self.forces.total,
            internal_start: 0,
            internal: &mut self.internal,
            sums: &mut self.sums,
        })
    }

    /// Kinetic energy and momentum, once the reactions are among the forces.
    pub(super) fn sum_up(&mut self, dynamics: &Dynamics<'_, D>, n: usize) {
        let (mut sums, back) = (self.total, half_of_last(dynamics.times, n));
        for (i, &node) in dynamics.apart.iter().enumerate() {
            let node = node as usize;
            let masses = [dynamics.problem.mass()[node], dynamics.inverse_mass[node]];
            sums.add(i % 4, masses, back, &self.velocity[node], &self.forces.total[node]);
        }
        self.forces.energies = (sums.kinetic(), sums.momentum());
    }
}
