//! Sweeps.

use crate::{bridge, errors};
use percute_sweep::{Count, Key, Launch, Plan, Planned, Values, columns, from_json, keep_results, run, write};
use percute_workflow::Failure;
use percute_workflow::effort::Long;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;

/// The cases of a sweep.
#[pyclass(frozen, module = "percute._percute")]
pub(crate) struct SweepPlan {
    plan: Plan,
}

/// Cases done before, done now, failed and left, and name and reason of each failure.
type SweepDone = ([usize; 4], Vec<(String, String)>);

/// How cases are run: the command, processes at a time, threads of each, whether long runs are allowed, whether all are
/// run again.
type Way = (Vec<OsString>, Option<usize>, usize, bool, bool);

#[pymethods]
impl SweepPlan {
    /// The sweep of a case file: `parts` has keys and, in JSON, rows of their values; all combinations of rows are
    /// cases.
    #[new]
    fn new(
        py: Python<'_>,
        case: PathBuf,
        folder: PathBuf,
        parts: Vec<(Vec<String>, String)>,
        long: bool,
    ) -> PyResult<Self> {
        let values = values(parts).map_err(|message| errors::input(py, message))?;
        let plan = move |_| Plan::new(&case, folder, values, Long::asked(long, "`long=True`"));
        let plan = bridge::blocking(py, None, plan)?.map_err(|error| errors::run(py, &error))?;
        Ok(Self { plan })
    }

    /// Name and text of each case.
    fn cases(&self) -> Vec<(&str, &str)> {
        self.plan.cases.iter().map(|case| (case.name.as_str(), case.text.as_str())).collect()
    }

    /// Refuses to lose results.
    fn keep_results(&self, py: Python<'_>) -> PyResult<()> {
        keep_results(&self.plan.folder, &self.plan.cases).map_err(|error| errors::run(py, &error))
    }

    /// Runs the cases with these names that are not done.
    fn run(
        &self,
        py: Python<'_>,
        names: Vec<String>,
        way: Way,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<SweepDone> {
        let cases = self.plan.cases.iter().filter(|case| names.contains(&case.name)).cloned().collect();
        run_cases(py, self.plan.folder.clone(), cases, way, progress)
    }

    /// Name, unit and, in JSON, entries of each column of the table.
    fn columns(&self) -> Vec<(String, &'static str, String)> {
        let told = |column: percute_sweep::Column| {
            (column.name, column.unit, serde_json::Value::Array(column.entries).to_string())
        };
        columns(&self.plan).into_iter().map(told).collect()
    }

    /// Writes the table of comma-separated values and returns its name.
    fn write(&self, py: Python<'_>) -> PyResult<PathBuf> {
        write(&self.plan).map_err(|error| errors::run(py, &error))
    }
}

/// Runs one case of a sweep in `folder`, by its name and text.
#[pyfunction]
pub(crate) fn sweep_case(py: Python<'_>, folder: PathBuf, name: String, text: String, way: Way) -> PyResult<SweepDone> {
    run_cases(py, folder, vec![Planned { name, text }], way, None)
}

fn run_cases(
    py: Python<'_>,
    folder: PathBuf,
    cases: Vec<Planned>,
    (command, jobs, threads, long, again): Way,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<SweepDone> {
    let default = Launch::of(command);
    let launch = Launch { jobs: jobs.unwrap_or(default.jobs), threads, long, again, ..default };
    // Waited for as for a file: the processes are stopped before an exception is raised.
    let work = move |mut watch: bridge::Watch, _writing| -> Result<_, Failure> {
        let mut failures = Vec::new();
        let tell = &mut |name: &str, reason: &str| failures.push((name.to_string(), reason.trim().to_string()));
        let count = run(&folder, &cases, &launch, tell, &mut watch)?;
        Ok((count, failures))
    };
    let (count, failures) = bridge::writing(py, progress, work)?.map_err(|error| errors::run(py, &error))?;
    let Count { found, done, failed, left } = count;
    Ok(([found, done, failed, left], failures))
}

fn values(parts: Vec<(Vec<String>, String)>) -> Result<Values, String> {
    parts.into_iter().try_fold(Values::none(), |values, (keys, rows)| {
        let keys = keys.iter().map(|key| Key::parse(key)).collect::<Result<Vec<_>, _>>()?;
        let rows: Vec<Vec<serde_json::Value>> = serde_json::from_str(&rows).map_err(|error| error.to_string())?;
        let rows = rows.iter().map(|row| row.iter().map(from_json).collect()).collect::<Result<Vec<_>, _>>()?;
        values.and(keys, rows)
    })
}
