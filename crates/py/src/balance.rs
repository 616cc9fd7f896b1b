//! Energies, works and momentum of a history over time, and the rebound that follows.

use crate::run::Run;
use crate::{bridge, contact, errors, view};
use percute_core::dynamics::Balance;
use percute_workflow::report::{ENERGIES, Impacts, Named, Rebound, rebound_to_json};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// The rebound and the impacts as a JSON document; `null` without contact, and without several bodies.
pub(crate) fn rebound(py: Python<'_>, run: &Arc<Run>) -> PyResult<String> {
    let contact = contact::of_run(py, run)?;
    let balance = results(py, run)?;
    let rebound = Rebound::new(&run.problem, &balance, &contact, None);
    let impacts = Impacts::new(&run.problem, &contact, None);
    rebound_to_json(rebound.as_ref(), impacts.as_ref()).map_err(|error| errors::percute_error(py, &error.to_string()))
}

/// Energies, works and momentum at each instant, computed now or before.
pub(crate) fn results(py: Python<'_>, run: &Arc<Run>) -> PyResult<Vec<Balance>> {
    let worker = run.clone();
    let kept = bridge::blocking(py, None, move |watch| worker.balance(watch).map(<[Balance]>::to_vec))?;
    kept.map_err(|error| errors::steps(py, &error))
}

/// An array for each quantity of the balance.
pub(crate) fn columns<'py>(py: Python<'py>, balance: &[Balance]) -> PyResult<Bound<'py, PyDict>> {
    let drifts: [Named<Balance>; 2] = [("energy_drift", |b| b.energy_drift), ("impulse_drift", |b| b.impulse_drift)];
    view::columns(py, balance, &[&ENERGIES[..], &drifts].concat())
}
