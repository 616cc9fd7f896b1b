//! The evidence, computed again.

use crate::{bridge, errors};
use percute::reproduce::{Effort, ReproduceError, Reproduction, parts};
use percute_core::observer::Observer;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Writes the evidence and gives the name of its page. Parts that are done stay, whatever is raised on the way.
#[pyfunction]
pub(crate) fn reproduce(
    py: Python<'_>,
    folder: PathBuf,
    names: Vec<String>,
    small: bool,
    overwrite: bool,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PathBuf> {
    let effort = Effort { small, threads };
    let made = bridge::blocking(py, progress, move |mut watch| all(&folder, &names, effort, overwrite, &mut watch))?;
    made.map_err(|error| errors::reproduce(py, &error))
}

fn all(
    folder: &std::path::Path,
    names: &[String],
    effort: Effort,
    overwrite: bool,
    observer: &mut dyn Observer,
) -> Result<PathBuf, ReproduceError> {
    let parts = parts(names)?;
    let mut reproduction = Reproduction::begin(folder, effort, overwrite)?;
    parts.iter().try_for_each(|part| reproduction.make(part, observer))?;
    Ok(reproduction.page())
}
