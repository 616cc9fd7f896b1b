//! Histories that keep a part of their run only.

use crate::error::FileCause;
use crate::read::Part;
use percute_core::time::TimeGrid;

/// The part of a run that its history keeps, beside the displacements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StoredPart {
    /// The steps, ascending; the first is 0.
    pub steps: Vec<usize>,
    /// Velocities v_n by the scheme.
    pub velocity: bool,
    /// Accelerations a_n by the scheme.
    pub acceleration: bool,
    /// Reactions and touching status.
    pub reaction: bool,
}

impl StoredPart {
    /// The place of a step among those kept.
    #[must_use]
    pub fn row_of(&self, step: usize) -> Option<usize> {
        self.steps.binary_search(&step).ok()
    }
}

/// The steps of a thinned history in its run.
#[derive(Clone, Debug)]
pub struct ThinnedSteps {
    /// The number of each instant in the run.
    pub steps: Vec<usize>,
    /// All planned instants of the run (s).
    pub times: TimeGrid,
}

/// Reads them; `instants` are those of the file.
pub(super) fn read(ours: &Part<'_>, instants: &[f64]) -> Result<Option<ThinnedSteps>, FileCause> {
    let Some(steps) = ours.optional("steps")? else { return Ok(None) };
    steps.expect(&[instants.len()], "the number of each instant in the run")?;
    let run = ours.data("run_times")?;
    run.expect_dimensions(1, "(instants of the run)")?;
    let times = TimeGrid::from_instants(run.floats()?).map_err(|cause| FileCause::Times { name: run.name, cause })?;
    let numbers = steps.indices(times.instants().len(), "instants of the run")?;
    let fits = |(k, &n): (usize, &usize)| times.instants()[n] == instants[k] && (k == 0) == (n == 0);
    if let Some(k) = numbers.iter().enumerate().position(|entry| !fits(entry)) {
        let detail = format!(
            "entry {k} is {}, which is not the instant of {:e} s in `percute/run_times`",
            numbers[k], instants[k]
        );
        return Err(FileCause::Value { name: steps.name, detail });
    }
    Ok(Some(ThinnedSteps { steps: numbers, times }))
}
