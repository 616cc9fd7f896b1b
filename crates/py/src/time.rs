//! The instants of a run, as `simulate` takes them.

use crate::errors;
use percute_core::time::{TimeGrid, is_stable};
use percute_workflow::report::unstable_steps;
use pyo3::prelude::*;

/// The instants from 0 to `end`: by the ratio to the critical step, by the step, or step by step (s).
///
/// # Errors
/// Not exactly one of the three, no end, a step above the critical one, or steps that change so that the run would be
/// unstable.
pub(crate) fn grid(
    py: Python<'_>,
    end: Option<f64>,
    courant: Option<f64>,
    step: Option<f64>,
    steps: Option<Vec<f64>>,
    critical: f64,
) -> PyResult<TimeGrid> {
    let refused = |message: String| errors::input(py, message);
    let made = match (courant, step, steps) {
        (Some(courant), None, None) => {
            if !(courant > 0.0 && courant <= 1.0) {
                let allowed = "above 0 and at most 1: the step over the critical step";
                return Err(refused(format!("`courant` is {courant}; it must be {allowed}")));
            }
            TimeGrid::with_step(needed(py, end)?, courant * critical)
        }
        (None, Some(step), None) => {
            below(py, "step", step, critical)?;
            TimeGrid::with_step(needed(py, end)?, step)
        }
        (None, None, Some(steps)) => {
            for (i, step) in steps.iter().enumerate() {
                below(py, &format!("steps[{i}]"), *step, critical)?;
            }
            let grid = TimeGrid::from_steps(&steps);
            if let Some(told) = grid.as_ref().ok().and_then(|grid| unstable_steps(grid, critical)) {
                return Err(refused(format!("`steps` {told}")));
            }
            grid
        }
        _ => {
            let ways = "`courant` (0 to 1), `step` (s) and `steps` (a list in s)";
            return Err(refused(format!("give exactly one of {ways}")));
        }
    };
    let grid = made.map_err(|error| errors::input(py, error))?;
    match end {
        Some(end) if !grid.ends_at(end) => Err(refused(format!(
            "`end` is {end:?} s, but `steps` add up to {:?} s; leave `end` out or make the two agree",
            grid.end()
        ))),
        _ => Ok(grid),
    }
}

fn needed(py: Python<'_>, end: Option<f64>) -> PyResult<f64> {
    end.ok_or_else(|| errors::input(py, "`end` is missing: give the end of the run (s)"))
}

fn below(py: Python<'_>, name: &str, step: f64, critical: f64) -> PyResult<()> {
    if is_stable(step, critical) || step.is_nan() {
        return Ok(());
    }
    let message = format!(
        "`{name}` is {step:?} s; it must be at most the critical step of this mesh, {critical:.7e} s, or the run is \
         unstable: give less, or courant=0.9"
    );
    Err(errors::input(py, message))
}
