//! A problem on nested meshes.

use crate::options::{Stated, options};
use crate::problem::ProblemData;
use crate::simulate::{Times, instants};
use crate::{bridge, errors};
use percute_estimator::Options;
use percute_workflow::Failure;
use percute_workflow::effort::Long;
use percute_workflow::quantity::probes as parsed;
use percute_workflow::verify::{Verification, announced, cost, prepare, table, verify};
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// The JSON document and the table.
type VerificationTexts = (String, String);

/// The argument with the probes.
const PROBE: &str = "`probe`";

/// Refuses probes that do not fit the body of a problem.
#[pyfunction]
pub(crate) fn check_probes(py: Python<'_>, problem: &ProblemData, probes: Vec<String>) -> PyResult<()> {
    let checked = parsed(&probes, problem.problem.mesh(), PROBE).map(drop);
    checked.map_err(|error| errors::run(py, &error))
}

/// Runs a problem on its mesh and on refinements. Returns the JSON document and the table; with `tell` this is called
/// with the cost first. What is raised on the way has those of the levels that are done as its `verification`.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn verification(
    py: Python<'_>,
    problem: &ProblemData,
    times: Times,
    levels: usize,
    stated: Stated,
    threads: Option<usize>,
    long: bool,
    probes: Vec<String>,
    tell: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<VerificationTexts> {
    let times = instants(py, problem, times, progress)?;
    let (reconstruction, acceleration, every) = stated;
    let options = Options { threads, ..options(py, &reconstruction, acceleration.as_deref(), &every)? };
    let so_far: Arc<Mutex<Option<Verification>>> = Arc::default();
    let verified = {
        let problem = &problem.problem;
        let probes = parsed(&probes, problem.mesh(), PROBE).map_err(|error| errors::run(py, &error))?;
        let (problem, long) = (problem.clone(), Long::asked(long, "`long=True`"));
        let prepared = bridge::blocking(py, None, move |_| prepare(&problem, &times, &options, (levels, long)))?;
        let prepared = prepared.map_err(|error| errors::run(py, &error))?;
        if let Some(tell) = tell {
            tell.call1((announced(&cost(&prepared, &options)),))?;
        }
        let keep = so_far.clone();
        let work = move |mut watch: bridge::Watch| {
            let mut keep = |done: &Verification| {
                *keep.lock().unwrap_or_else(PoisonError::into_inner) = Some(done.clone());
            };
            verify(&prepared, options, &probes, &mut watch, &mut keep)
        };
        let done = bridge::blocking(py, progress, work);
        done.and_then(|done| done.map_err(|error: Failure| errors::run(py, &error)))
    };
    match verified {
        Ok(verification) => told(py, &verification),
        Err(error) => {
            let done = so_far.lock().unwrap_or_else(PoisonError::into_inner).take();
            Err(errors::with(py, error, "verification", done.map(|done| told(py, &done)).transpose()?))
        }
    }
}

fn told(py: Python<'_>, verification: &Verification) -> PyResult<VerificationTexts> {
    let document = verification.to_json().map_err(|error| errors::percute_error(py, &error.to_string()))?;
    Ok((document, table(verification)))
}
