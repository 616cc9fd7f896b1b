//! How much of the simulation's contact impulse the admissible force keeps.

use crate::contact_density::nodal_forces;
use crate::reconstruction::StepDensities;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// Normal impulses so far (Ns).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Impulse {
    /// Of the admissible force.
    pub(crate) kept: f64,
    /// Of the simulation.
    pub(crate) simulated: f64,
}

impl Impulse {
    /// Adds the step from t_n on: the admissible force is linear over it, the simulation has h_n R_n.
    pub(super) fn add<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        times: &TimeGrid,
        n: usize,
        densities: &StepDensities<D>,
        reaction: &[[f64; D]],
    ) {
        let [start, end] = [&densities.start, &densities.end].map(|d| normal_sum(problem, &nodal_forces(problem, d)));
        self.kept += 0.5 * times.step(n) * (start + end);
        self.simulated += times.velocity_step(n) * normal_sum(problem, reaction);
    }

    /// Adds the simulation's impulse over the last half step, ½Δt_{N−1} R_N.
    pub(super) fn add_last<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        times: &TimeGrid,
        last: usize,
        reaction: &[[f64; D]],
    ) {
        self.simulated += 0.5 * times.step(last - 1) * normal_sum(problem, reaction);
    }
}

/// Sum of the normal components of forces on the nodes of the contact surface (N).
pub(super) fn normal_sum<const D: usize>(problem: &Problem<D>, forces: &[[f64; D]]) -> f64 {
    let surface = problem.surface().nodes().iter().zip(forces);
    surface.map(|(contact, f)| problem.obstacles()[contact.obstacle].flat_frame().split(f).0).sum()
}
