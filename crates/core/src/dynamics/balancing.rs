//! The balance of a history, from its steps.

use super::Balance;
use super::balance::BalanceKeeper;
use crate::history::{SinkError, State, StateSink};
use crate::on_problem;
use crate::problem::{Problem, ProblemRef};
use crate::time::TimeGrid;
use std::fmt::Debug;

/// Keeps the balance of energy and impulse of a history, as the integrator does beside its loop: the integrator's steps
/// give its own numbers, bit by bit.
#[derive(Debug)]
pub struct Balancing<'p>(Box<dyn Steps + 'p>);

/// Takes states and has their balance in the end.
trait Steps: StateSink + Debug {
    fn finish(self: Box<Self>) -> Vec<Balance>;
}

impl<'p> Balancing<'p> {
    /// Before the first step.
    #[must_use]
    pub fn new(problem: impl Into<ProblemRef<'p>>, times: &'p TimeGrid) -> Self {
        Self::of(problem.into(), times)
    }

    fn of(problem: ProblemRef<'p>, times: &'p TimeGrid) -> Self {
        on_problem!(problem, problem => Self(Box::new(Keeping {
            problem,
            times,
            keeper: BalanceKeeper::new(problem, times),
            over_time: Vec::new(),
        })))
    }

    /// Energies, works and drifts at every step taken.
    #[must_use]
    pub fn finish(self) -> Vec<Balance> {
        self.0.finish()
    }
}

impl StateSink for Balancing<'_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.0.accept(state)
    }
}

/// That of a problem with its dimension.
#[derive(Debug)]
struct Keeping<'p, const D: usize> {
    problem: &'p Problem<D>,
    times: &'p TimeGrid,
    keeper: BalanceKeeper<D>,
    over_time: Vec<Balance>,
}

impl<const D: usize> Steps for Keeping<'_, D> {
    fn finish(self: Box<Self>) -> Vec<Balance> {
        self.over_time
    }
}

impl<const D: usize> StateSink for Keeping<'_, D> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        // The integrator alone refuses implausible energies.
        self.keeper.record(self.problem, self.times, state);
        self.over_time.push(*self.keeper.balance());
        Ok(())
    }
}
