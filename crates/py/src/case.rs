//! Case files.

use crate::{bridge, errors};
use percute_workflow::Failure;
use percute_workflow::case::{Case, Instants, Source, parse};
use percute_workflow::effort::Long;
use percute_workflow::outputs;
use percute_workflow::run::{located, resolved};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// What a file is, if it is no case.
#[pyfunction]
pub(crate) fn stranger(file: PathBuf, content: &[u8]) -> Option<String> {
    percute_workflow::case::stranger(&file, content)
}

/// A case, read and checked.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct CaseData {
    pub(crate) case: Case,
}

#[pymethods]
impl CaseData {
    /// Reads the text of a case of this name; the files that it reads are relative to `folder`.
    #[new]
    fn parse(py: Python<'_>, name: String, text: String, folder: PathBuf) -> PyResult<Self> {
        let case = bridge::blocking(py, None, move |_| parse(Source::new(name, text).in_folder(folder)))?;
        Ok(Self { case: case.map_err(|error| errors::input(py, error))? })
    }

    /// The case with the end of its run, that of one which ends with the rebound is looked for; with a warning if
    /// contact does not end.
    fn resolved(&self, py: Python<'_>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<(Self, Option<String>)> {
        let case = self.case.clone();
        let work = move |mut watch: bridge::Watch| -> Result<Option<Case>, Failure> {
            resolved(&case, &mut watch).map_err(|failure| located(&case, failure))
        };
        let found = bridge::blocking(py, progress, work)?.map_err(|error| errors::run(py, &error))?;
        let case = found.ok_or_else(|| errors::percute_error(py, "the search for the rebound was stopped"))?;
        let told = case.unended.as_ref().map(|warning| warning.message.clone());
        Ok((Self { case }, told))
    }

    /// Refuses a start that the simulation would refuse, and a long run unless `long` says so.
    fn check_run(&self, py: Python<'_>, long: bool) -> PyResult<()> {
        let long = Long::asked(long, "`long=True`");
        self.case.check_run(true, long).map_err(|error| errors::input(py, error))
    }

    /// Its plausibility warnings; with `in_memory`, its history is kept in memory.
    fn plausibility_warnings(&self, in_memory: bool) -> Vec<String> {
        self.case
            .plausibility_warnings(in_memory)
            .into_iter()
            .map(|plausibility_warning| plausibility_warning.message)
            .collect()
    }

    /// The import warnings of its mesh.
    fn import_warnings(&self) -> Vec<String> {
        let warnings = self.case.problem.mesh().import_warnings();
        warnings.iter().map(|warning| warning.message.clone()).collect()
    }

    /// The files of a run, checked before any work: the history in `store` or as the case says, and the estimate,
    /// with what it holds. `case` is the case file.
    fn outputs<'py>(
        &self,
        py: Python<'py>,
        case: Option<PathBuf>,
        store: Option<PathBuf>,
        overwrite: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let output = &self.case.output;
        let chosen = [
            outputs::chosen(["`store`", "[output] history"], store.as_deref(), output.history.as_deref()),
            outputs::chosen(["", "[output] estimate"], None, output.estimate.as_deref()),
        ];
        let made = chosen.map(|file| file.is_some());
        self.case.check_files(made[0], made[1]).map_err(|error| errors::input(py, error))?;
        let inputs = self.case.inputs(case.as_deref());
        let checked = outputs::check(&inputs, &chosen, overwrite).and_then(|()| outputs::check_endings(&chosen));
        checked.map_err(|error| errors::output(py, &error))?;
        let asked = PyDict::new(py);
        for (name, file) in ["history", "estimate"].into_iter().zip(chosen) {
            asked.set_item(name, file.map(|output| output.file))?;
        }
        match &output.instants {
            Instants::Count(count) => asked.set_item("instants", count)?,
            Instants::Times(times) => asked.set_item("instants", times)?,
        }
        asked.set_item("fields", output.fields)?;
        Ok(asked)
    }
}
