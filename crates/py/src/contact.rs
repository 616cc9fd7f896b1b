//! Contact results as arrays.

use crate::run::Run;
use crate::{bridge, errors, view};
use numpy::{Element, IntoPyArray, PyArrayDyn, PyArrayMethods};
use percute_core::border::Vector;
use percute_core::contact_results::{ContactPoint, ContactResults, ContactSteps, NodeSummary, Resultant};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Those of a history, computed now or before.
pub(crate) fn of_run(py: Python<'_>, run: &Arc<Run>) -> PyResult<Arc<ContactResults>> {
    let worker = run.clone();
    bridge::blocking(py, None, move |watch| worker.contact(watch))?.map_err(|error| errors::steps(py, &error))
}

/// Arrays by the names of `percute.Contact`; what is large is shown without a copy.
pub(crate) fn arrays<'py>(py: Python<'py>, results: &Arc<ContactResults>) -> PyResult<Bound<'py, PyDict>> {
    let arrays = PyDict::new(py);
    let (nodes, summary, dimension) = (&results.nodes, &results.summary, results.dimension);
    let shape = [results.instants.len(), nodes.len()];
    let of_vectors = [shape[0], shape[1], dimension];
    arrays.set_item("time", view::view(py, results, |r| r.instants.as_slice(), &shape[..1])?)?;
    arrays.set_item("nodes", view::column(py, nodes, |p| p.node.index() as i64))?;
    arrays.set_item("obstacle", view::column(py, nodes, |p| p.obstacle as i64))?;
    arrays.set_item("points", vectors(py, nodes, |p: &ContactPoint| p.point, dimension)?)?;
    arrays.set_item("normals", vectors(py, nodes, |p: &ContactPoint| p.normal, dimension)?)?;
    arrays.set_item("area", view::column(py, nodes, |p| p.area))?;
    arrays.set_item("first_touch", view::column(py, summary, |s| s.first_touch.unwrap_or(f64::NAN)))?;
    arrays.set_item("time_in_contact", view::column(py, summary, |s| s.time_in_contact))?;
    arrays.set_item("peak_normal_force", view::column(py, summary, |s| s.peak_normal_force))?;
    arrays.set_item("time_of_peak", view::column(py, summary, |s| s.time_of_peak.unwrap_or(f64::NAN)))?;
    arrays.set_item("peak_pressure", view::column(py, summary, |s| s.peak_pressure))?;
    arrays.set_item("impulse", vectors(py, summary, |s: &NodeSummary| s.impulse, dimension)?)?;
    if let Some(steps) = &results.steps {
        arrays.set_item("force", view::view(py, results, |r| of(r, |s| &s.force), &of_vectors)?)?;
        arrays.set_item("gap", view::view(py, results, |r| of(r, |s| &s.gap), &shape)?)?;
        let sliding = view::view(py, results, |r| of(r, |s| &s.sliding_velocity), &of_vectors)?;
        arrays.set_item("sliding_velocity", sliding)?;
        let status: Vec<u8> = steps.status.iter().map(|s| *s as u8).collect();
        arrays.set_item("status", array(py, status, &shape)?)?;
        let friction = view::view(py, results, |r| of(r, |s| &s.friction_energy), &shape)?;
        arrays.set_item("friction_energy", friction)?;
        if !steps.area.is_empty() {
            arrays.set_item("area_over_time", view::view(py, results, |r| of(r, |s| &s.area), &shape)?)?;
        }
    }
    arrays.set_item("resultants", resultants(py, &results.total, dimension)?)?;
    let obstacles = results.obstacles.iter().map(|over_time| resultants(py, over_time, dimension));
    arrays.set_item("obstacles", obstacles.collect::<PyResult<Vec<_>>>()?)?;
    Ok(arrays)
}

fn of<T>(results: &ContactResults, field: fn(&ContactSteps) -> &Vec<T>) -> &[T] {
    results.steps.as_ref().map_or(&[], |steps| field(steps))
}

/// An array for each quantity of a resultant.
fn resultants<'py>(py: Python<'py>, over_time: &[Resultant], dimension: usize) -> PyResult<Bound<'py, PyDict>> {
    let arrays = PyDict::new(py);
    arrays.set_item("force", vectors(py, over_time, |r: &Resultant| r.force, dimension)?)?;
    arrays.set_item("normal_force", view::column(py, over_time, |r| r.normal_force))?;
    arrays.set_item("impulse", vectors(py, over_time, |r: &Resultant| r.impulse, dimension)?)?;
    arrays.set_item("area", view::column(py, over_time, |r| r.area))?;
    arrays.set_item("in_contact", view::column(py, over_time, |r| r.in_contact as i64))?;
    arrays.set_item("slipping", view::column(py, over_time, |r| r.slipping as i64))?;
    arrays.set_item("friction_energy", view::column(py, over_time, |r| r.friction_energy))?;
    let centre = |r: &Resultant| r.centre.unwrap_or([f64::NAN; 3]);
    arrays.set_item("centre", vectors(py, over_time, centre, dimension)?)?;
    Ok(arrays)
}

/// A vector of each row as a read-only array.
fn vectors<'py, R>(
    py: Python<'py>,
    rows: &[R],
    vector: impl Fn(&R) -> Vector,
    dimension: usize,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let numbers = rows.iter().map(vector).flat_map(|vector| vector.into_iter().take(dimension));
    array(py, numbers.collect(), &[rows.len(), dimension])
}

/// Numbers as a read-only array of their own.
fn array<'py, T: Element>(py: Python<'py>, values: Vec<T>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
    let array = values.into_pyarray(py).reshape(shape)?;
    array.readwrite().make_nonwriteable();
    Ok(array)
}
