//! The balance of a history, from its steps.

use super::Balance;
use super::balance::BalanceKeeper;
use crate::history::{SinkError, State, StateSink};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Keeps the balance of energy and impulse of a history, as the integrator does beside its loop: the integrator's steps
/// give its own numbers, bit by bit.
#[derive(Clone, Debug)]
pub struct Balancing<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    keeper: BalanceKeeper<D>,
    over_time: Vec<Balance>,
}

impl<'p, const D: usize, const N: usize> Balancing<'p, D, N> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self { problem, times, keeper: BalanceKeeper::new(problem, times), over_time: Vec::new() }
    }

    /// Energies, works and drifts at every step taken.
    #[must_use]
    pub fn finish(self) -> Vec<Balance> {
        self.over_time
    }
}

impl<const D: usize, const N: usize> StateSink<D> for Balancing<'_, D, N> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        // The integrator alone refuses implausible energies.
        self.keeper.record(self.problem, self.times, state);
        self.over_time.push(*self.keeper.balance());
        Ok(())
    }
}
