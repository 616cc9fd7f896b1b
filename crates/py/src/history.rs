//! Histories: simulated, shown as arrays, put together again.

use crate::bridge::Watch;
use crate::history_arrays::{HistoryArrays, slice};
use crate::options::Stated;
use crate::problem::ProblemData;
use crate::run::Run;
use crate::stored_fields::{read, stored_acceleration, stored_velocity};
use crate::{balance, bridge, contact, errors, options, view};
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArray2, PyReadonlyArray3};
use percute_core::history::History;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_io::history::HistoryFile;
use percute_io::{FileError, Overwrite};
use percute_workflow::foreign::{Derived, Origin};
use percute_workflow::history::lacks;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// A history of either dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct HistoryData {
    pub(crate) run: Arc<Run>,
}

#[pymethods]
impl HistoryData {
    /// A history put together from its arrays; `times` are the instants planned. With `origin`, the program that
    /// simulated and the names of the parts that were derived before, it is one of another program.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    fn from_arrays(
        py: Python<'_>,
        problem: &ProblemData,
        times: Vec<f64>,
        displacement: PyReadonlyArray3<'_, f64>,
        reaction: PyReadonlyArray3<'_, f64>,
        touching: PyReadonlyArray2<'_, bool>,
        options: Stated,
        motion: (Option<PyReadonlyArray3<'_, f64>>, Option<PyReadonlyArray3<'_, f64>>),
        origin: Option<(Option<String>, Vec<String>)>,
    ) -> PyResult<Self> {
        problem.check_planes(py)?;
        let times = TimeGrid::from_instants(times).map_err(|error| errors::input(py, error))?;
        let arrays = HistoryArrays {
            count: touching.as_array().nrows(),
            displacement: displacement.as_slice()?,
            reaction: Some(reaction.as_slice()?),
            touching: Some(touching.as_slice()?),
            motion: [slice(motion.0.as_ref())?, slice(motion.1.as_ref())?],
        };
        let options = stated(py, &options)?;
        let origin = origin.map(|(program, names)| {
            let derived = names.iter().filter_map(|name| Derived::of_name(name)).collect();
            Origin { program, derived, ..Origin::default() }
        });
        Ok(Self { run: Arc::new(arrays.run(py, &problem.problem, &times, options, origin)?) })
    }

    /// A history of another program; its missing parts are derived. With it the last instant (s), if it was left out.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    fn foreign(
        py: Python<'_>,
        problem: &ProblemData,
        times: Vec<f64>,
        displacement: PyReadonlyArray3<'_, f64>,
        reaction: Option<PyReadonlyArray3<'_, f64>>,
        touching: Option<PyReadonlyArray2<'_, bool>>,
        velocity: Option<PyReadonlyArray3<'_, f64>>,
        acceleration: Option<PyReadonlyArray3<'_, f64>>,
        program: Option<String>,
    ) -> PyResult<(Self, Option<String>)> {
        problem.check_planes(py)?;
        let times = TimeGrid::from_instants(times).map_err(|error| errors::input(py, format!("`time`: {error}")))?;
        let arrays = HistoryArrays {
            count: times.instants().len(),
            displacement: displacement.as_slice()?,
            reaction: slice(reaction.as_ref())?,
            touching: touching.as_ref().map(PyReadonlyArray2::as_slice).transpose()?,
            motion: [slice(velocity.as_ref())?, slice(acceleration.as_ref())?],
        };
        let (run, left_out) = arrays.completed(py, &problem.problem, &times, program)?;
        Ok((Self { run: Arc::new(run) }, left_out.map(percute_workflow::report::left_out)))
    }

    /// Names of the parts that were derived; none for a history of percute.
    #[getter]
    fn derived(&self) -> Option<Vec<&'static str>> {
        let origin = self.run.origin.as_ref()?;
        Some(origin.derived.iter().map(|derived| derived.name()).collect())
    }

    /// The program that simulated a history of another program, if its name is known.
    #[getter]
    fn program(&self) -> Option<String> {
        self.run.origin.as_ref().and_then(|origin| origin.program.clone())
    }

    /// Writes a history that is in memory into a file.
    fn save(&self, py: Python<'_>, path: PathBuf, overwrite: bool) -> PyResult<()> {
        let overwrite = Overwrite::allowed(overwrite);
        let run = self.run.clone();
        let saved = bridge::writing(py, None, move |watch, open| {
            let saved = run.save(&path, overwrite, watch);
            drop(open);
            saved
        });
        saved?.map_err(|failure| errors::failure(py, &failure))
    }

    /// Whether it has velocities and accelerations of its own.
    #[getter]
    fn supplied(&self) -> [bool; 2] {
        self.run.supplied()
    }

    #[getter]
    fn problem(&self) -> ProblemData {
        ProblemData::new(self.any_problem())
    }

    /// All instants planned (s).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        {
            let run = &self.run;
            let instants = run.times().instants().len();
            view::view(py, run, |r| r.times().instants(), &[instants])
        }
    }

    /// Number of instants held.
    #[getter]
    fn count(&self) -> usize {
        self.run.count()
    }

    #[getter]
    fn complete(&self) -> bool {
        self.run.count() == self.run.times().instants().len()
    }

    /// Arguments of `estimate` that it takes unless told otherwise.
    fn options(&self) -> Stated {
        options::stated(&self.run.options)
    }

    /// Nodes of the rows of reactions and touching status.
    #[getter]
    fn contact_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        view::column(py, &self.run.contact_nodes(), |n| *n as i64)
    }

    /// The file that holds the steps, or none.
    #[getter]
    fn path(&self) -> Option<PathBuf> {
        self.run.file().map(|file| file.path().to_path_buf())
    }

    /// Name, shape and first byte of each array in the file that can be mapped into memory.
    fn arrays(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, Vec<usize>, u64)>> {
        let Some(file) = self.run.file().cloned() else { return Ok(Vec::new()) };
        let arrays = bridge::blocking(py, None, move |_| file.arrays())?.map_err(|error| errors::file(py, &error))?;
        Ok(arrays.into_iter().filter_map(|a| Some((a.name, a.shape, a.offset?))).collect())
    }

    /// Compares vectors at some instants that were read by mapping with their checksums, a row for each instant.
    fn check_mapped(
        &self,
        py: Python<'_>,
        field: &str,
        steps: Vec<usize>,
        values: PyReadonlyArray3<'_, f64>,
        sums: PyReadonlyArray2<'_, i64>,
    ) -> PyResult<()> {
        let (values, sums) = (values.as_slice()?, sums.as_slice()?);
        let checked = self.run.file().map_or(Ok(()), |file| file.check_mapped(field, &steps, values, sums));
        checked.map_err(|error| errors::file(py, &error))
    }

    /// The same of touching status.
    fn check_mapped_flags(
        &self,
        py: Python<'_>,
        steps: Vec<usize>,
        values: PyReadonlyArray2<'_, u8>,
        sums: PyReadonlyArray2<'_, i64>,
    ) -> PyResult<()> {
        let (values, sums) = (values.as_slice()?, sums.as_slice()?);
        let checked = self.run.file().map_or(Ok(()), |file| file.check_mapped_flags(&steps, values, sums));
        checked.map_err(|error| errors::file(py, &error))
    }

    /// From memory as it is; from a file a copy.
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = self.run.shape_of_motion();
        match self.run.memory() {
            Some(_) => view::view(py, &self.run, |r| r.memory().map_or(&[], History::displacement), &shape),
            None => view::view(py, &read(py, &self.run, HistoryFile::displacement)?, Vec::as_slice, &shape),
        }
    }

    /// Likewise.
    fn reaction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let [count, nodes] = self.run.contact_shape();
        let shape = [count, nodes, self.run.problem.dimension()];
        match self.run.memory() {
            Some(_) => view::view(py, &self.run, |r| r.memory().map_or(&[], History::reaction), &shape),
            None => view::view(py, &read(py, &self.run, HistoryFile::reaction)?, Vec::as_slice, &shape),
        }
    }

    /// Likewise.
    fn touching<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        let shape = self.run.contact_shape();
        match self.run.memory() {
            Some(_) => view::view(py, &self.run, |r| r.memory().map_or(&[], History::touching), &shape),
            None => view::view(py, &read(py, &self.run, HistoryFile::touching)?, Vec::as_slice, &shape),
        }
    }

    /// Number of internal variables of an element; 0 where no material yields.
    #[getter]
    fn variables(&self) -> usize {
        self.run.problem.variables()
    }

    /// Internal variables at some instants, (instants, elements, variables); a copy.
    fn internal<'py>(&self, py: Python<'py>, steps: Vec<usize>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (elements, count) = (self.run.problem.mesh().element_count(), self.run.problem.variables());
        let (run, row, shape) = (self.run.clone(), elements * count, [steps.len(), elements, count]);
        let work = move |watch: Watch| {
            let mut all = Vec::with_capacity(row * steps.len());
            for &n in &steps {
                match (run.memory(), run.file()) {
                    _ if watch.0.stopped() => break,
                    (Some(history), _) => all.extend_from_slice(&history.internal()[n * row..(n + 1) * row]),
                    (None, Some(file)) => all.extend(file.plastic(n..n + 1)?),
                    (None, None) => {}
                }
            }
            Ok::<_, FileError>(all)
        };
        let all = bridge::blocking(py, None, work)?.map_err(|error| errors::file(py, &error))?;
        view::view(py, &Arc::new(all), Vec::as_slice, &shape)
    }

    /// The number of each instant in the run of a thinned history; none for one with all steps.
    fn steps<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<i64>>> {
        let kept = self.run.file()?.thinned_steps()?;
        Some(view::column(py, &kept.steps[..self.run.count()], |n| *n as i64))
    }

    /// Fields that a thinned history lacks.
    fn lacks(&self) -> Vec<&'static str> {
        self.run.file().and_then(lacks).unwrap_or_default()
    }

    /// The velocity or, with `acceleration`, the acceleration that a thinned history has; from its file.
    fn stored_motion<'py>(&self, py: Python<'py>, acceleration: bool) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let field = if acceleration { stored_acceleration } else { stored_velocity };
        view::view(py, &read(py, &self.run, field)?, Vec::as_slice, &self.run.shape_of_motion())
    }

    /// Velocity and acceleration, derived now.
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 2]> {
        let worker = self.run.clone();
        let derived = bridge::blocking(py, None, move |watch| worker.motion(watch))?;
        let motion = Arc::new(derived.map_err(|error| errors::steps(py, &error))?);
        let shape = self.run.shape_of_motion();
        Ok([
            view::view(py, &motion, |m| m.velocity.as_slice(), &shape)?,
            view::view(py, &motion, |m| m.acceleration.as_slice(), &shape)?,
        ])
    }

    /// What contact did, computed now or before: arrays by name, see `python/percute/contact.py`.
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        contact::arrays(py, &contact::of_run(py, &self.run)?)
    }

    /// Energies, works and drifts at each instant.
    fn balance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        balance::columns(py, &balance::results(py, &self.run)?)
    }

    /// Velocities before and after contact, of one body and of several, as a JSON document.
    fn rebound(&self, py: Python<'_>) -> PyResult<String> {
        balance::rebound(py, &self.run)
    }
}

impl HistoryData {
    fn any_problem(&self) -> AnyProblem {
        self.run.problem.clone()
    }
}

fn stated(py: Python<'_>, (reconstruction, acceleration, every): &Stated) -> PyResult<Options> {
    options::options(py, reconstruction, acceleration.as_deref(), every)
}
