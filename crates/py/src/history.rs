//! Histories: simulated, shown as arrays, put together again.

use crate::any::{Any, AnyProblem, each, map};
use crate::door::Watch;
use crate::problem::ProblemData;
use crate::run::{AnyRun, Growing, Run};
use crate::{door, errors, time, view};
use numpy::{PyArrayDyn, PyReadonlyArray2, PyReadonlyArray3};
use percute_core::dynamics::Balance;
use percute_core::history::{History, Step, StepSink, StepSource};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// A history of either dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct HistoryData {
    pub(crate) run: AnyRun,
}

/// Simulates and keeps all steps in memory. What is raised on the way has what was done as its `history`.
#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    problem: &ProblemData,
    end: Option<f64>,
    courant: Option<f64>,
    step: Option<f64>,
    steps: Option<Vec<f64>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<HistoryData> {
    let times = time::grid(py, end, courant, step, steps, problem.critical_step(py)?)?;
    let run = match &problem.problem {
        Any::Bar(problem) => simulate_one(py, problem, &times, progress, Any::Bar)?,
        Any::Plane(problem) => simulate_one(py, problem, &times, progress, Any::Plane)?,
    };
    Ok(HistoryData { run })
}

fn simulate_one<const D: usize, const N: usize>(
    py: Python<'_>,
    problem: &Arc<Problem<D, N>>,
    times: &TimeGrid,
    progress: Option<&Bound<'_, PyAny>>,
    either: fn(Arc<Run<D, N>>) -> AnyRun,
) -> PyResult<AnyRun> {
    let growing = Growing::new(times);
    let work = {
        let (problem, times, mut sink) = (problem.clone(), times.clone(), growing.clone());
        move |mut watch: Watch| percute_core::dynamics::simulate(&problem, &times, &mut sink, &mut watch)
    };
    let outcome = door::through(py, progress, work);
    let kept = growing.take();
    let run = |history, balance| either(Arc::new(Run::new(problem.clone(), history, balance)));
    let error = match outcome.map(|done| done.map_err(|error| errors::simulation(py, &error))) {
        Ok(Ok(simulation)) => {
            let history = kept.ok_or_else(|| errors::percute_error(py, "internal error: no history"))?;
            return Ok(run(history, Some(simulation.balance_over_time)));
        }
        Ok(Err(error)) | Err(error) => error,
    };
    if let Some(history) = kept {
        // An exception that takes no attributes is raised all the same.
        let _ = error.value(py).setattr("history", HistoryData { run: run(history, None) });
    }
    Err(error)
}

#[pymethods]
impl HistoryData {
    /// A history put together from its arrays; `times` are the instants planned.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    fn from_arrays(
        py: Python<'_>,
        problem: &ProblemData,
        times: Vec<f64>,
        displacement: PyReadonlyArray3<'_, f64>,
        reaction: PyReadonlyArray3<'_, f64>,
        touching: PyReadonlyArray2<'_, bool>,
        velocity: Option<PyReadonlyArray3<'_, f64>>,
        acceleration: Option<PyReadonlyArray3<'_, f64>>,
    ) -> PyResult<Self> {
        let times = TimeGrid::from_instants(times).map_err(|error| errors::time(py, &error))?;
        let fields = [Some(&displacement), Some(&reaction), velocity.as_ref(), acceleration.as_ref()];
        let rows = fields.map(|field| field.map(|f| f.as_slice()).transpose());
        let [displacement, reaction, velocity, acceleration] = rows;
        let given = Given {
            count: touching.as_array().nrows(),
            fields: [displacement?, reaction?, velocity?, acceleration?],
            touching: touching.as_slice()?,
        };
        Ok(Self { run: map!(&problem.problem, p => Arc::new(given.run(py, p, &times)?)) })
    }

    #[getter]
    fn problem(&self) -> ProblemData {
        ProblemData::new(self.any_problem())
    }

    /// All instants planned (s).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each!(&self.run, run => {
            let instants = run.history.times().instants().len();
            view::view(py, run, |r| r.history.times().instants(), &[instants])
        })
    }

    /// Number of instants held.
    #[getter]
    fn count(&self) -> usize {
        each!(&self.run, run => run.history.count())
    }

    #[getter]
    fn complete(&self) -> bool {
        each!(&self.run, run => run.complete)
    }

    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each!(&self.run, run => view::field(py, run, |r| r.history.displacement(), &run.shape()))
    }

    #[getter]
    fn reaction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        each!(&self.run, run => view::field(py, run, |r| r.history.reaction(), &run.contact_shape()))
    }

    #[getter]
    fn touching<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        each!(&self.run, run => view::view(py, run, |r| r.history.touching(), &run.contact_shape()))
    }

    /// Velocity and acceleration, derived now.
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArrayDyn<f64>>; 2]> {
        each!(&self.run, run => {
            let worker = run.clone();
            let derived = door::through(py, None, move |watch| worker.motion(watch))?;
            let motion = Arc::new(derived.map_err(|error| errors::percute_error(py, &error.to_string()))?);
            Ok([
                view::field(py, &motion, |m| &m.velocity, &run.shape())?,
                view::field(py, &motion, |m| &m.acceleration, &run.shape())?,
            ])
        })
    }

    /// Energies, works and drifts at each instant.
    fn balance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        each!(&self.run, run => {
            let worker = run.clone();
            let kept = door::through(py, None, move |watch| worker.balance(watch).map(<[Balance]>::to_vec))?;
            columns(py, &kept.map_err(|error| errors::percute_error(py, &error.to_string()))?)
        })
    }
}

impl HistoryData {
    fn any_problem(&self) -> AnyProblem {
        map!(&self.run, run => run.problem.clone())
    }
}

/// An array for each quantity of the balance.
fn columns<'py>(py: Python<'py>, balance: &[Balance]) -> PyResult<Bound<'py, PyDict>> {
    let quantities: [(&str, fn(&Balance) -> f64); 8] = [
        ("kinetic", |b| b.kinetic),
        ("strain", |b| b.strain),
        ("work_of_loads", |b| b.work_of_loads),
        ("work_of_supports", |b| b.work_of_supports),
        ("work_of_contact", |b| b.work_of_contact),
        ("friction", |b| b.friction),
        ("energy_drift", |b| b.energy_drift),
        ("impulse_drift", |b| b.impulse_drift),
    ];
    let columns = PyDict::new(py);
    for (name, quantity) in quantities {
        columns.set_item(name, view::column(py, balance, quantity))?;
    }
    Ok(columns)
}

/// Arrays of a history: displacement, reaction, velocity, acceleration.
struct Given<'a> {
    count: usize,
    fields: [Option<&'a [f64]>; 4],
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
        let contact = problem.surface().nodes().len();
        for index in 0..self.count {
            let rows = |field: usize, nodes: usize| {
                self.fields[field]
                    .map(|f| f.as_chunks::<D>().0.get(index * nodes..(index + 1) * nodes).unwrap_or_default())
            };
            let nodes = problem.mesh().node_count();
            let step = Step {
                index,
                time: times.instants().get(index).copied().unwrap_or(f64::NAN),
                displacement: rows(0, nodes).unwrap_or_default(),
                reaction: rows(1, contact).unwrap_or_default(),
                touching: self.touching.get(index * contact..(index + 1) * contact).unwrap_or_default(),
                velocity: rows(2, nodes),
                acceleration: rows(3, nodes),
            };
            history.push(&step).map_err(|error| errors::input(py, &error.to_string()))?;
        }
        Ok(Run::new(problem.clone(), history, None))
    }
}
