//! Case files.

use crate::any::{Any, each};
use crate::{door, errors};
use percute::case::{Case, CaseOf, Instants, Source};
use percute::writable;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Makes sure that a file can be made, which `what` names.
#[pyfunction]
pub(crate) fn check_writable(py: Python<'_>, what: &str, file: PathBuf) -> PyResult<()> {
    let refused = |cause: std::io::Error| errors::storage(py, &format!("{what}: {}: {cause}", file.display()));
    writable::check(&file).map_err(refused)
}

/// Whether two paths name one file, be it there or not.
#[pyfunction]
pub(crate) fn same_file(a: PathBuf, b: PathBuf) -> bool {
    writable::same(&a, &b)
}

/// A case, read and checked.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct CaseData {
    pub(crate) case: Any<Box<CaseOf<1, 2>>, Box<CaseOf<2, 3>>>,
}

#[pymethods]
impl CaseData {
    /// Reads the text of a case of this name.
    #[new]
    fn parse(py: Python<'_>, name: String, text: String) -> PyResult<Self> {
        let case = door::through(py, None, move |_| Case::parse(Source::new(name, text)))?;
        Ok(Self {
            case: match case.map_err(|error| errors::case(py, &error))? {
                Case::Bar(case) => Any::Bar(case),
                Case::Plane(case) => Any::Plane(case),
            },
        })
    }

    /// The files that the case asks for: history and estimate, and what the latter holds.
    fn outputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let output = each!(&self.case, case => &case.output);
        let asked = PyDict::new(py);
        asked.set_item("history", output.history.as_ref())?;
        asked.set_item("estimate", output.estimate.as_ref())?;
        match &output.instants {
            Instants::Count(count) => asked.set_item("instants", count)?,
            Instants::Times(times) => asked.set_item("instants", times)?,
        }
        asked.set_item("fields", output.fields)?;
        Ok(asked)
    }
}
