//! A problem on nested meshes.

use crate::options::options;
use crate::problem::ProblemData;
use crate::simulate::Times;
use crate::{bridge, errors, time};
use percute_core::each_dimension;
use percute_estimator::Options;
use percute_workflow::Failure;
use percute_workflow::verify::{Verification, announced, cost, prepare, table, verify};
use pyo3::prelude::*;

/// Runs a problem on its mesh and on refinements. Returns the JSON document and the table; with `tell` this is called with the cost first.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn verification(
    py: Python<'_>,
    problem: &ProblemData,
    times: Times,
    levels: usize,
    reconstruction: &str,
    threads: Option<usize>,
    tell: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, String)> {
    let (end, courant, step, steps) = times;
    let times = time::grid(py, end, courant, step, steps, problem.critical_step(py)?)?;
    let options =
        Options { threads, ..options(py, reconstruction, None, &crate::options::Every::Name("auto".into()))? };
    let verification: Verification = each_dimension!(&problem.problem, problem => {
        let problem = problem.clone();
        let prepared = bridge::blocking(py, None, move |_| prepare(&problem, &times, levels))?;
        let prepared = prepared.map_err(|error| errors::failure(py, &error))?;
        if let Some(tell) = tell {
            tell.call1((announced(&cost(&prepared, &options)),))?;
        }
        let work = move |mut watch: bridge::Watch| verify(&prepared, options, &mut watch);
        bridge::blocking(py, progress, work)?.map_err(|error: Failure| errors::run(py, &error))?
    });
    let document = verification.to_json().map_err(|error| errors::percute_error(py, &error.to_string()))?;
    Ok((document, table(&verification)))
}
