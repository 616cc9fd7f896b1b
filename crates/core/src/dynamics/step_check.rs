//! Steps of a run against the stiffness of finite laws, which changes with the strain.

use super::critical_step::critical_time_step;
use super::{Dynamics, SimulationError};
use crate::kernel::{PointKernel, ProblemKernel};
use crate::material::Elastic;

/// A run looks at the stable step each so many steps at the most: a look takes as long as two steps. In a step of
/// rubber at 40 m/s it falls by 4 %.
const SELDOM: f64 = 20.0;
/// A run looks again after so many steps for the part by which its step is below the stable one.
const AHEAD: f64 = 40.0;
/// A stable step is known but for this factor: that of the elements falls a little less or more than that of the body.
const SLACK: f64 = 1.1;

/// Looks at the steps of a run.
pub(super) struct StabilityCheck<'d, const D: usize> {
    dynamics: &'d Dynamics<'d, D>,
    /// The kernel of finite laws, with the critical step (s) of the undeformed body over that of its elements.
    finite: Option<(&'d PointKernel<Elastic, D>, f64)>,
    /// The step at which it looks again.
    next: usize,
}

impl<'d, const D: usize> StabilityCheck<'d, D> {
    pub(super) fn new(dynamics: &'d Dynamics<'_, D>) -> Self {
        let finite = match &dynamics.kernel {
            ProblemKernel::Linear(_) => None,
            ProblemKernel::Points(kernel) => {
                let at_rest = vec![[0.0; D]; dynamics.problem.mesh().node_count()];
                let of_elements = kernel.stable_step(dynamics.problem, &at_rest);
                Some((kernel, critical_time_step(dynamics.problem) / of_elements))
            }
        };
        Self { dynamics, finite, next: 0 }
    }

    /// Refuses a step that is not stable at the displacements of its start.
    pub(super) fn check(&mut self, n: usize, displacement: &[[f64; D]]) -> Result<(), SimulationError> {
        let Dynamics { problem, times, .. } = *self.dynamics;
        let Some((kernel, over_elements)) = self.finite.filter(|_| n >= self.next && n < times.step_count()) else {
            return Ok(());
        };
        let (step, stable) = (times.step(n), over_elements * kernel.stable_step(problem, displacement));
        if step <= SLACK * stable {
            self.next = n + (AHEAD * (1.0 - step / stable)).clamp(1.0, SELDOM) as usize;
            return Ok(());
        }
        Err(SimulationError::StepTooLong { time: times.instants()[n], step, stable })
    }
}
