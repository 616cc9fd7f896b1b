//! The balance of a history, from its steps.

use super::balance::BalanceKeeper;
use super::{Balance, Evaluation};
use crate::history::{SinkError, State, Step, StepSink};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// Keeps the balance of energy and impulse of a history, as the integrator does beside its loop: the integrator's steps give
/// its own numbers, bit by bit.
#[derive(Clone, Debug)]
pub struct Balancing<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    keeper: BalanceKeeper<D>,
    over_time: Vec<Balance>,
    /// Evaluates bare steps.
    evaluation: Option<Box<Evaluation<'p, D, N>>>,
}

impl<'p, const D: usize, const N: usize> Balancing<'p, D, N> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self { problem, times, keeper: BalanceKeeper::new(problem, times), over_time: Vec::new(), evaluation: None }
    }

    /// Energies, works and drifts at every step taken.
    #[must_use]
    pub fn finish(self) -> Vec<Balance> {
        self.over_time
    }
}

impl<const D: usize, const N: usize> StepSink<D> for Balancing<'_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        let mut evaluation =
            self.evaluation.take().unwrap_or_else(|| Box::new(Evaluation::new(self.problem, self.times)));
        let pushed = evaluation.advance(step).map_err(SinkError::from).and_then(|state| self.push_state(&state));
        self.evaluation = Some(evaluation);
        pushed
    }

    fn push_state(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        // The integrator alone refuses implausible energies.
        self.keeper.record(self.problem, self.times, state);
        self.over_time.push(*self.keeper.balance());
        Ok(())
    }
}
