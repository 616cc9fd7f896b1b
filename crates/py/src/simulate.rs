//! Simulations, into memory or into a file.

use crate::bridge::Watch;
use crate::case::CaseData;
use crate::history::HistoryData;
use crate::problem::ProblemData;
use crate::run::{AnyRun, Growing, Run};
use crate::{bridge, errors, time};
use percute_core::dynamics::SimulationError;
use percute_core::history::Discard;
use percute_core::problem::Problem;
use percute_core::simplex::ByDimension;
use percute_core::time::TimeGrid;
use percute_core::{each_dimension, map_dimension};
use percute_estimator::Options;
use percute_io::{FileError, Overwrite};
use percute_workflow::Failure;
use percute_workflow::case::{CaseError, NotRepresentable, Source};
use percute_workflow::history::plan;
use percute_workflow::info::memory;
use percute_workflow::run::simulate_into;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use thiserror::Error;

/// What is done with a start that is refused, and with a run.
type Kind<'a, const D: usize, const N: usize> = (Refused<'a>, fn(Arc<Run<D, N>>) -> AnyRun);

/// How the instants are stated: end, courant, step, steps.
pub(crate) type Times = (Option<f64>, Option<f64>, Option<f64>, Option<Vec<f64>>);

/// Simulates. What is raised on the way has what was done as its `history`: the data, or the file.
#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    problem: &ProblemData,
    times: Times,
    store: Option<PathBuf>,
    overwrite: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<HistoryData> {
    let (end, courant, step, steps) = times;
    let times = time::grid(py, end, courant, step, steps, problem.critical_step(py)?)?;
    let store = store.map(|path| Store::new(path, overwrite, Options::default(), None));
    match &problem.problem {
        ByDimension::Bar(problem) => {
            one(py, problem, &times, Options::default(), store, progress, (&|_| None, ByDimension::Bar))
        }
        ByDimension::Plane(problem) => {
            one(py, problem, &times, Options::default(), store, progress, (&|_| None, ByDimension::Plane))
        }
    }
}

/// Simulates a case, likewise.
#[pyfunction]
pub(crate) fn simulate_case(
    py: Python<'_>,
    case: &CaseData,
    store: Option<PathBuf>,
    overwrite: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<HistoryData> {
    let (source, options) = each_dimension!(&case.case, case => (case.source.clone(), case.options));
    let store = store.map(|path| Store::new(path, overwrite, options, Some(source)));
    match &case.case {
        ByDimension::Bar(case) => {
            let kind: Kind<'_, 1, 2> = (&|error| case.refused_start(error), ByDimension::Bar);
            one(py, &Arc::new(case.problem.clone()), &case.times, options, store, progress, kind)
        }
        ByDimension::Plane(case) => {
            let kind: Kind<'_, 2, 3> = (&|error| case.refused_start(error), ByDimension::Plane);
            one(py, &Arc::new(case.problem.clone()), &case.times, options, store, progress, kind)
        }
    }
}

/// Plausibility warnings about a run; with `in_memory`, its history is kept in memory.
#[pyfunction]
pub(crate) fn plausibility_warnings(
    py: Python<'_>,
    problem: &ProblemData,
    times: Times,
    in_memory: bool,
) -> PyResult<Vec<String>> {
    let (end, courant, step, steps) = times;
    let times = time::grid(py, end, courant, step, steps, problem.critical_step(py)?)?;
    let (plausibility_warnings, needed, groups) = each_dimension!(&problem.problem, problem => {
        let history = if in_memory { memory::of_history(problem, &times) } else { 0 };
        let groups: Vec<_> = problem.statement().materials.iter().map(|(group, _)| group.clone()).collect();
        (percute_core::problem::plausibility_warnings(problem, &times), memory::of_run(problem, &times).saturating_add(history), groups)
    });
    let told = plausibility_warnings.into_iter().map(|plausibility_warning| {
        format!("`{}`: {}", errors::argument(plausibility_warning.place, &groups), plausibility_warning.message)
    });
    let scarce = memory::scarce(needed, memory::available(), in_memory).map(|message| format!("`mesh`: {message}"));
    Ok(told.chain(scarce).collect())
}

/// Opens the history in a file.
#[pyfunction]
pub(crate) fn open_history(py: Python<'_>, path: PathBuf) -> PyResult<HistoryData> {
    let opened = bridge::blocking(py, None, move |_| opened(&path))?;
    Ok(HistoryData { run: opened.map_err(|error| errors::failure(py, &error))? })
}

fn opened(path: &Path) -> Result<AnyRun, Failure> {
    let stored = percute_workflow::history::open(path)?;
    Ok(map_dimension!(stored, stored => Arc::new(Run::stored(*stored)?)))
}

/// A file to simulate into.
#[derive(Clone)]
struct Store {
    path: PathBuf,
    overwrite: bool,
    /// Options that its estimate takes unless told otherwise.
    options: Options,
    case: Option<Source>,
    /// Set as soon as the file is that of this run.
    ours: Arc<AtomicBool>,
}

impl Store {
    fn new(path: PathBuf, overwrite: bool, options: Options, case: Option<Source>) -> Self {
        Self { path, overwrite, options, case, ours: Arc::default() }
    }
}

/// Why a simulation into a file failed.
#[derive(Debug, Error)]
enum StoreError {
    #[error(transparent)]
    NotRepresentable(#[from] NotRepresentable),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

impl StoreError {
    fn raised(&self, py: Python<'_>, case: Refused<'_>) -> PyErr {
        match self {
            Self::NotRepresentable(error) => errors::input(py, &error.to_string()),
            Self::File(error) => errors::file(py, error),
            Self::Simulation(error) => raised(py, error, case),
        }
    }
}

/// The place in a case of a start that was refused.
type Refused<'a> = &'a dyn Fn(&SimulationError) -> Option<CaseError>;

fn raised(py: Python<'_>, error: &SimulationError, case: Refused<'_>) -> PyErr {
    case(error).map_or_else(|| errors::simulation(py, error), |mistake| errors::case(py, &mistake))
}

fn one<const D: usize, const N: usize>(
    py: Python<'_>,
    problem: &Arc<Problem<D, N>>,
    times: &TimeGrid,
    options: Options,
    store: Option<Store>,
    progress: Option<&Bound<'_, PyAny>>,
    kind: Kind<'_, D, N>,
) -> PyResult<HistoryData> {
    let Some(store) = store else { return into_memory(py, problem, times, options, progress, kind) };
    let work = {
        let (problem, times, store) = (problem.clone(), times.clone(), store.clone());
        move |watch| into_file(&problem, &times, &store, watch)
    };
    let outcome = bridge::blocking(py, progress, work);
    match outcome.and_then(|done| done.map_err(|error| error.raised(py, kind.0))) {
        Ok(()) => open_history(py, store.path),
        // To open it takes time that whoever pressed Ctrl-C does not have.
        Err(error) if store.ours.load(Relaxed) => Err(with_history(py, error, Some(store.path))),
        Err(error) => Err(error),
    }
}

fn into_file<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    store: &Store,
    mut watch: Watch,
) -> Result<(), StoreError> {
    let overwrite = Overwrite::allowed(store.overwrite);
    let plan = plan(problem, times, &store.options, store.case.as_ref())?;
    let writer = plan.create(&store.path, overwrite)?;
    store.ours.store(true, Relaxed);
    let done = simulate_into(problem, times, Some(writer), &mut Discard, &mut watch);
    if matches!(done, Err(SimulationError::StartsTooNear { .. })) {
        store.ours.store(false, Relaxed);
    }
    Ok(done.map(|_| ())?)
}

fn into_memory<const D: usize, const N: usize>(
    py: Python<'_>,
    problem: &Arc<Problem<D, N>>,
    times: &TimeGrid,
    options: Options,
    progress: Option<&Bound<'_, PyAny>>,
    (case, either): Kind<'_, D, N>,
) -> PyResult<HistoryData> {
    let growing = Growing::new(times);
    let work = {
        let (problem, times, mut sink) = (problem.clone(), times.clone(), growing.clone());
        move |mut watch: Watch| percute_core::dynamics::simulate(&problem, &times, &mut sink, &mut watch)
    };
    let outcome = bridge::blocking(py, progress, work);
    let kept = growing.take();
    let data = |history, balance| {
        let run = Run::new(problem.clone(), history, options, balance);
        HistoryData { run: either(Arc::new(run)) }
    };
    match outcome.and_then(|done| done.map_err(|error| raised(py, &error, case))) {
        Ok(simulation) => kept
            .map(|history| data(history, Some(simulation.balance_over_time)))
            .ok_or_else(|| errors::percute_error(py, "internal error: a simulation without steps")),
        Err(error) => Err(with_history(py, error, kept.map(|history| data(history, None)))),
    }
}

/// Hangs what was done on an exception: the history, or its file.
fn with_history<'py>(py: Python<'py>, error: PyErr, history: Option<impl IntoPyObject<'py>>) -> PyErr {
    if let Some(history) = history {
        // One that takes no attributes is raised all the same.
        let _ = error.value(py).setattr("history", history);
    }
    error
}
