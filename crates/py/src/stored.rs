//! Estimates in files.

use crate::mesh::MeshData;
use crate::{bridge, contact, errors, view};
use numpy::{IntoPyArray, PyArrayDyn, PyArrayMethods};
use percute_core::mesh::Mesh;
use percute_estimator::Sample;
use percute_io::estimate_file::{self, Field};
use percute_io::{Kind, kind};
use percute_workflow::report::PARTS;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// What an estimate file holds, all of it checked.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct EstimateFileData {
    path: PathBuf,
    mesh: Arc<Mesh>,
    over_time: Vec<Sample>,
    by_element: Arc<Vec<f64>>,
    report: String,
}

#[pymethods]
impl EstimateFileData {
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let name = path.clone();
        let file = bridge::blocking(py, None, move |_| estimate_file::open(&name))?;
        let file = file.map_err(|error| errors::file(py, &error))?;
        let mesh = file.mesh.into();
        let (over_time, by_element) = (file.over_time, Arc::new(file.by_element));
        Ok(Self { path, mesh, over_time, by_element, report: file.report })
    }

    fn mesh(&self) -> MeshData {
        MeshData { mesh: self.mesh.clone() }
    }

    /// The document of `--json`.
    fn report(&self) -> &str {
        &self.report
    }

    /// η, its parts and d at all samples, an array each.
    fn over_time<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        view::columns(py, &self.over_time, &PARTS)
    }

    fn by_element<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        view::view(py, &self.by_element, |e| e.as_slice(), &[self.by_element.len()])
    }

    /// What contact did, read now; none if the file does not hold it.
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let path = self.path.clone();
        let found = bridge::blocking(py, None, move |_| estimate_file::contact(&path))?;
        Ok(match found.map_err(|error| errors::file(py, &error))? {
            None => None,
            Some(results) => Some(contact::arrays(py, &Arc::new(results))?),
        })
    }

    /// Instants of the maps, and the data sets of their fields with a row for each instant, read now.
    fn maps<'py>(&self, py: Python<'py>) -> PyResult<(Vec<f64>, Bound<'py, PyDict>)> {
        let path = self.path.clone();
        let maps = bridge::blocking(py, None, move |_| estimate_file::maps(&path))?;
        let maps = maps.map_err(|error| errors::file(py, &error))?;
        let fields = PyDict::new(py);
        for Field { name, shape, values } in maps.fields {
            let array = values.into_pyarray(py).reshape(shape)?;
            array.readwrite().make_nonwriteable();
            fields.set_item(name, array)?;
        }
        Ok((maps.instants, fields))
    }
}

/// Whether a file holds an estimate; else it may hold a history.
#[pyfunction]
pub(crate) fn is_estimate(py: Python<'_>, path: PathBuf) -> PyResult<bool> {
    let found = bridge::blocking(py, None, move |_| kind(&path))?;
    found.map(|found| found == Kind::Estimate).map_err(|error| errors::file(py, &error))
}
