//! The constitutive relation error of an explicit impact simulation.
//!
//! STUB for parallel work: the real implementation has the same public interface.

pub mod estimate;
pub mod options;
pub mod residual;

pub use estimate::{ErrorMeasures, Estimate, Parts, Sample};
pub use options::{Acceleration, ContactForce, Options};
pub use residual::Residuals;

use percute_core::dynamics::{Simulation, SimulationError};
use percute_core::history::{SinkError, Step, StepSink};
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use thiserror::Error;

/// Why an estimate could not be made.
#[derive(Debug, Error)]
pub enum EstimateError {
    /// `every` is zero.
    #[error("`every` is 0; it must be at least 1")]
    EveryZero,
}

/// Why a run failed.
#[derive(Debug, Error)]
pub enum RunError {
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The estimate failed.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
}

/// Takes in steps and estimates.
pub struct Estimator<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    samples: Vec<Sample>,
}

impl<'p, const D: usize, const N: usize> Estimator<'p, D, N> {
    /// New.
    pub fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, _: Options) -> Result<Self, EstimateError> {
        Ok(Self { problem, times, samples: vec![] })
    }

    /// Finishes with the steps taken so far.
    pub fn finish(self) -> Result<Estimate, EstimateError> {
        let steps = self.samples.len() - 1;
        Ok(Estimate {
            error: ErrorMeasures { sup: 1.0, mean: 1.0, relative_sup: 0.1, relative_mean: 0.1, reference_sup: 10.0, reference_mean: 10.0 },
            time_of_sup: 0.0,
            parts: Parts::default(),
            over_time: self.samples,
            by_element: (0..self.problem.mesh().element_count()).map(|e| e as f64).collect(),
            residuals: Residuals::default(),
            kept_impulse: Some(0.95),
            steps,
            end: self.times.instants()[steps],
        })
    }
}

impl<const D: usize, const N: usize> StepSink<D> for Estimator<'_, D, N> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        self.samples.push(Sample { time: step.time, ..Sample::default() });
        Ok(())
    }
}

/// Simulates and estimates beside the run; if the observer breaks, estimates what was done.
pub fn run<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    options: Options,
    observer: &mut dyn Observer,
) -> Result<(Simulation, Estimate), RunError> {
    let mut estimator = Estimator::new(problem, times, options)?;
    let simulation = percute_core::dynamics::simulate(problem, times, &mut estimator, observer)?;
    Ok((simulation, estimator.finish()?))
}
