//! The true error of histories, against finer simulations.

use crate::history::HistoryData;
use crate::problem::ProblemData;
use crate::run::Run;
use crate::simulate::{Times, instants};
use crate::{bridge, errors, view};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::reference::{ReferenceError, TrueError, TrueErrorSample};
use percute_workflow::Failure;
use percute_workflow::report::{Named, drifted};
use percute_workflow::run::{Meshes, true_errors};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Sup, mean, and time, kinetic, elastic and plastic part and their sum at each instant.
pub(crate) type TrueErrorColumns<'py> = (f64, f64, Bound<'py, PyDict>);

/// The true errors of histories against one history, with `nested` on a mesh in which theirs are nested.
#[pyfunction]
pub(crate) fn errors_against_history<'py>(
    py: Python<'py>,
    histories: Vec<PyRef<'_, HistoryData>>,
    reference: &HistoryData,
    nested: bool,
) -> PyResult<Vec<TrueErrorColumns<'py>>> {
    let meshes = if nested { Meshes::Nested } else { Meshes::Any };
    let run = &reference.run;
    let fine = (run.problem.clone(), run.times().clone());
    compared(py, &histories, fine, Some(run.clone()), meshes, None).map(|(errors, _)| errors)
}

/// The same against a simulation that is run now, with the warning of its energy balance.
#[pyfunction]
pub(crate) fn errors_against_simulation<'py>(
    py: Python<'py>,
    histories: Vec<PyRef<'_, HistoryData>>,
    problem: &ProblemData,
    times: Times,
    nested: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Vec<TrueErrorColumns<'py>>, Option<String>)> {
    let meshes = if nested { Meshes::Nested } else { Meshes::Any };
    let times = instants(py, problem, times, progress)?;
    compared(py, &histories, (problem.problem.clone(), times), None, meshes, progress)
}

/// Compares histories with the steps of `kept`; without it, with a simulation of the reference, which may give a
/// warning.
fn compared<'py>(
    py: Python<'py>,
    histories: &[PyRef<'_, HistoryData>],
    (fine, times): (AnyProblem, TimeGrid),
    kept: Option<Arc<Run>>,
    meshes: Meshes,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Vec<TrueErrorColumns<'py>>, Option<String>)> {
    if histories.iter().any(|history| history.run.problem.dimension() != fine.dimension()) {
        let told = "the reference is a body of another dimension than that of the history";
        return Err(errors::input(py, told));
    }
    let runs: Vec<_> = histories.iter().map(|history| history.run.clone()).collect();
    let varies = times.varies();
    let found = bridge::blocking(py, progress, move |mut watch| {
        let sources: Vec<_> = runs.iter().map(|run| run.stoppable(watch.clone())).collect();
        let runs: Vec<_> = runs.iter().zip(&sources).map(|(run, source)| (&run.problem, source as _)).collect();
        let steps = kept.as_ref().map(|kept| kept.stoppable(watch.clone()));
        true_errors(&runs, (&fine, &times), steps.as_ref().map(|steps| steps as _), meshes, &mut watch)
    })?;
    let (found, simulation) = found.map_err(|failure| match failure {
        Failure::Reference(error @ ReferenceError::NotNested { .. }) => errors::input(
            py,
            format!("`reference`: {error}; or give nested=False, which evaluates the fields by location"),
        ),
        Failure::Reference(error) => errors::input(py, format!("`reference`: {error}")),
        failure => errors::run(py, &failure),
    })?;
    let drift = simulation.and_then(|simulation| drifted(simulation.balance.energy_drift, varies));
    let errors = found.iter().map(|error| told(py, error)).collect::<PyResult<_>>()?;
    Ok((errors, drift.map(|warning| warning.message)))
}

/// A true error as Python takes it.
pub(crate) fn told<'py>(py: Python<'py>, error: &TrueError) -> PyResult<TrueErrorColumns<'py>> {
    let numbers: [Named<TrueErrorSample>; 5] = [
        ("time", |s| s.time),
        ("kinetic", |s| s.kinetic),
        ("elastic", |s| s.elastic),
        ("dissipation", |s| s.dissipation),
        ("total", |s| s.total()),
    ];
    let columns = view::columns(py, &error.over_time, &numbers)?;
    Ok((error.sup, error.mean, columns))
}
