//! Displacement and velocity at the instants of a simulation.

use percute_core::dynamics::Evaluation;
use percute_core::history::{SinkError, Step, StepSink};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// Nodal displacements and velocities at all t_n.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion<const D: usize> {
    /// t_n (s).
    pub times: Vec<f64>,
    /// u_n (m).
    pub displacement: Vec<Vec<[f64; D]>>,
    /// v_n (m/s).
    pub velocity: Vec<Vec<[f64; D]>>,
}

/// Takes the steps of a simulation and keeps its motion.
#[derive(Debug)]
pub struct Recorder<'p, const D: usize, const N: usize> {
    evaluation: Evaluation<'p, D, N>,
    motion: Motion<D>,
}

impl<'p, const D: usize, const N: usize> Recorder<'p, D, N> {
    /// An empty record of a problem over a time grid.
    #[must_use]
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid) -> Self {
        Self { evaluation: Evaluation::new(problem, times), motion: Motion::default() }
    }

    /// What was recorded.
    #[must_use]
    pub fn finish(self) -> Motion<D> {
        self.motion
    }
}

impl<const D: usize, const N: usize> StepSink<D> for Recorder<'_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        let velocity = self.evaluation.advance(step)?.velocity();
        self.motion.times.push(step.time);
        self.motion.displacement.push(step.displacement.to_vec());
        self.motion.velocity.push(velocity);
        Ok(())
    }
}
