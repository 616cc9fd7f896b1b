//! Whether a step fits its problem and its instants.

use super::Step;
use crate::message::trimmed;
use crate::problem::Problem;
use crate::time::TimeGrid;
use thiserror::Error;

/// Why a step does not fit.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepError {
    /// Steps that do not follow each other.
    #[error("step {given} came where step {expected} was expected; steps must come in order, from 0 to {last}")]
    Order {
        /// The step given.
        given: usize,
        /// The step expected.
        expected: usize,
        /// The last step of the time grid.
        last: usize,
    },
    /// A field of the wrong length.
    #[error("step {step}: {field} has {given} values, but the problem needs {needed}")]
    Length {
        /// The step.
        step: usize,
        /// Which field.
        field: &'static str,
        /// Its length.
        given: usize,
        /// The right one.
        needed: usize,
    },
    /// A field that some steps have and others have not.
    #[error(
        "step {step}: {field} is {}; give it at all steps or at none",
        if *.there { "there, but not at step 0" } else { "missing" }
    )]
    Partly {
        /// The step.
        step: usize,
        /// Which field.
        field: &'static str,
        /// Whether this step has it.
        there: bool,
    },
    /// NaN or infinity.
    #[error("step {step}: {field} holds a value that is not finite at position {position}")]
    NotFinite {
        /// The step.
        step: usize,
        /// Which field.
        field: &'static str,
        /// Where.
        position: usize,
    },
    /// A step at another time than the grid's.
    #[error("step {step} is at {} s, but the time grid has {} s there", trimmed(*.given, 12), trimmed(*.expected, 12))]
    Time {
        /// The step.
        step: usize,
        /// Its time (s).
        given: f64,
        /// The time of the grid (s).
        expected: f64,
    },
}

/// Checks steps as they come: their order, lengths, times, and that all numbers are finite.
#[derive(Clone, Debug, Default)]
pub(crate) struct StepCheck {
    next: usize,
    /// Whether step 0 had velocity, acceleration and internal variables.
    given: [bool; 3],
}

impl StepCheck {
    /// Checks one step and counts it, unless it does not fit.
    pub(crate) fn advance<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        times: &TimeGrid,
        step: &Step<'_>,
    ) -> Result<(), StepError> {
        let (n, last) = (step.index, times.step_count());
        if n != self.next || n > last {
            return Err(StepError::Order { given: n, expected: self.next, last });
        }
        let (nodes, surface) = (problem.mesh().node_count(), problem.surface().nodes().len());
        let fields = [
            ("displacement", Some(step.displacement), nodes),
            ("reaction", Some(step.reaction), surface),
            ("velocity", step.velocity, nodes),
            ("acceleration", step.acceleration, nodes),
        ];
        for (field, values, needed) in fields {
            let Some(values) = values else { continue };
            length(n, field, values.len(), D * needed)?;
            if let Some(at) = values.iter().position(|x| !x.is_finite()) {
                return Err(StepError::NotFinite { step: n, field, position: at / D });
            }
        }
        length(n, "touching", step.touching.len(), surface)?;
        if !step.internal.is_empty() {
            length(n, "internal", step.internal.len(), problem.variables() * problem.mesh().element_count())?;
            if let Some(at) = step.internal.iter().position(|x| !x.is_finite()) {
                let position = at / problem.variables().max(1);
                return Err(StepError::NotFinite { step: n, field: "internal", position });
            }
        }
        for (was, (field, is)) in self.given.into_iter().zip(optional(step)) {
            if n > 0 && was != is {
                return Err(StepError::Partly { step: n, field, there: is });
            }
        }
        // Times are read or added up elsewhere: rounding of the run's length is all they may differ by.
        let expected = times.instants()[n];
        let apart = (step.time - expected).abs();
        if apart.is_nan() || apart > 1e-12 * times.end() {
            return Err(StepError::Time { step: n, given: step.time, expected });
        }
        if n == 0 {
            self.given = optional(step).map(|(_, there)| there);
        }
        self.next += 1;
        Ok(())
    }
}

fn optional(step: &Step<'_>) -> [(&'static str, bool); 3] {
    [
        ("velocity", step.velocity.is_some()),
        ("acceleration", step.acceleration.is_some()),
        ("internal", !step.internal.is_empty()),
    ]
}

fn length(step: usize, field: &'static str, given: usize, needed: usize) -> Result<(), StepError> {
    if given == needed { Ok(()) } else { Err(StepError::Length { step, field, given, needed }) }
}
