//! Estimates of histories.

use crate::built::BuiltEstimate;
use crate::history::HistoryData;
use crate::options::{self, Every, Stated, Wanted, analysis, options};
use crate::problem::ProblemData;
use crate::run::Run;
use crate::{bridge, errors, view};
use numpy::{PyArray1, PyArrayDyn};
use percute_core::units::Units;
use percute_estimator::{AdmissibleFields, ElementMap, Options, UnknownName};
use percute_io::Overwrite;
use percute_workflow::case::Instants;
use percute_workflow::grade::Graded;
use percute_workflow::report::{PARTS, Report, SOURCES, Warning};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// An estimate of either dimension.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct EstimateData {
    pub(crate) built: Arc<BuiltEstimate>,
}

/// A number of each element.
type MapNumbers = fn(&ElementMap) -> &[f64];
/// Components of an admissible field.
type Components = fn(&AdmissibleFields) -> &[f64];

/// Estimates a history; without `instants`, no maps are kept.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn estimate(
    py: Python<'_>,
    history: &HistoryData,
    reconstruction: &str,
    acceleration: Option<&str>,
    ablation: &str,
    every: Every,
    threads: Option<usize>,
    window: Option<usize>,
    instants: Option<Wanted>,
    fields: bool,
    accept: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<EstimateData> {
    let ablation = ablation.parse().map_err(|error: UnknownName| errors::input(py, format!("`_ablation`: {error}")))?;
    let options = Options { ablation, threads, window, ..options(py, reconstruction, acceleration, &every)? };
    let instants = instants.map(Instants::from);
    let maps = (instants.as_ref(), fields);
    let built = estimate_one(py, &history.run, options, maps, accept, progress)?;
    Ok(EstimateData { built })
}

/// A unit of a body of a stated thickness, or per metre.
#[pyfunction]
pub(crate) fn unit(name: &str, per_metre: bool) -> &str {
    Units { per_metre }.of(name)
}

/// The meaning of the error.
#[pyfunction]
pub(crate) fn meaning() -> &'static str {
    percute_workflow::report::meaning()
}

fn estimate_one(
    py: Python<'_>,
    run: &Arc<Run>,
    options: Options,
    (instants, fields): (Option<&Instants>, bool),
    accept: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Arc<BuiltEstimate>> {
    let analysis = analysis(options, instants, fields, false, run.times());
    let start = Instant::now();
    let work = {
        let run = run.clone();
        move |mut watch: bridge::Watch| {
            let source = run.stoppable(watch.clone());
            run.graded(&source, &analysis, accept, &mut watch)
        }
    };
    let Graded { results, times, checked } =
        bridge::blocking(py, progress, work)?.map_err(|error| errors::run(py, &error))?;
    let (held, seconds) = (run.file().map(|_| run.count()), start.elapsed().as_secs_f64());
    let mut built = BuiltEstimate::new(run.problem.clone(), times, options, results, held, seconds);
    built.checked = checked;
    built.case = run.case();
    Ok(Arc::new(built))
}

#[pymethods]
impl EstimateData {
    pub(crate) fn problem(&self) -> ProblemData {
        ProblemData::new(self.built.problem.clone())
    }

    /// All of it but its problem and its history, as bytes for `restore`; `name` is that of the report.
    fn state<'py>(&self, py: Python<'py>, name: String) -> PyResult<Bound<'py, PyBytes>> {
        let report = self.to_json(py, name)?;
        let bytes = self.built.state(&report);
        Ok(PyBytes::new(py, &bytes.map_err(|error| errors::percute_error(py, &error.to_string()))?))
    }

    /// The same estimate, bit by bit, from its problem and its `state`.
    #[staticmethod]
    fn restore(py: Python<'_>, problem: &ProblemData, state: &[u8]) -> PyResult<Self> {
        Ok(Self { built: Arc::new(BuiltEstimate::restored(py, &problem.problem, state)?) })
    }

    /// The measures: those of `percute.Estimate` that are single numbers.
    fn measures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let estimate = &self.built.estimate;
        let numbers = PyDict::new(py);
        for (name, value) in estimate.error.entries() {
            numbers.set_item(name, value)?;
        }
        numbers.set_item("time_of_sup", estimate.time_of_sup)?;
        numbers.set_item("steps", estimate.steps)?;
        numbers.set_item("end", estimate.end)?;
        numbers.set_item("impulse_ratio", estimate.impulse_ratio)?;
        Ok(numbers)
    }

    /// Parts of η at the time of the sup: kinetic, elastic, dissipation, contact (J).
    fn parts(&self) -> (f64, f64, f64, f64) {
        let parts = &self.built.estimate.parts;
        (parts.kinetic, parts.elastic, parts.dissipation, parts.contact)
    }

    /// η, its parts and d at all samples, an array each.
    fn over_time<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        view::columns(py, &self.built.estimate.over_time, &PARTS)
    }

    /// The sources of η, each as its four numbers, but over time an array for each; `None` without an auxiliary
    /// solution.
    fn sources<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(separation) = self.built.estimate.sources.as_ref() else { return Ok(None) };
        let numbers = PyDict::new(py);
        let sources =
            [("at_sup", separation.at_sup), ("mean", separation.mean), ("halved_elements", separation.halved_elements)];
        for (name, source) in sources {
            numbers.set_item(name, SOURCES.map(|(_, number)| number(&source)).to_vec())?;
        }
        numbers.set_item("halved_step", separation.halved_step)?;
        numbers.set_item("over_time", view::columns(py, &separation.over_time, &SOURCES)?)?;
        Ok(Some(numbers))
    }

    fn by_element<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.built.estimate.by_element.len()];
        view::view(py, &self.built, |built| built.estimate.by_element.as_slice(), &shape)
    }

    fn residuals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let residuals = PyDict::new(py);
        for (name, value) in self.built.estimate.residuals.entries() {
            residuals.set_item(name, value)?;
        }
        Ok(residuals)
    }

    /// Whether the history brought velocities, and accelerations.
    fn supplied(&self) -> (bool, bool) {
        let supplied = &self.built.estimate.supplied;
        (supplied.velocity, supplied.acceleration)
    }

    /// The warnings of the command, each with whether it concerns the result: those that only the result shows; with
    /// `options`, those about the options of the estimate; with `input`, those about the problem.
    fn warnings(&self, options: bool, input: bool) -> Vec<(String, bool)> {
        let told = |warning: &Warning| {
            let of_options = warning.name == "few_samples";
            of_options && options || !of_options && input
        };
        let [found, mut before] = self.built.warnings();
        before.retain(told);
        found.into_iter().chain(before).map(|warning| (warning.message.clone(), warning.doubts_result())).collect()
    }

    /// Names of the method's choices, and the samples taken.
    fn options(&self) -> Stated {
        options::stated(&self.built.options)
    }

    /// The elements that contribute most, largest first.
    fn worst_elements(&self, count: usize) -> Vec<(usize, f64)> {
        let worst = self.built.estimate.worst_elements(count);
        worst.into_iter().map(|(element, error)| (element.index(), error)).collect()
    }

    /// Each map as its arguments.
    fn maps<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        (0..self.built.estimate.maps.len()).map(|i| one_map(py, &self.built, i)).collect()
    }

    /// Writes an estimate file; contact results come from the history.
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        overwrite: bool,
        name: String,
        history: Option<&HistoryData>,
    ) -> PyResult<()> {
        let overwrite = Overwrite::allowed(overwrite);
        self.built.saved(py, path, overwrite, name, history.map(|history| &history.run))
    }

    /// A JSON document with verdict, rebound and warnings.
    fn verdict(&self, py: Python<'_>) -> PyResult<String> {
        let built = self.built.clone();
        let text = bridge::blocking(py, None, move |_| built.document("", Report::verdict_to_json))?;
        text.map_err(|message| errors::percute_error(py, &message))
    }

    /// The document of `percute run --json`.
    fn to_json(&self, py: Python<'_>, name: String) -> PyResult<String> {
        let built = self.built.clone();
        let text = bridge::blocking(py, None, move |_| built.report(&name))?;
        text.map_err(|message| errors::percute_error(py, &message))
    }
}

/// One map.
fn one_map<'py>(py: Python<'py>, built: &Arc<BuiltEstimate>, at: usize) -> PyResult<Bound<'py, PyDict>> {
    let map = &built.estimate.maps[at];
    let arguments = PyDict::new(py);
    arguments.set_item("step", map.step)?;
    arguments.set_item("time", map.time)?;
    let elements = map.kinetic.len();
    let parts: [(&str, MapNumbers); 4] = [
        ("kinetic", |m| &m.kinetic),
        ("elastic", |m| &m.elastic),
        ("dissipation", |m| &m.dissipation),
        ("contact", |m| &m.contact),
    ];
    for (name, part) in parts {
        arguments.set_item(name, view::view(py, built, |m| part(&m.estimate.maps[at]), &[elements])?)?;
    }
    let accumulated = view::view(py, built, |m| m.estimate.maps[at].accumulated.as_slice(), &[elements])?;
    arguments.set_item("accumulated", accumulated)?;
    arguments.set_item("total", PyArray1::from_vec(py, map.total()))?;
    arguments.set_item("error", PyArray1::from_vec(py, map.error(built.estimate.end)))?;
    let Some(fields) = &map.fields else { return Ok(arguments) };
    let dimension = built.problem.dimension();
    let nodes = fields.displacement.len() / dimension;
    let (vector, tensor) = ([elements, dimension], [elements, dimension, dimension]);
    let components: [(&str, &[usize], Components); 5] = [
        ("displacement", &[nodes, dimension], |f| &f.displacement),
        ("velocity", &[nodes, dimension], |f| &f.velocity),
        ("acceleration", &vector, |f| &f.acceleration),
        ("stress", &tensor, |f| &f.stress),
        ("compatible_stress", &tensor, |f| &f.compatible_stress),
    ];
    for (name, shape, field) in components {
        arguments.set_item(name, view::view(py, built, |m| fields_of(m, at).map_or(&[], field), shape)?)?;
    }
    Ok(arguments)
}

fn fields_of(built: &BuiltEstimate, at: usize) -> Option<&AdmissibleFields> {
    built.estimate.maps[at].fields.as_ref()
}
