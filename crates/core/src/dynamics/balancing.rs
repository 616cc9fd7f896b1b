//! The balance of a history, from its steps.

use super::balance::{BalanceKeeper, Instant};
use super::{Balance, Kinematics};
use crate::history::{SinkError, Step, StepSink};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Takes the steps of a history and keeps their balance of energy and impulse, as the integrator
/// does beside its loop: from the integrator's steps come its own numbers, bit by bit.
#[derive(Clone, Debug)]
pub struct Balancing<'p, const D: usize, const N: usize> {
    kinematics: Kinematics<'p, D, N>,
    keeper: BalanceKeeper<D>,
    over_time: Vec<Balance>,
}

impl<'p, const D: usize, const N: usize> Balancing<'p, D, N> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        let kinematics = Kinematics::new(problem, times);
        let keeper = BalanceKeeper::new(&kinematics.dynamics);
        Self { kinematics, keeper, over_time: Vec::new() }
    }

    /// Energies, works and drifts at every step taken.
    #[must_use]
    pub fn finish(self) -> Vec<Balance> {
        self.over_time
    }

    /// Kinetic energy (J) and momentum (kg m/s): from the velocities given, or as the integrator
    /// has them.
    fn energies(&self) -> (f64, [f64; D]) {
        let kinematics = &self.kinematics;
        if kinematics.given() == [false, false] {
            return kinematics.dynamics.energies(kinematics.back(), &kinematics.half_step, &kinematics.force);
        }
        kinematics.dynamics.energies(0.0, &kinematics.velocity(), &kinematics.force)
    }
}

impl<const D: usize, const N: usize> StepSink<D> for Balancing<'_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        let reactions = &mut self.keeper.support_reaction;
        let strain = self.kinematics.advance_with(step, |i, reaction| reactions[i] = reaction)?;
        let (kinetic, momentum) = self.energies();
        let (n, displacement, reaction) = (step.index, step.displacement, step.reaction);
        // Whether the energy is plausible is for the integrator to ask; here it is only told.
        let now = Instant { n, displacement, reaction, strain, kinetic, momentum };
        self.keeper.record(&self.kinematics.dynamics, &now);
        self.over_time.push(*self.keeper.balance());
        Ok(())
    }
}
