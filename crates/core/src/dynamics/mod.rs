//! The explicit solution: central differences, lumped mass, contact by multipliers (§5).

mod balance;
mod balancing;
mod central_difference;
mod contact;
mod critical_step;
mod entry;
mod evaluation;
mod missed;
mod moving;
mod node_update;
mod pass;
mod simulation;
mod stable_times;
mod start;
mod step_check;
mod update;
mod work_meter;

pub use balance::Balance;
pub use balancing::Balancing;
pub use critical_step::{element_time_step, rough_field};
pub use entry::{
    check_start, critical_time_step, missed_contact, replay, resume, simulate, simulate_threaded, time_step_of_element,
};
pub use evaluation::Evaluation;
use missed::MissedContact;
pub use simulation::{Simulation, SimulationError};
pub use stable_times::{StableTimes, first_stable_step, stable_times};
pub use update::advance;

use crate::kernel::{Kernel, ProblemKernel, on_kernel};
use crate::mesh::Strips;
use crate::problem::Problem;
use crate::time::TimeGrid;

/// The discrete equilibrium M a_n = F_n − K u_n + R_n (eq. \[30\]) of a problem on a time grid.
///
/// The integrator and all that derives velocities from stored displacements call the same
/// functions in the same order, and so get the same bits.
#[derive(Clone, Debug)]
pub struct Dynamics<'p, const D: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    kernel: ProblemKernel<D>,
    inverse_mass: Vec<f64>,
    /// Nodes on which contact or a support acts, ascending.
    apart: Vec<u32>,
    /// Whether a step is worked on by all threads of the pool of the caller.
    parallel: bool,
}

impl<'p, const D: usize> Dynamics<'p, D> {
    /// Prepares the forces of a problem.
    #[must_use]
    pub fn new(problem: &'p Problem<D>, times: &'p TimeGrid) -> Self {
        let inverse_mass = problem.mass().iter().map(|m| 1.0 / m).collect();
        let contact = problem.surface().nodes().iter().map(|contact| contact.node);
        let supported = problem.prescribed().iter().map(|p| p.node);
        let mut apart: Vec<u32> = contact.chain(supported).map(|node| node.index() as u32).collect();
        apart.sort_unstable();
        apart.dedup();
        Self { problem, times, kernel: ProblemKernel::new(problem), inverse_mass, apart, parallel: false }
    }

    /// The problem.
    #[must_use]
    pub fn problem(&self) -> &'p Problem<D> {
        self.problem
    }

    /// Elements that are worked on at the same time.
    fn strips(&self) -> &Strips {
        on_kernel!(&self.kernel, kernel => Kernel::<D>::strips(kernel))
    }

    /// 1/m of each node (1/kg).
    #[inline]
    #[must_use]
    pub fn inverse_mass(&self) -> &[f64] {
        &self.inverse_mass
    }

    /// External minus internal forces at t_n (N), without contact and supports. Returns the
    /// strain energy (J).
    pub fn forces(&self, n: usize, displacement: &[[f64; D]], force: &mut [[f64; D]]) -> f64 {
        self.problem.external_forces(self.times.instants()[n], force);
        self.subtract_internal_forces(displacement, force)
    }

    /// Subtracts the internal forces (N) from `force` and returns the strain energy (J). Of materials that yield those
    /// of a body that had no strain before.
    pub fn subtract_internal_forces(&self, displacement: &[[f64; D]], force: &mut [[f64; D]]) -> f64 {
        self.kernel.subtract_from_rest(displacement, force)
    }

    /// The forces M a_n of all nodes (N) but for contact, supports included. Returns the strain
    /// energy (J).
    pub fn forces_without_contact(&self, n: usize, displacement: &[[f64; D]], force: &mut [[f64; D]]) -> f64 {
        let strain = self.forces(n, displacement, force);
        self.apply_supports(n, force, |_, _| ());
        strain
    }

    /// Sets the force on prescribed components to what their motion needs (N), and hands each
    /// support reaction to `reaction`.
    pub fn apply_supports(&self, n: usize, force: &mut [[f64; D]], mut reaction: impl FnMut(usize, f64)) {
        for (i, p) in self.problem.prescribed().iter().enumerate() {
            let needed = self.problem.mass()[p.node.index()] * self.prescribed_acceleration(n, i);
            let slot = &mut force[p.node.index()][p.component];
            reaction(i, needed - *slot);
            *slot = needed;
        }
    }

    /// a_n of a prescribed component: what takes its half-step velocities from one to the next,
    /// each the mean of v_d at the ends of its step.
    #[must_use]
    pub fn prescribed_acceleration(&self, n: usize, index: usize) -> f64 {
        let p = &self.problem.prescribed()[index];
        if p.motion.is_none() {
            return 0.0;
        }
        let velocity = |k: usize| self.problem.prescribed_velocity(p, self.times.instants()[k]);
        let last = self.times.step_count();
        if n == 0 || n == last {
            let k = n.min(last - 1);
            return (velocity(k + 1) - velocity(k)) / self.times.step(k);
        }
        0.5 * (velocity(n + 1) - velocity(n - 1)) / self.times.velocity_step(n)
    }
}
