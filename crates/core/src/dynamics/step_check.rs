//! Steps of a run against the stiffness of finite laws, which changes with the strain.

use super::critical_step::critical_time_step;
use super::{Dynamics, SimulationError};
use crate::kernel::{PointKernel, ProblemKernel};
use crate::material::Elastic;

/// A run looks at the stable step each so many steps at the most. In a step of rubber at 40 m/s it falls by 4 %.
const SELDOM: f64 = 20.0;
/// A run looks again after so many steps for the part by which its step is below the stable one.
const AHEAD: f64 = 40.0;
/// A stable step is known but for this factor: that of the elements falls a little less or more than that of the body.
const SLACK: f64 = 1.1;
/// Unless it has fallen below this part of the one known, it is not found anew, which takes as long as three steps.
const KEPT: f64 = 0.98;

/// Looks at the steps of a run.
pub(super) struct StabilityCheck<'d, const D: usize> {
    dynamics: &'d Dynamics<'d, D>,
    /// The kernel of finite laws, with the critical step (s) of the undeformed body over that of its elements.
    finite: Option<(&'d PointKernel<Elastic, D>, f64)>,
    /// The stable step (s) of the elements that is known.
    known: f64,
    /// The step at which it looks again.
    next: usize,
}

impl<'d, const D: usize> StabilityCheck<'d, D> {
    pub(super) fn new(dynamics: &'d Dynamics<'_, D>) -> Self {
        let ProblemKernel::Points(kernel) = &dynamics.kernel else {
            return Self { dynamics, finite: None, known: f64::INFINITY, next: 0 };
        };
        let at_rest = vec![[0.0; D]; dynamics.problem.mesh().node_count()];
        let known = kernel.stable_step(dynamics.problem, &at_rest);
        let finite = Some((kernel, critical_time_step(dynamics.problem) / known));
        Self { dynamics, finite, known, next: 0 }
    }

    /// Refuses a step that is not stable at the displacements of its start.
    pub(super) fn check(&mut self, n: usize, displacement: &[[f64; D]]) -> Result<(), SimulationError> {
        let Dynamics { problem, times, .. } = *self.dynamics;
        let Some((kernel, over_elements)) = self.finite.filter(|_| n >= self.next && n < times.step_count()) else {
            return Ok(());
        };
        let (step, least) = (times.step(n), KEPT * self.known);
        if step > SLACK * over_elements * least || !kernel.is_stable(problem, displacement, least) {
            self.known = kernel.stable_step(problem, displacement);
        }
        let stable = over_elements * self.known;
        if step <= SLACK * stable {
            self.next = n + (AHEAD * (1.0 - step / stable)).clamp(1.0, SELDOM) as usize;
            return Ok(());
        }
        Err(SimulationError::StepTooLong { time: times.instants()[n], step, stable })
    }
}
