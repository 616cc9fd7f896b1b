//! Runs: the simulation of a problem, with its estimate beside it or without, and the estimate of a history. The
//! command and Python use the same functions. If the observer breaks, the results are those of the steps done. The
//! problem is solved in a local order of its own; all results have the numbers of the problem that was stated.

use crate::case::Case;
use crate::deformation::{Deformation, DeformationRecorder};
use crate::failure::Failure;
use crate::leaving::Leaving;
use crate::memory;
pub use crate::numbering::TakeStep;
use crate::numbering::{Fields, Ordered};
use crate::outline::{LastOutline, Outline};
use crate::report::Findings;
use crate::storing::drive;
pub use crate::storing::{Outcome, Storage};
use crate::until::{FoundEnd, Stop, Until};
use percute_core::contact_results::{ContactMemoryError, ContactRecorder, ContactResults};
use percute_core::dynamics::{
    Balance, Balancing, Simulation, StableTimes, first_stable_step, replay, simulate_threaded, stable_times,
};
use percute_core::history::{Discard, SinkError, State, StateSink, Step, StepSource};
use percute_core::observer::Observer;
use percute_core::problem::AnyProblem;
use percute_core::time::{TimeError, TimeGrid};
use percute_estimator::reference::{Comparison, Motion, TrueError};
use percute_estimator::{Estimate, EstimateError, Estimator, Options, Request, RunError};
use std::sync::atomic::AtomicBool;

/// The analysis of the steps of a run or of a history.
#[derive(Clone, Debug, Default)]
pub struct Analysis {
    /// Options of the estimate.
    pub options: Options,
    /// The maps that the estimate keeps.
    pub request: Request,
    /// Whether the contact results hold all nodes at all instants.
    pub contact_steps: bool,
}

/// The results of an estimated run or history.
#[derive(Clone, Debug)]
pub struct Results {
    /// Balance and number of the steps.
    pub simulation: Simulation,
    /// The estimate of the error.
    pub estimate: Estimate,
    /// The contact results.
    pub contact: ContactResults,
    /// The deformation and the stress.
    pub deformation: Deformation,
    /// The outline of a plane body at the last step.
    pub outline: Option<Outline>,
}

impl Results {
    /// What a report is made of.
    #[must_use]
    pub fn findings(&self) -> Findings<'_> {
        let Self { simulation, estimate, contact, deformation, outline } = self;
        Findings { simulation, estimate, contact, deformation, outline: outline.as_ref() }
    }

    /// Whether the observer broke before all steps were done and estimated.
    #[must_use]
    pub fn interrupted(&self) -> bool {
        self.simulation.interrupted || self.estimate.steps < self.simulation.steps
    }
}

impl Analysis {
    fn recorder<'p>(
        &self,
        problem: &'p AnyProblem,
        times: &'p TimeGrid,
    ) -> Result<ContactRecorder<'p>, ContactMemoryError> {
        let recorder = ContactRecorder::new(problem, times);
        if self.contact_steps { recorder.keeping_steps() } else { Ok(recorder) }
    }
}

/// Simulates a problem.
///
/// # Errors
/// A start that the simulation refuses (its history file is removed), an unstable run, a step that cannot be stored;
/// after these the file holds the steps done.
pub fn simulate(
    problem: &AnyProblem,
    times: &TimeGrid,
    storage: Storage<'_>,
    observer: &mut dyn Observer,
) -> Result<Outcome<Simulation>, Failure> {
    drive(&Ordered::new(problem), times, (None, None), storage, &mut Discard, observer)
}

/// Finds the end of a run that goes on until all contact has ended: a pass of the integrator alone. None if the
/// observer stops it.
///
/// # Errors
/// As [`simulate`].
pub fn rebound(problem: &AnyProblem, until: &Until, observer: &mut dyn Observer) -> Result<Option<FoundEnd>, Failure> {
    let refused = |error: TimeError| Failure::Argument(error.to_string());
    let (ordered, times, seen) = (Ordered::new(problem), until.times().map_err(refused)?, AtomicBool::new(false));
    let mut leaving = Leaving::new(ordered.problem(), until.after, &seen);
    let mut stop = Stop { inner: observer, left: &seen, asked: false };
    let fails = if problem.is_finite() {
        let bounds = [until.longest, until.step / first_stable_step(problem)];
        stable_times(ordered.problem(), bounds, None, &mut leaving, &mut stop).map(|found| found.fails)
    } else {
        simulate_threaded(ordered.problem(), &times, None, &mut leaving, &mut stop).map(|_| false)
    };
    let fails = fails.map_err(|error| ordered.failure(error.into()))?;
    let (left, asked) = (leaving.left, stop.asked);
    if asked && left.is_none() {
        return Ok(None);
    }
    let going_on = leaving.going_on();
    let found = until.found(left.ok_or(&going_on)).map_err(refused)?;
    // The error of the run tells more than the warning.
    Ok(Some(FoundEnd { warning: found.warning.filter(|_| !fails), ..found }))
}

/// The case with the instants of its run: the end with the rebound and the steps of finite laws are looked for. With a
/// warning if contact does not end in time; no case if the observer stops the search.
///
/// # Errors
/// As [`simulate`].
pub fn resolved(case: &Case, observer: &mut dyn Observer) -> Result<Option<Case>, Failure> {
    let mut case = case.clone();
    if let Some(until) = case.until.take() {
        let Some(FoundEnd { times, warning }) = rebound(&case.problem, &until, observer)? else { return Ok(None) };
        (case.times, case.unended) = (times, warning);
    }
    if let Some(courant) = case.following.take() {
        let Some(times) = following(&case.problem, case.times.end(), courant, observer)? else { return Ok(None) };
        case.times = times;
    }
    Ok(Some(case))
}

/// Finds steps that follow the stiffness of finite laws, to an end (s): a pass of the integrator alone. None if the
/// observer stops it.
///
/// # Errors
/// As [`simulate`].
pub fn following(
    problem: &AnyProblem,
    end: f64,
    courant: f64,
    observer: &mut dyn Observer,
) -> Result<Option<TimeGrid>, Failure> {
    let ordered = Ordered::new(problem);
    let found = stable_times(ordered.problem(), [end, courant], None, &mut Discard, observer);
    let StableTimes { times, steps, .. } = found.map_err(|error| ordered.failure(error.into()))?;
    Ok(Some(times).filter(|times| steps == times.step_count()))
}

/// Simulates a problem and analyses the steps beside the run.
///
/// # Errors
/// As [`simulate`], and as [`estimate`].
pub fn run(
    problem: &AnyProblem,
    times: &TimeGrid,
    analysis: &Analysis,
    storage: Storage<'_>,
    observer: &mut dyn Observer,
) -> Result<Outcome<Results>, Failure> {
    beside(&Ordered::new(problem), times, analysis, storage, &mut Discard, observer)
}

/// Does the same for a problem in its order, and hands each state to `sink`, too.
pub(crate) fn beside(
    ordered: &Ordered<'_>,
    times: &TimeGrid,
    analysis: &Analysis,
    storage: Storage<'_>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Outcome<Results>, Failure> {
    let mut contact = analysis.recorder(ordered.problem(), times)?;
    let estimator =
        Estimator::new(ordered.problem(), times, analysis.options).and_then(|e| e.keeping(&analysis.request));
    let mut estimator = estimator.map_err(RunError::from)?.stopping(observer.flag());
    let mut shown = shown(ordered, times);
    let mut sinks = ((&mut estimator, (&mut contact, &mut shown)), sink);
    let done = drive(ordered, times, (analysis.options.threads, None), storage, &mut sinks, observer)?;
    done.map(|simulation| {
        let estimate = ordered.estimate(estimator.finish().map_err(RunError::from)?);
        Ok(results(ordered, simulation, estimate, contact.finish(), shown))
    })
}

/// The results of a whole run that is not stored; none if the observer broke.
pub(crate) fn whole(
    ordered: &Ordered<'_>,
    times: &TimeGrid,
    options: Options,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Option<Results>, Failure> {
    let (analysis, nowhere) = (Analysis { options, ..Analysis::default() }, Storage::default());
    match beside(ordered, times, &analysis, nowhere, sink, observer).and_then(Outcome::stored) {
        Ok(results) => Ok(Some(results).filter(|results| !results.interrupted())),
        // Nothing can be estimated of a run that was stopped at its start.
        Err(Failure::Run(RunError::Estimate(EstimateError::TooFewSteps { .. } | EstimateError::Stopped))) => Ok(None),
        Err(other) => Err(other),
    }
}

/// Analyses the steps of a history; with the same options, the results are those of its run, bit by bit.
///
/// # Errors
/// Steps that cannot be read or do not fit the problem, options out of range, no memory for all contact results.
pub fn estimate(
    problem: &AnyProblem,
    source: &dyn StepSource,
    analysis: &Analysis,
    observer: &mut dyn Observer,
) -> Result<Results, Failure> {
    let Analysis { options, request, .. } = analysis;
    let needed = memory::of_run(problem, source.times()).saturating_add(percute_estimator::memory(
        problem,
        source.times(),
        options,
    ) as u64);
    memory::refusal(needed).map_or(Ok(()), |told| Err(Failure::Memory(told)))?;
    let ordered = Ordered::new(problem);
    let mut contact = analysis.recorder(ordered.problem(), source.times())?;
    let mut shown = shown(&ordered, source.times());
    let (source, mut beside) = (ordered.source(source), (&mut contact, &mut shown));
    let done = percute_estimator::estimate(ordered.problem(), &source, *options, request, &mut beside, observer);
    let (simulation, estimate) = done.map_err(|error| match error {
        RunError::Source(cause) => ordered.failure(Failure::from_sink(cause, RunError::Source)),
        error => ordered.failure(error.into()),
    })?;
    let estimate = ordered.estimate(estimate);
    Ok(results(&ordered, simulation, estimate, contact.finish(), shown))
}

/// What a report shows beside contact and error, of the steps of a problem in its order.
type ReportSinks<'o> = (DeformationRecorder<'o>, LastOutline);

fn shown<'o>(ordered: &'o Ordered<'_>, times: &TimeGrid) -> ReportSinks<'o> {
    let problem = ordered.problem();
    (DeformationRecorder::new(problem, times.step_count()), LastOutline::new(problem.mesh()))
}

/// The results in the numbers of the problem that was stated.
fn results(
    ordered: &Ordered<'_>,
    simulation: Simulation,
    estimate: Estimate,
    contact: ContactResults,
    (deformation, outline): ReportSinks<'_>,
) -> Results {
    let mut deformation = deformation.finish(ordered.stated_problem().mesh(), |element| ordered.element(element));
    if let Some(touch) = &mut deformation.next_touch {
        touch.node = ordered.node(touch.node);
    }
    let (contact, outline) = (ordered.contact(contact), outline.finish(|node| ordered.node(node)));
    Results { simulation, estimate, contact, deformation, outline }
}

/// Whether the mesh of a run must be nested in that of its reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meshes {
    /// Each element of the reference is a part of one of the run: the true error is exact in space.
    Nested,
    /// Any meshes of the same bodies: the fields of the run are evaluated at nodes and centroids of the reference.
    Any,
}

/// The true errors of runs, each a problem and its steps, against a reference, its problem and instants. Without the
/// steps of the reference it is simulated, and the simulation is returned too.
///
/// # Errors
/// A reference that simulates another problem, meshes that are not nested, a reference that ends early, steps that
/// cannot be read; as [`simulate`].
pub fn true_errors<'p>(
    runs: &[(&'p AnyProblem, &'p dyn StepSource)],
    (fine, times): (&'p AnyProblem, &'p TimeGrid),
    steps: Option<&dyn StepSource>,
    meshes: Meshes,
    observer: &mut dyn Observer,
) -> Result<(Vec<TrueError>, Option<Simulation>), Failure> {
    for (problem, _) in runs {
        if let Some(what) = crate::reference::difference(problem, fine)? {
            return Err(Failure::Argument(format!(
                "`reference`: it is the simulation of another problem: {what}; simulate the problem of the history on \
                 a finer mesh"
            )));
        }
    }
    let unread = |cause| Failure::from_sink(cause, RunError::Source);
    let ordered: Vec<_> = runs.iter().map(|(problem, _)| Ordered::new(problem)).collect();
    let mut motions = Vec::new();
    for (ordered, (_, steps)) in ordered.iter().zip(runs) {
        let mut motion = Motion::default();
        let replayed = replay(ordered.problem(), &ordered.source(*steps), &mut motion);
        replayed.map_err(|cause| ordered.failure(unread(cause)))?;
        motions.push(motion);
    }
    let fine = Ordered::new(fine);
    let mut comparison = Comparison::new(fine.problem());
    for (run, motion) in ordered.iter().zip(&motions) {
        let added = match meshes {
            Meshes::Nested => comparison.add(run.problem(), motion),
            Meshes::Any => comparison.add_located(run.problem(), motion),
        };
        added.map_err(|error| fine.failure(error.into()))?;
    }
    let done = match steps {
        Some(steps) => replay(fine.problem(), &fine.source(steps), &mut comparison).map(|()| None).map_err(unread),
        None => {
            simulate_threaded(fine.problem(), times, None, &mut comparison, observer).map(Some).map_err(Failure::from)
        }
    };
    let simulation = done.map_err(|failure| fine.failure(failure))?;
    Ok((comparison.finish()?, simulation))
}

/// Energies and works at each step of a history: those of its run, bit by bit.
///
/// # Errors
/// A step that cannot be read or does not fit.
pub fn balance(problem: &AnyProblem, source: &dyn StepSource) -> Result<Vec<Balance>, SinkError> {
    let ordered = Ordered::new(problem);
    let mut balancing = Balancing::new(ordered.problem(), source.times());
    replay(ordered.problem(), &ordered.source(source), &mut balancing).map_err(|cause| ordered.refused(cause))?;
    Ok(balancing.finish())
}

/// v_n (m/s) and a_n (m/s²) of all nodes at each step of a history, by the scheme or as the history brings them, each
/// handed to `take`.
///
/// # Errors
/// A step that cannot be read or does not fit.
pub fn motion(
    problem: &AnyProblem,
    source: &dyn StepSource,
    take: impl FnMut(Vec<f64>, Vec<f64>) + Send,
) -> Result<(), SinkError> {
    let ordered = Ordered::new(problem);
    let mut motion = NodalMotion { ordered: &ordered, take };
    replay(ordered.problem(), &ordered.source(source), &mut motion).map_err(|cause| ordered.refused(cause))
}

/// Hands velocities and accelerations on.
struct NodalMotion<'o, 'p, F> {
    ordered: &'o Ordered<'p>,
    take: F,
}

impl<F: FnMut(Vec<f64>, Vec<f64>) + Send> StateSink for NodalMotion<'_, '_, F> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        (self.take)(self.ordered.nodal(state.velocity()), self.ordered.nodal(state.acceleration()));
        Ok(())
    }
}

/// Hands chosen steps of a history, ascending, to `take`, in the numbers of the user. With `motion` they have v_n and
/// a_n, by the scheme or as the history brings them.
///
/// # Errors
/// A step that cannot be read or does not fit, or what `take` returns.
pub fn chosen(
    problem: &AnyProblem,
    source: &dyn StepSource,
    steps: &[usize],
    motion: bool,
    take: &mut TakeStep<'_>,
) -> Result<(), SinkError> {
    let wanted = |step: usize| steps.binary_search(&step).is_ok();
    if !motion {
        return source.replay(&mut |step| if wanted(step.index) { take(step) } else { Ok(()) });
    }
    let ordered = Ordered::new(problem);
    let mut sink = ChosenStates { ordered: &ordered, steps, take, fields: Fields::default() };
    replay(ordered.problem(), &ordered.source(source), &mut sink).map_err(|cause| ordered.refused(cause))
}

/// Hands chosen states on with their motion.
struct ChosenStates<'o, 'p, 't, 's> {
    ordered: &'o Ordered<'p>,
    steps: &'o [usize],
    take: &'t mut TakeStep<'s>,
    fields: Fields,
}

impl StateSink for ChosenStates<'_, '_, '_, '_> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        if self.steps.binary_search(&step.index).is_err() {
            return Ok(());
        }
        let (velocity, acceleration) = (state.velocity(), state.acceleration());
        let step = Step { velocity: Some(&velocity), acceleration: Some(&acceleration), ..*step };
        (self.take)(&self.ordered.stated_step(&step, &mut self.fields))
    }
}

/// The failure of the run of a case: a refused start is a mistake in the case, with its line.
#[must_use]
pub fn located(case: &Case, failure: Failure) -> Failure {
    match failure {
        Failure::Run(RunError::Simulation(error)) => {
            case.refused_start(&error).map_or_else(|| error.into(), Failure::from)
        }
        other => other,
    }
}
