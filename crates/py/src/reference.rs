//! The true error of histories, against finer simulations.

use crate::any::AnyProblem;
use crate::bridge::Watch;
use crate::history::HistoryData;
use crate::problem::ProblemData;
use crate::run::{AnyRun, Run, Stoppable};
use crate::simulate::Times;
use crate::{bridge, errors, time, view};
use percute_core::dynamics::{replay, simulate};
use percute_core::problem::Problem;
use percute_core::simplex::ByDimension;
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion, TrueError, TrueErrorSample};
use percute_workflow::report::Named;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Sup, mean, and time, kinetic and elastic part and their sum at each instant.
pub(crate) type TrueErrorColumns<'py> = (f64, f64, Bound<'py, PyDict>);

/// The steps of a reference: of a history, or of a simulation whose steps are not kept.
#[derive(Clone)]
enum Source<const D: usize, const N: usize> {
    Kept(Arc<Run<D, N>>),
    Made(Arc<Problem<D, N>>, TimeGrid),
}

/// The true errors of histories against one history on a mesh in which theirs are nested.
#[pyfunction]
pub(crate) fn errors_against_history<'py>(
    py: Python<'py>,
    histories: Vec<PyRef<'_, HistoryData>>,
    reference: &HistoryData,
) -> PyResult<Vec<TrueErrorColumns<'py>>> {
    match &reference.run {
        ByDimension::Bar(run) => compared(py, bars(py, &histories)?, Source::Kept(run.clone()), None),
        ByDimension::Plane(run) => compared(py, planes(py, &histories)?, Source::Kept(run.clone()), None),
    }
}

/// The same against a simulation that is run now.
#[pyfunction]
pub(crate) fn errors_against_simulation<'py>(
    py: Python<'py>,
    histories: Vec<PyRef<'_, HistoryData>>,
    problem: &ProblemData,
    times: Times,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<TrueErrorColumns<'py>>> {
    let (end, courant, step, steps) = times;
    let times = time::grid(py, end, courant, step, steps, problem.critical_step(py)?)?;
    match &problem.problem {
        AnyProblem::Bar(fine) => compared(py, bars(py, &histories)?, Source::Made(fine.clone(), times), progress),
        AnyProblem::Plane(fine) => compared(py, planes(py, &histories)?, Source::Made(fine.clone(), times), progress),
    }
}

fn bars(py: Python<'_>, histories: &[PyRef<'_, HistoryData>]) -> PyResult<Vec<Arc<Run<1, 2>>>> {
    let bar = |history: &PyRef<'_, HistoryData>| match &history.run {
        AnyRun::Bar(run) => Ok(run.clone()),
        AnyRun::Plane(_) => Err(errors::input(py, "the reference is that of a bar, the history that of a plane body")),
    };
    histories.iter().map(bar).collect()
}

fn planes(py: Python<'_>, histories: &[PyRef<'_, HistoryData>]) -> PyResult<Vec<Arc<Run<2, 3>>>> {
    let plane = |history: &PyRef<'_, HistoryData>| match &history.run {
        AnyRun::Plane(run) => Ok(run.clone()),
        AnyRun::Bar(_) => Err(errors::input(py, "the reference is that of a plane body, the history that of a bar")),
    };
    histories.iter().map(plane).collect()
}

fn compared<'py, const D: usize, const N: usize>(
    py: Python<'py>,
    runs: Vec<Arc<Run<D, N>>>,
    reference: Source<D, N>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<TrueErrorColumns<'py>>> {
    let found = bridge::blocking(py, progress, move |watch| match &reference {
        Source::Kept(fine) => {
            let source = Stoppable { source: fine.source(), watch: watch.clone() };
            compare(&runs, &fine.problem, &watch, |sink| replay(&fine.problem, &source, sink).map_err(text))
        }
        Source::Made(fine, times) => compare(&runs, fine, &watch, |sink| {
            simulate(fine, times, sink, &mut watch.clone()).map(|_| ()).map_err(text)
        }),
    })?;
    let found = found.map_err(|message| errors::input(py, &format!("`reference`: {message}")))?;
    found.iter().map(|error| told(py, error)).collect()
}

/// Compares the motions of `runs` with the steps that `drive` hands to a comparison.
fn compare<const D: usize, const N: usize>(
    runs: &[Arc<Run<D, N>>],
    fine: &Problem<D, N>,
    watch: &Watch,
    drive: impl FnOnce(&mut Comparison<'_, D, N>) -> Result<(), String>,
) -> Result<Vec<TrueError>, String> {
    let mut motions = Vec::new();
    for run in runs {
        let mut motion = Motion::default();
        replay(&run.problem, &Stoppable { source: run.source(), watch: watch.clone() }, &mut motion).map_err(text)?;
        motions.push(motion);
    }
    let mut comparison = Comparison::new(fine);
    for (run, motion) in runs.iter().zip(&motions) {
        comparison.add(&run.problem, motion).map_err(text)?;
    }
    drive(&mut comparison)?;
    comparison.finish().map_err(text)
}

fn text(error: impl ToString) -> String {
    error.to_string()
}

/// A true error as Python takes it.
pub(crate) fn told<'py>(py: Python<'py>, error: &TrueError) -> PyResult<TrueErrorColumns<'py>> {
    let numbers: [Named<TrueErrorSample>; 4] =
        [("time", |s| s.time), ("kinetic", |s| s.kinetic), ("elastic", |s| s.elastic), ("total", |s| s.total())];
    let columns = view::columns(py, &error.over_time, &numbers)?;
    Ok((error.sup, error.mean, columns))
}
