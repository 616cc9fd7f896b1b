//! Histories: simulated, shown as arrays, put together again.

use crate::any::AnyProblem;
use crate::bridge::Watch;
use crate::options::Stated;
use crate::problem::ProblemData;
use crate::run::{AnyRun, Run};
use crate::{bridge, contact, errors, options, view};
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArray2, PyReadonlyArray3};
use percute_core::dynamics::Balance;
use percute_core::history::{History, Step};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_core::{each_dimension, map_dimension};
use percute_estimator::Options;
use percute_io::FileError;
use percute_io::history::HistoryFile;
use percute_workflow::report::Named;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A history of either dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct HistoryData {
    pub(crate) run: AnyRun,
}

#[pymethods]
impl HistoryData {
    /// A history put together from its arrays; `times` are the instants planned.
    #[staticmethod]
    fn from_arrays(
        py: Python<'_>,
        problem: &ProblemData,
        times: Vec<f64>,
        displacement: PyReadonlyArray3<'_, f64>,
        reaction: PyReadonlyArray3<'_, f64>,
        touching: PyReadonlyArray2<'_, bool>,
        options: Stated,
    ) -> PyResult<Self> {
        let (reconstruction, acceleration, every) = options;
        let times = TimeGrid::from_instants(times).map_err(|error| errors::input(py, error))?;
        let given = Given {
            options: options::options(py, &reconstruction, acceleration.as_deref(), &every)?,
            count: touching.as_array().nrows(),
            displacement: displacement.as_slice()?,
            reaction: reaction.as_slice()?,
            touching: touching.as_slice()?,
        };
        Ok(Self { run: map_dimension!(&problem.problem, p => Arc::new(given.run(py, p, &times)?)) })
    }

    #[getter]
    fn problem(&self) -> ProblemData {
        ProblemData::new(self.any_problem())
    }

    /// All instants planned (s).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.run, run => {
            let instants = run.times().instants().len();
            view::view(py, run, |r| r.times().instants(), &[instants])
        })
    }

    /// Number of instants held.
    #[getter]
    fn count(&self) -> usize {
        each_dimension!(&self.run, run => run.count())
    }

    #[getter]
    fn complete(&self) -> bool {
        each_dimension!(&self.run, run => run.count() == run.times().instants().len())
    }

    /// Arguments of `estimate` that it takes unless told otherwise.
    fn options(&self) -> Stated {
        options::stated(&each_dimension!(&self.run, run => run.options))
    }

    /// Nodes of the rows of reactions and touching status.
    #[getter]
    fn contact_nodes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        each_dimension!(&self.run, run => view::column(py, &run.contact_nodes(), |n| *n as i64))
    }

    /// The file that holds the steps, or none.
    #[getter]
    fn path(&self) -> Option<PathBuf> {
        each_dimension!(&self.run, run => run.file().map(|file| file.path().to_path_buf()))
    }

    /// Name, shape and first byte of each array in the file that can be mapped into memory.
    fn arrays(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, Vec<usize>, u64)>> {
        each_dimension!(&self.run, run => {
            let Some(file) = run.file().cloned() else { return Ok(Vec::new()) };
            let arrays = bridge::blocking(py, None, move |_| file.arrays())?.map_err(|error| errors::file(py, &error))?;
            Ok(arrays.into_iter().filter_map(|a| Some((a.name, a.shape, a.offset?))).collect())
        })
    }

    /// From memory as it is; from a file a copy.
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.run, run => match run.memory() {
            Some(_) => view::field(py, run, |r| r.memory().map_or(&[], History::displacement), &run.shape()),
            None => view::field(py, &read(py, run, HistoryFile::displacement)?, Vec::as_slice, &run.shape()),
        })
    }

    /// Likewise.
    fn reaction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each_dimension!(&self.run, run => match run.memory() {
            Some(_) => view::field(py, run, |r| r.memory().map_or(&[], History::reaction), &run.contact_shape()),
            None => view::field(py, &read(py, run, HistoryFile::reaction)?, Vec::as_slice, &run.contact_shape()),
        })
    }

    /// Likewise.
    fn touching<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        each_dimension!(&self.run, run => match run.memory() {
            Some(_) => view::view(py, run, |r| r.memory().map_or(&[], History::touching), &run.contact_shape()),
            None => view::view(py, &read(py, run, HistoryFile::touching)?, Vec::as_slice, &run.contact_shape()),
        })
    }

    /// Velocity and acceleration, derived now.
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 2]> {
        each_dimension!(&self.run, run => {
            let worker = run.clone();
            let derived = bridge::blocking(py, None, move |watch| worker.motion(watch))?;
            let motion = Arc::new(derived.map_err(|error| errors::steps(py, &error))?);
            Ok([
                view::field(py, &motion, |m| &m.velocity, &run.shape())?,
                view::field(py, &motion, |m| &m.acceleration, &run.shape())?,
            ])
        })
    }

    /// What contact did, computed now or before: arrays by name, see `python/percute/contact.py`.
    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        each_dimension!(&self.run, run => contact::arrays(py, &contact::of_run(py, run)?))
    }

    /// Energies, works and drifts at each instant.
    fn balance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        each_dimension!(&self.run, run => {
            let worker = run.clone();
            let kept = bridge::blocking(py, None, move |watch| worker.balance(watch).map(<[Balance]>::to_vec))?;
            columns(py, &kept.map_err(|error| errors::steps(py, &error))?)
        })
    }
}

impl HistoryData {
    fn any_problem(&self) -> AnyProblem {
        map_dimension!(&self.run, run => run.problem.clone())
    }
}

/// Bytes of a field that are read at once: enough for the disk, and soon done for who presses Ctrl-C.
const BLOCK: usize = 1 << 25;

/// Reads a field at all instants of a file, a block after the other.
fn read<const D: usize, const N: usize, T: Send + 'static>(
    py: Python<'_>,
    run: &Arc<Run<D, N>>,
    field: fn(&HistoryFile<D, N>, Range<usize>) -> Result<Vec<T>, FileError>,
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

/// An array for each quantity of the balance.
fn columns<'py>(py: Python<'py>, balance: &[Balance]) -> PyResult<Bound<'py, PyDict>> {
    let numbers: [Named<Balance>; 8] = [
        ("kinetic", |b| b.kinetic),
        ("strain", |b| b.strain),
        ("work_of_loads", |b| b.work_of_loads),
        ("work_of_supports", |b| b.work_of_supports),
        ("work_of_contact", |b| b.work_of_contact),
        ("friction", |b| b.friction),
        ("energy_drift", |b| b.energy_drift),
        ("impulse_drift", |b| b.impulse_drift),
    ];
    view::columns(py, balance, &numbers)
}

/// Arrays of a history.
struct Given<'a> {
    options: Options,
    count: usize,
    displacement: &'a [f64],
    reaction: &'a [f64],
    touching: &'a [bool],
}

impl Given<'_> {
    fn run<const D: usize, const N: usize>(
        &self,
        py: Python<'_>,
        problem: &Arc<Problem<D, N>>,
        times: &TimeGrid,
    ) -> PyResult<Run<D, N>> {
        let mut history = History::new(times);
        let (nodes, contact) = (problem.mesh().node_count(), problem.surface().nodes().len());
        for (index, &time) in times.instants().iter().enumerate().take(self.count) {
            let step = Step {
                index,
                time,
                displacement: rows(self.displacement.as_chunks().0, index, nodes),
                reaction: rows(self.reaction.as_chunks().0, index, contact),
                touching: rows(self.touching, index, contact),
                velocity: None,
                acceleration: None,
            };
            history.push(&step).map_err(|error| errors::input(py, error))?;
        }
        Ok(Run::new(problem.clone(), history, self.options, None))
    }
}

/// The rows of one step; too few if the array ends before.
fn rows<T>(array: &[T], step: usize, count: usize) -> &[T] {
    array.get(step * count..(step + 1) * count).unwrap_or_default()
}
