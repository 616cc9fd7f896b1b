//! Fields at all instants, read from the file of a history.

use crate::bridge::Watch;
use crate::run::Run;
use crate::{bridge, errors};
use percute_io::FileError;
use percute_io::history::HistoryFile;
use pyo3::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// The velocities of a thinned history.
pub(crate) fn stored_velocity(file: &HistoryFile, steps: Range<usize>) -> Result<Vec<f64>, FileError> {
    Ok(file.velocity(steps)?.unwrap_or_default())
}

/// Its accelerations.
pub(crate) fn stored_acceleration(file: &HistoryFile, steps: Range<usize>) -> Result<Vec<f64>, FileError> {
    Ok(file.acceleration(steps)?.unwrap_or_default())
}

/// Bytes of a field that are read at once: enough for the disk, and soon done after Ctrl-C.
const BLOCK: usize = 1 << 25;

/// Reads a field at all instants of a file, a block after the other.
pub(crate) fn read<T: Send + 'static>(
    py: Python<'_>,
    run: &Arc<Run>,
    field: fn(&HistoryFile, Range<usize>) -> Result<Vec<T>, FileError>,
) -> PyResult<Arc<Vec<T>>> {
    let run = run.clone();
    let work = move |watch: Watch| {
        let mut rows = Vec::new();
        let [count, nodes] = run.shape();
        let steps = (BLOCK / (nodes * size_of::<T>()).max(1)).max(1);
        for start in (0..count).step_by(steps) {
            match run.file() {
                Some(file) if !watch.0.stopped() => rows.extend(field(file, start..count.min(start + steps))?),
                _ => break,
            }
        }
        Ok(rows)
    };
    bridge::blocking(py, None, work)?.map(Arc::new).map_err(|error| errors::file(py, &error))
}
