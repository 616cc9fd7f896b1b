//! A history that is in memory, into a file.

use crate::case::{Keep, Source};
use crate::failure::Failure;
use crate::foreign::Origin;
use crate::history::plan;
use percute_core::history::{SinkError, StepSource};
use percute_core::problem::Problem;
use percute_estimator::{Options, RunError};
use percute_io::Overwrite;
use percute_io::history::Elsewhere;
use std::path::Path;

/// A whole history with all that its file has beside the steps.
#[derive(Clone, Copy)]
pub struct Whole<'a, const D: usize, const N: usize> {
    /// The problem that it solves.
    pub problem: &'a Problem<D, N>,
    /// The steps.
    pub steps: &'a dyn StepSource<D>,
    /// Whether these have their own velocities and accelerations.
    pub given: [bool; 2],
    /// Options that its estimate takes unless told otherwise.
    pub options: &'a Options,
    /// The case that it came from.
    pub case: Option<&'a Source>,
    /// Of a history of another program.
    pub origin: Option<&'a Origin>,
}

impl<const D: usize, const N: usize> Whole<'_, D, N> {
    /// Writes the file: that of a run that was stored from its start, byte by byte, or that of another program's
    /// simulation, from which `percute estimate` gives the same estimate. A file that cannot be completed is removed.
    ///
    /// # Errors
    /// A problem that the language of the case files cannot say; a file that exists and may not be replaced, or that
    /// cannot be written; steps that end with an error.
    pub fn write(&self, path: &Path, overwrite: Overwrite) -> Result<(), Failure> {
        let Self { problem, steps, given: [velocity, acceleration], options, case, origin } = *self;
        let elsewhere = origin.map(|origin| Elsewhere {
            program: origin.program.clone().unwrap_or_default(),
            derived: origin.derived.iter().map(|part| part.name().to_string()).collect(),
            initial_displacement: problem.initial_displacement().to_vec(),
        });
        let plan = plan(problem, steps.times(), options, case, &Keep::default())?;
        let plan = plan.with_given(velocity, acceleration).simulated_elsewhere(elsewhere);
        let mut writer = plan.create(path, overwrite)?;
        let written = steps.replay(&mut |step| writer.push(step));
        let written = written.map_err(unread).and_then(|()| Ok(writer.finish()?));
        if written.is_err() {
            // It was made here, and holds a part of the history.
            let _ = std::fs::remove_file(path);
        }
        written
    }
}

fn unread(error: SinkError) -> Failure {
    Failure::from_sink(error, RunError::Source)
}
