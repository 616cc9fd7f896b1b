//! Estimates put together again, from a pickle.

use crate::estimate::{Made, Told};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{
    AdmissibleFields, ElementMap, ErrorMeasures, Estimate, Given, Options, Parts, Residuals, Sample,
};
use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// What the methods of an estimate give.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct State<'py> {
    times: Vec<f64>,
    options: (String, String, usize),
    measures: Measures,
    parts: (f64, f64, f64),
    over_time: OverTime<'py>,
    by_element: Vec<f64>,
    residuals: HashMap<String, f64>,
    given: (bool, bool),
    maps: Vec<Map<'py>>,
    json: String,
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Measures {
    sup: f64,
    mean: f64,
    relative_sup: f64,
    relative_mean: f64,
    reference_sup: f64,
    reference_mean: f64,
    time_of_sup: f64,
    steps: usize,
    end: f64,
    kept_impulse: Option<f64>,
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct OverTime<'py> {
    time: PyReadonlyArray1<'py, f64>,
    kinetic: PyReadonlyArray1<'py, f64>,
    elastic: PyReadonlyArray1<'py, f64>,
    contact: PyReadonlyArray1<'py, f64>,
    reference: PyReadonlyArray1<'py, f64>,
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Map<'py> {
    step: usize,
    time: f64,
    kinetic: Vec<f64>,
    elastic: Vec<f64>,
    contact: Vec<f64>,
    accumulated: Vec<f64>,
    fields: Option<Fields<'py>>,
}

#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Fields<'py> {
    displacement: PyReadonlyArray2<'py, f64>,
    velocity: PyReadonlyArray2<'py, f64>,
    acceleration: PyReadonlyArray2<'py, f64>,
    stress: PyReadonlyArray3<'py, f64>,
    compatible_stress: PyReadonlyArray3<'py, f64>,
}

/// The same estimate, bit by bit.
pub(crate) fn restore<const D: usize, const N: usize>(
    problem: &Arc<Problem<D, N>>,
    state: &State<'_>,
) -> PyResult<Made<D, N>> {
    let (reconstruction, acceleration, every) = &state.options;
    let unknown = |error: percute_estimator::UnknownName| pyo3::exceptions::PyValueError::new_err(error.to_string());
    let options = Options {
        reconstruction: reconstruction.parse().map_err(unknown)?,
        acceleration: acceleration.parse().map_err(unknown)?,
        every: *every,
        ..Options::default()
    };
    let m = &state.measures;
    let error = ErrorMeasures {
        sup: m.sup,
        mean: m.mean,
        relative_sup: m.relative_sup,
        relative_mean: m.relative_mean,
        reference_sup: m.reference_sup,
        reference_mean: m.reference_mean,
    };
    let (kinetic, elastic, contact) = state.parts;
    let estimate = Estimate {
        error,
        time_of_sup: m.time_of_sup,
        parts: Parts { kinetic, elastic, contact },
        over_time: samples(&state.over_time)?,
        by_element: state.by_element.clone(),
        residuals: residuals(&state.residuals),
        kept_impulse: m.kept_impulse,
        given: Given { velocity: state.given.0, acceleration: state.given.1 },
        steps: m.steps,
        end: m.end,
        maps: state.maps.iter().map(map).collect::<PyResult<_>>()?,
    };
    let times = TimeGrid::from_instants(state.times.clone());
    let times = times.map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    Ok(Made { problem: problem.clone(), times, options, estimate, report: Told::Before(state.json.clone()) })
}

fn samples(over_time: &OverTime<'_>) -> PyResult<Vec<Sample>> {
    let OverTime { time, kinetic, elastic, contact, reference } = over_time;
    let columns = (time.as_slice()?, kinetic.as_slice()?, elastic.as_slice()?, contact.as_slice()?);
    let rows = columns.0.iter().zip(columns.1).zip(columns.2).zip(columns.3).zip(reference.as_slice()?);
    let sample = |((((&time, &kinetic), &elastic), &contact), &reference)| Sample {
        time,
        parts: Parts { kinetic, elastic, contact },
        reference,
    };
    Ok(rows.map(sample).collect())
}

fn residuals(named: &HashMap<String, f64>) -> Residuals {
    let of = |name: &str| named.get(name).copied().unwrap_or(f64::NAN);
    Residuals {
        initial_conditions: of("initial_conditions"),
        supports: of("supports"),
        onset: of("onset"),
        normal_velocity: of("normal_velocity"),
        penetration_at_instants: of("penetration_at_instants"),
        penetration_between_instants: of("penetration_between_instants"),
        cone: of("cone"),
        force_off_contact: of("force_off_contact"),
        star_compatibility: of("star_compatibility"),
        element_resultants: of("element_resultants"),
        divergence: of("divergence"),
        edge_tractions: of("edge_tractions"),
        inner_tractions: of("inner_tractions"),
    }
}

fn map<const D: usize>(map: &Map<'_>) -> PyResult<ElementMap<D>> {
    let vectors = |array: &PyReadonlyArray2<'_, f64>| Ok::<_, PyErr>(array.as_slice()?.as_chunks::<D>().0.to_vec());
    let tensors = |array: &PyReadonlyArray3<'_, f64>| {
        Ok::<_, PyErr>(array.as_slice()?.as_chunks::<D>().0.as_chunks::<D>().0.to_vec())
    };
    let fields = match &map.fields {
        None => None,
        Some(fields) => Some(AdmissibleFields {
            displacement: vectors(&fields.displacement)?,
            velocity: vectors(&fields.velocity)?,
            acceleration: vectors(&fields.acceleration)?,
            stress: tensors(&fields.stress)?,
            compatible_stress: tensors(&fields.compatible_stress)?,
        }),
    };
    Ok(ElementMap {
        step: map.step,
        time: map.time,
        kinetic: map.kinetic.clone(),
        elastic: map.elastic.clone(),
        contact: map.contact.clone(),
        accumulated: map.accumulated.clone(),
        fields,
    })
}
