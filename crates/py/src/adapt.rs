//! Adaptations, run by run.

use crate::built::BuiltEstimate;
use crate::estimate::EstimateData;
use crate::options::{Stated, options};
use crate::problem::ProblemData;
use crate::simulate::Times;
use crate::{bridge, errors, time};
use percute_estimator::Options;
use percute_workflow::adapt::{Adapting, Best, Geometry, Measure, Mesher, Wish, announced, table};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Shared with the thread of a run.
type Shared = Arc<Mutex<Adapting>>;
/// Target, measure or quantity, limit and number of runs.
type TargetOf = (f64, String, f64, usize);

/// An adaptation on its way.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct AdaptingData {
    adapting: Shared,
    options: Options,
}

#[pymethods]
impl AdaptingData {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn begin(
        py: Python<'_>,
        problem: &ProblemData,
        times: Times,
        wanted: TargetOf,
        gmsh: Option<(Option<PathBuf>, f64)>,
        stated: Stated,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let ((end, courant, step, steps), (target, measure, limit, runs)) = (times, wanted);
        let times = time::grid(py, end, courant, step, steps, problem.critical_step(py)?)?;
        let (reconstruction, acceleration, every) = stated;
        let options = Options { threads, ..options(py, &reconstruction, acceleration.as_deref(), &every)? };
        let known = Measure::NAMES.into_iter().find(|(name, _)| *name == measure).map(|(_, measure)| measure);
        let on = match known {
            Some(_) => None,
            None => Some(measure.parse().map_err(|told| errors::input(py, format!("`measure`: {told}")))?),
        };
        let measure = known.unwrap_or_default();
        let geometry = |(file, scale): (Option<PathBuf>, f64)| {
            Mesher::Gmsh(file.map_or(Geometry::Outline, |file| Geometry::File(file, scale)))
        };
        let wish = (Wish { target, measure, on, courant, limit, runs }, gmsh.map_or(Mesher::Bisection, geometry));
        let adapting = Adapting::new(&problem.problem, &times, options, wish);
        let adapting = adapting.map_err(|error| errors::run(py, &error))?;
        Ok(Self { adapting: Arc::new(Mutex::new(adapting)), options })
    }

    /// Plans the next run, and tells of it; none if the adaptation has ended.
    fn next(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let adapting = self.adapting.clone();
        let next = move |_| adapting.lock().unwrap_or_else(PoisonError::into_inner).upcoming();
        let next = bridge::blocking(py, None, next)?;
        next.map(|next| next.as_ref().map(announced)).map_err(|error| errors::run(py, &error))
    }

    /// Does the planned run.
    fn run(&self, py: Python<'_>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let adapting = self.adapting.clone();
        let work =
            move |mut watch: bridge::Watch| adapting.lock().unwrap_or_else(PoisonError::into_inner).run(&mut watch);
        bridge::blocking(py, progress, work)?.map_err(|error| errors::run(py, &error))
    }

    /// The JSON document and the table of the runs so far, and the problem and the estimate of the best one.
    fn so_far(&self, py: Python<'_>) -> PyResult<(String, String, Option<ProblemData>, Option<EstimateData>)> {
        // A run that was told to stop ends first.
        let (document, table, best) = py.detach(|| told(&self.adapting, self.options));
        let document = document.map_err(|error| errors::percute_error(py, &error.to_string()))?;
        let estimate = best.map(|built| EstimateData { built });
        let problem = estimate.as_ref().map(EstimateData::problem);
        Ok((document, table, problem, estimate))
    }
}

type Adapted = (Result<String, std::io::Error>, String, Option<Arc<BuiltEstimate>>);

fn told(adapting: &Shared, options: Options) -> Adapted {
    let adaptation = adapting.lock().unwrap_or_else(PoisonError::into_inner).so_far();
    let (document, table) = (adaptation.to_json(), table(&adaptation));
    let built = |best: Arc<Best>| {
        let best = Arc::unwrap_or_clone(best);
        Arc::new(BuiltEstimate::new(best.problem, best.times, options, best.results, None, 0.0))
    };
    (document, table, adaptation.best.map(built))
}
