//! Case files.

use crate::any::{Any, each};
use crate::{door, errors};
use percute::case::{Case, CaseOf, Source};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

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

    /// Arguments of `estimate` that the case states.
    fn options<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let options = each!(&self.case, case => case.options);
        let arguments = PyDict::new(py);
        arguments.set_item("contact_force", options.contact_force.to_string())?;
        arguments.set_item("acceleration", options.acceleration.to_string())?;
        arguments.set_item("every", options.every)?;
        Ok(arguments)
    }

    /// The files that the case asks for: history and estimate.
    fn outputs(&self) -> (Option<PathBuf>, Option<PathBuf>) {
        each!(&self.case, case => (case.output.history.clone(), case.output.estimate.clone()))
    }
}
