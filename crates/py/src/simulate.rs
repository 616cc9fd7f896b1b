//! Simulations, into memory or into a file.

use crate::bridge::Watch;
use crate::built::BuiltEstimate;
use crate::case::CaseData;
use crate::estimate::EstimateData;
use crate::history::HistoryData;
use crate::options::{Wanted, analysis};
use crate::problem::ProblemData;
use crate::run::{Growing, Run};
use crate::{bridge, errors, time};
use percute_core::dynamics::{Balance, SimulationError, check_start};
use percute_core::history::Step;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_io::history::{Plan, Writer};
use percute_io::{FileCause, FileError, Overwrite};
use percute_workflow::Failure;
use percute_workflow::case::{Instants, Keep, Source, refused_start};
use percute_workflow::choice::StepChoice;
use percute_workflow::effort::{Effort, Long};
use percute_workflow::history::{plan, stored_case};
use percute_workflow::memory;
use percute_workflow::report::{drifted, varying_steps};
use percute_workflow::run::{self, Outcome, Storage, TakeStep};
use percute_workflow::until::{Until, no_rebound};
use pyo3::prelude::*;
use std::any::Any;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Instant;

/// How the instants are stated: end, courant, step, steps.
pub(crate) type Times = (Option<f64>, Option<f64>, Option<f64>, Option<Vec<f64>>);

/// The part of a run that its file keeps: every k-th step, or times (s); and names of fields.
type StorageOptions = (Option<usize>, Option<Vec<f64>>, Option<Vec<String>>);

/// Checks it against the instants of the run.
fn keep_of(py: Python<'_>, (every, wanted, fields): StorageOptions, times: &TimeGrid) -> PyResult<Keep> {
    let steps = match (every, wanted) {
        (Some(every), _) => StepChoice::Every(every),
        (None, Some(wanted)) => StepChoice::Times(wanted),
        (None, None) => StepChoice::All,
    };
    steps.of(times.instants()).map_err(|told| errors::input(py, format!("`times`: {told}")))?;
    if let Some(told) = fields.iter().flatten().find_map(|name| Keep::unknown(name)) {
        return Err(errors::input(py, format!("`fields`: {told}")));
    }
    Ok(Keep { steps, fields })
}

/// The instants of a run; with a Courant number, those of a body that may turn are looked for.
pub(crate) fn instants(
    py: Python<'_>,
    problem: &ProblemData,
    (end, courant, step, steps): Times,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<TimeGrid> {
    let times = time::grid(py, end, courant, step, steps, problem.stable_step(py, courant)?)?;
    let Some(courant) = courant.filter(|_| problem.problem.is_finite()) else { return Ok(times) };
    let (problem, end) = (problem.problem.clone(), times.end());
    let work = move |mut watch: Watch| run::following(&problem, end, courant, &mut watch);
    let found = bridge::blocking(py, progress, work)?.map_err(|error| errors::run(py, &error))?;
    found.ok_or_else(|| errors::percute_error(py, "the search for stable steps was stopped"))
}

/// Simulates; with a warning if energy appears or is lost. What is raised on the way has what was done as its
/// `history`: the data, or the file.
#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    problem: &ProblemData,
    times: Times,
    store: Option<PathBuf>,
    keep: StorageOptions,
    overwrite: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(HistoryData, Option<String>)> {
    let times = instants(py, problem, times, progress)?;
    let keep = keep_of(py, keep, &times)?;
    let store = store.map(|path| Store::new(path, overwrite, keep));
    let problem = &problem.problem;
    let work = {
        let (problem, times) = (problem.clone(), times.clone());
        move |storage: Storage<'_>, watch: &mut Watch| {
            let Outcome { results, unstored } = run::simulate(&problem, &times, storage, watch)?;
            let drifted = drifted(results.balance.energy_drift, times.varies());
            Ok(Done { balance: results.balance_over_time, rest: drifted.map(|warning| warning.message), unstored })
        }
    };
    let planned = Planned { problem: problem.clone(), times, options: Options::default(), case: None, store };
    let (history, drifted) = planned.carry_out(py, progress, work, &|failure| failure)?;
    Ok((history?, drifted))
}

/// Simulates a case and estimates its error beside the run. What is raised on the way has a `history` as that of
/// [`simulate`], and if only the file of the history was lost, an `estimate`.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn run_case(
    py: Python<'_>,
    case: &CaseData,
    store: Option<PathBuf>,
    overwrite: bool,
    pace: (Option<usize>, Option<usize>),
    instants: Option<Wanted>,
    fields: bool,
    contact_steps: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(HistoryData, EstimateData)> {
    let (case, instants) = (&case.case, instants.map(Instants::from));
    let options = Options { threads: pace.0, window: pace.1, ..case.options };
    let analysis = analysis(options, instants.as_ref(), fields, contact_steps, &case.times);
    let (problem, times, options) = (case.problem.clone(), case.times.clone(), analysis.options);
    let store = store.map(|path| Store::new(path, overwrite, case.output.keep.clone()));
    let work = {
        let (problem, times) = (problem.clone(), times.clone());
        move |storage: Storage<'_>, watch: &mut Watch| {
            let start = Instant::now();
            let Outcome { results, unstored } = run::run(&problem, &times, &analysis, storage, watch)?;
            let balance = results.simulation.balance_over_time.clone();
            Ok(Done { balance, rest: (results, start.elapsed().as_secs_f64()), unstored })
        }
    };
    let source = Some(case.source.clone());
    let planned =
        Planned { problem: problem.clone(), times: times.clone(), options: case.options, case: source, store };
    let (history, (results, seconds)) =
        planned.carry_out(py, progress, work, &|failure| run::located(case, failure))?;
    let mut built = BuiltEstimate::new(problem, times, options, results, None, seconds);
    built.case = Some(stored_case(&case.source));
    built.unended.clone_from(&case.unended);
    let built = EstimateData { built: Arc::new(built) };
    match history {
        Ok(history) => Ok((history, built)),
        Err(error) => Err(errors::with(py, error, "estimate", Some(built))),
    }
}

/// The end (s) of a run that ends with the rebound, by a pass of the integrator alone, and a warning if contact does
/// not end in time.
#[pyfunction]
pub(crate) fn rebound_end(
    py: Python<'_>,
    problem: &ProblemData,
    pace: (Option<f64>, Option<f64>),
    longest: f64,
    after: Option<f64>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(f64, Option<String>)> {
    let (courant, step) = pace;
    let stable = problem.stable_step(py, courant)?;
    time::grid(py, Some(longest), courant, step, None, stable)?;
    let step = step.or_else(|| courant.map(|courant| courant * stable)).unwrap_or(stable);
    if let Some(told) = no_rebound(&problem.problem) {
        return Err(errors::input(py, format!("`end`: {told}")));
    }
    let (problem, until) = (problem.problem.clone(), Until::new(&problem.problem, longest, after, step));
    let work = move |mut watch: Watch| run::rebound(&problem, &until, &mut watch);
    let found = bridge::blocking(py, progress, work)?.map_err(|error| errors::run(py, &error))?;
    let found = found.ok_or_else(|| errors::percute_error(py, "the search for the rebound was stopped"))?;
    Ok((found.times.end(), found.warning.map(|warning| warning.message)))
}

/// The keys of `material`.
fn groups(problem: &AnyProblem) -> Vec<Option<String>> {
    problem.conditions().materials.iter().map(|(group, _)| group.clone()).collect()
}

/// Plausibility warnings about a run; with `in_memory`, its history is kept in memory.
#[pyfunction]
pub(crate) fn plausibility_warnings(
    py: Python<'_>,
    problem: &ProblemData,
    times: Times,
    in_memory: bool,
) -> PyResult<Vec<String>> {
    let (end, courant, step, steps) = times;
    let critical = problem.critical_step(py)?;
    let times = time::grid(py, end, courant, step, steps, problem.stable_step(py, courant)?)?;
    let problem = &problem.problem;
    let history = if in_memory { memory::of_history(problem, &times) } else { 0 };
    let (needed, names) = (memory::of_run(problem, &times).saturating_add(history), groups(problem));
    let told = percute_core::problem::plausibility_warnings(problem, &times).into_iter().map(|plausibility_warning| {
        format!("`{}`: {}", errors::argument(plausibility_warning.place, &names), plausibility_warning.message)
    });
    let scarce = memory::scarce(needed, memory::available(), in_memory).map(|message| format!("`mesh`: {message}"));
    let varying = varying_steps(&times, critical).map(|warning| format!("`steps` {}", warning.message));
    Ok(told.chain(varying).chain(scarce).collect())
}

/// Refuses a start that the simulation would refuse, a run for which there is no memory, and a long one unless `long`
/// says so, before warnings and any work.
#[pyfunction]
pub(crate) fn check_run(py: Python<'_>, problem: &ProblemData, times: Times, long: bool) -> PyResult<()> {
    let (end, courant, step, steps) = times;
    let times = time::grid(py, end, courant, step, steps, problem.stable_step(py, courant)?)?;
    let problem = &problem.problem;
    if let Err(error @ SimulationError::StartsTooNear { obstacle, .. }) = check_start(problem, &times) {
        let (place, message) = refused_start(problem, &times, obstacle, &error);
        return Err(errors::input(py, format!("`{}`: {message}", errors::argument(place, &groups(problem)))));
    }
    let effort = Effort::of(problem, &times, Options::default().every);
    match effort.refusal(&times, false, Long::asked(long, "`long=True`")) {
        Some(told) => Err(errors::input(py, format!("`end` {told}"))),
        None => memory::refusal(memory::of_run(problem, &times))
            .map_or(Ok(()), |told| Err(errors::input(py, format!("`mesh`: {told}")))),
    }
}

/// Lets the run of a history go on, which was killed or stopped; with a warning as that of [`simulate`].
#[pyfunction]
pub(crate) fn resume(
    py: Python<'_>,
    path: PathBuf,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(HistoryData, Option<String>)> {
    let (file, begun) = (path.clone(), Arc::new(AtomicBool::new(false)));
    let goes_on = begun.clone();
    let work = move |mut watch: Watch, open: Box<dyn Any + Send>| {
        let stored = percute_workflow::history::open(&file)?;
        if stored.file.has_ended() {
            return Ok((None, None));
        }
        goes_on.store(true, Relaxed);
        let Outcome { results, unstored } = stored.resume(None, Some(open), &mut watch)?;
        let drifted = drifted(results.balance.energy_drift, stored.file.run_times().varies());
        Ok((drifted.map(|warning| warning.message), unstored))
    };
    let done = bridge::writing(py, progress, move |watch, open| work(watch, Box::new(open)));
    let done = done.and_then(|done: Result<_, Failure>| done.map_err(|failure| errors::run(py, &failure)));
    match done {
        Ok((_, Some(lost))) => {
            let error = errors::file(py, &lost);
            let FileCause::Lost { now } = lost.cause else { return Err(error) };
            Err(errors::with(py, error, "history", now))
        }
        Ok((drifted, None)) => Ok((open_history(py, path)?, drifted)),
        Err(error) => Err(errors::with(py, error, "history", begun.load(Relaxed).then_some(path))),
    }
}

/// Opens the history in a file.
#[pyfunction]
pub(crate) fn open_history(py: Python<'_>, path: PathBuf) -> PyResult<HistoryData> {
    let opened = bridge::blocking(py, None, move |_| opened(&path))?;
    Ok(HistoryData { run: opened.map_err(|error| errors::failure(py, &error))? })
}

fn opened(path: &Path) -> Result<Arc<Run>, Failure> {
    let stored = percute_workflow::history::open(path)?;
    Ok(Arc::new(Run::stored(stored)?))
}

/// A file to simulate into.
#[derive(Clone)]
struct Store {
    path: PathBuf,
    overwrite: bool,
    /// The part of the run that it keeps.
    keep: Keep,
    /// Set as soon as the file is that of this run.
    ours: Arc<AtomicBool>,
}

impl Store {
    fn new(path: PathBuf, overwrite: bool, keep: Keep) -> Self {
        Self { path, overwrite, keep, ours: Arc::default() }
    }

    /// Makes the planned file.
    fn begin(&self, plan: &Plan<'_>) -> Result<Writer, Failure> {
        let writer = plan.create(&self.path, Overwrite::allowed(self.overwrite))?;
        self.ours.store(true, Relaxed);
        Ok(writer)
    }
}

/// What a run has done.
struct Done<T> {
    balance: Vec<Balance>,
    rest: T,
    /// Why its file could not be completed.
    unstored: Option<FileError>,
}

/// A run whose history goes to a file or into memory.
struct Planned {
    problem: AnyProblem,
    times: TimeGrid,
    /// Options that the estimate of its history takes unless told otherwise.
    options: Options,
    case: Option<Source>,
    store: Option<Store>,
}

impl Planned {
    /// Does the work, and gives the history and the rest. There is no history if its file was lost during the run.
    fn carry_out<T: Send + 'static>(
        self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(Storage<'_>, &mut Watch) -> Result<Done<T>, Failure> + Send + 'static,
        located: &dyn Fn(Failure) -> Failure,
    ) -> PyResult<(PyResult<HistoryData>, T)> {
        let Self { problem, times, options, case, store } = self;
        let growing = store.is_none().then(|| Growing::new(&times));
        let task = {
            let (problem, case, store, growing) = (problem.clone(), case.clone(), store.clone(), growing.clone());
            move |mut watch: Watch, open: Option<Box<dyn Any + Send>>| {
                let begin = |store: &Store| store.begin(&plan(&problem, &times, &options, case.as_ref(), &store.keep)?);
                let file = store.as_ref().map(begin).transpose()?;
                let mut keep = growing.as_ref().map(|growing| |step: &Step<'_>| growing.push(step));
                let memory = keep.as_mut().map(|keep| keep as &mut TakeStep<'_>);
                let done = work(Storage { file, memory, open }, &mut watch);
                if let (Err(failure), Some(store)) = (&done, &store)
                    && failure.is_refused_start()
                {
                    store.ours.store(false, Relaxed);
                }
                done
            }
        };
        let done = match &store {
            Some(_) => bridge::writing(py, progress, |watch, open| task(watch, Some(Box::new(open)))),
            None => bridge::blocking(py, progress, |watch| task(watch, None)),
        };
        let outcome = done.and_then(|done| done.map_err(|failure| errors::run(py, &located(failure))));
        let kept = growing.and_then(|growing| growing.take());
        let data = |history, balance| {
            let mut run = Run::new(problem, history, options, balance);
            run.case = case;
            HistoryData { run: Arc::new(run) }
        };
        match (outcome, store) {
            (Ok(Done { rest, unstored: Some(lost), .. }), Some(_)) => {
                let error = errors::file(py, &lost);
                let FileCause::Lost { now } = lost.cause else { return Ok((Err(error), rest)) };
                Ok((Err(errors::with(py, error, "history", now)), rest))
            }
            (Ok(Done { rest, .. }), Some(store)) => Ok((open_history(py, store.path), rest)),
            (Ok(Done { balance, rest, .. }), None) => match kept {
                Some(history) => Ok((Ok(data(history, Some(balance))), rest)),
                None => Err(errors::percute_error(py, "internal error: a simulation without steps")),
            },
            // To open it takes time, and Ctrl-C must end the call soon.
            (Err(error), Some(store)) if store.ours.load(Relaxed) => {
                Err(errors::with(py, error, "history", Some(store.path)))
            }
            (Err(error), _) => Err(errors::with(py, error, "history", kept.map(|history| data(history, None)))),
        }
    }
}
