//! Exports of histories.

use crate::bridge::Watch;
use crate::history::HistoryData;
use crate::{bridge, errors};
use percute_core::history::StepSource;
use percute_io::Overwrite;
use percute_workflow::Failure;
use percute_workflow::choice::StepChoice;
use percute_workflow::export::{Export, Names, Request};
use percute_workflow::history::lacks;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// Writes fields of a history; the first file returned is the one to open. `choice` has steps, every k-th step or times
/// (s).
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn export(
    py: Python<'_>,
    history: &HistoryData,
    path: PathBuf,
    choice: (Option<Vec<i64>>, Option<usize>, Option<Vec<f64>>),
    fields: Option<Vec<String>>,
    error: Option<Vec<f64>>,
    inputs: Vec<PathBuf>,
    overwrite: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<PathBuf>> {
    let instants = if choice.2.is_some() { "`times`" } else { "`steps`" };
    let names = Names { path: "`path`", instants, fields: "`fields`", estimate: "`estimate`" };
    let lacks = history.run.file().and_then(lacks);
    let kept = history.run.file().and_then(|file| Some(file.thinned_steps()?.steps.clone()));
    let request = Request { lacks, kept, names, steps: chosen(choice), fields, error };
    let run = history.run.clone();
    let work = move |mut watch: Watch| -> Result<Vec<PathBuf>, Failure> {
        let stored = run.stored_source();
        let source = stored.as_ref().map_or(run.source(), |stored| stored as &dyn StepSource);
        let export = Export::new(&run.problem, source, &path, &request)?;
        let inputs: Vec<(&str, &Path)> = inputs.iter().map(|file| ("input", file.as_path())).collect();
        export.check("`path`", &inputs, overwrite)?;
        // A stop has an exception of its own.
        Ok(export.write(Overwrite::allowed(overwrite), &mut watch)?.unwrap_or_default())
    };
    bridge::blocking(py, progress, work)?.map_err(|error| match error {
        Failure::File(error) => errors::file(py, &error),
        Failure::Run(_) => errors::run(py, &error),
        error => errors::output(py, &error),
    })
}

fn chosen(choice: (Option<Vec<i64>>, Option<usize>, Option<Vec<f64>>)) -> StepChoice {
    match choice {
        (Some(steps), ..) => StepChoice::Steps(steps),
        (_, Some(every), _) => StepChoice::Every(every),
        (.., Some(times)) => StepChoice::Times(times),
        _ => StepChoice::All,
    }
}
