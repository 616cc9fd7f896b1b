//! Steps that follow the stiffness of finite laws: a pass of the integrator finds them before the run.

use super::SimulationError;
use super::central_difference::simulate;
use super::critical_step::critical_time_step;
use super::simulation::inside_out;
use crate::border::vectors;
use crate::history::{Checkpoint, SinkError, State, StateSink};
use crate::kernel::PointKernel;
use crate::material::Elastic;
use crate::observer::{Observer, Progress};
use crate::on_problem;
use crate::problem::{Problem, ProblemRef};
use crate::time::TimeGrid;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// The pass looks at the stable step each so many steps. In a step it falls by 4 % at the most (rubber at 40 m/s) …
const EVERY: usize = 5;
/// … and by less than this, where it is computed again at once.
const FALLING: f64 = 0.005;
/// A shorter step leaves room for the fall until the next look, and keeps the number of passes small.
const ROOM: f64 = 0.98;

/// Instants with stable steps.
#[derive(Clone, Debug)]
pub struct StableTimes {
    /// The instants to the end.
    pub times: TimeGrid,
    /// Steps done, all of them unless the observer stopped the pass.
    pub steps: usize,
    /// Whether the run fails before its end.
    pub fails: bool,
}

/// Finds instants from 0 to `end` (s) with steps of at most `courant` times the stable one of the deformed body, which
/// become shorter and never longer again. `sink` gets the states of the pass.
///
/// # Errors
/// As [`simulate`](super::simulate).
pub fn stable_times<'p>(
    problem: impl Into<ProblemRef<'p>>,
    [end, courant]: [f64; 2],
    threads: Option<usize>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<StableTimes, SimulationError> {
    fn of(
        problem: ProblemRef<'_>,
        bounds: [f64; 2],
        threads: Option<usize>,
        sink: &mut dyn StateSink,
        observer: &mut dyn Observer,
    ) -> Result<StableTimes, SimulationError> {
        on_problem!(problem, problem => find(problem, bounds, threads, sink, observer))
    }
    of(problem.into(), [end, courant], threads, sink, observer)
}

/// The stable step (s) of the start, of which steps that follow the stiffness are the Courant number times; the
/// critical step of small kinematics, and where an element is turned inside out.
#[must_use]
pub fn first_stable_step<'p>(problem: impl Into<ProblemRef<'p>>) -> f64 {
    fn of(problem: ProblemRef<'_>) -> f64 {
        on_problem!(problem, problem => {
            let stable = problem.is_finite().then(|| of_start(problem, &PointKernel::new(problem, |law| *law)));
            stable.filter(|step| step.is_finite()).unwrap_or_else(|| critical_time_step(problem))
        })
    }
    of(problem.into())
}

/// That of the start. A body that is strained there may become stiffer where it is not.
fn of_start<const D: usize>(problem: &Problem<D>, kernel: &PointKernel<Elastic, D>) -> f64 {
    let start = problem.initial_displacement();
    kernel.stable_step(problem, start).min(kernel.stable_step(problem, &vec![[0.0; D]; start.len()]))
}

fn find<const D: usize>(
    problem: &Problem<D>,
    [end, courant]: [f64; 2],
    threads: Option<usize>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<StableTimes, SimulationError> {
    let kernel = PointKernel::new(problem, |law| *law);
    let start = problem.initial_displacement();
    if let Some((element, ratio)) = inside_out(problem, start) {
        return Err(SimulationError::InsideOut { step: 0, time: 0.0, element, ratio });
    }
    let first = courant * of_start(problem, &kernel);
    let mut times = TimeGrid::with_step(end, first).map_err(SimulationError::Times)?;
    let mut checkpoint: Option<Checkpoint> = None;
    loop {
        let left = AtomicBool::new(false);
        let mut watch = Watch {
            problem,
            kernel: &kernel,
            times: &times,
            courant,
            next: 0,
            touching: 0,
            last: f64::INFINITY,
            inner: sink,
            shorter: None,
            left: &left,
        };
        let mut stop = Stop { inner: observer, left: &left, asked: false };
        let done = match &checkpoint {
            None => simulate(problem, &times, threads, None, &mut watch, &mut stop),
            Some(checkpoint) => simulate(problem, &times, threads, Some(checkpoint), &mut watch, &mut stop),
        };
        let done = match done {
            // The run itself fails there, with its steps stored.
            Err(SimulationError::InsideOut { .. } | SimulationError::Unstable { .. }) => {
                let steps = times.step_count();
                return Ok(StableTimes { times, steps, fails: true });
            }
            done => done?,
        };
        let Some((from, step)) = watch.shorter else {
            return Ok(StableTimes { times, steps: done.steps, fails: false });
        };
        let n = from.step;
        times = shortened(&times, n, ROOM * step).map_err(SimulationError::Times)?;
        checkpoint = Some(from);
        if stop.asked {
            return Ok(StableTimes { times, steps: n, fails: false });
        }
    }
}

/// The instants up to t_n, and equal steps of at most `step` (s) from there to the end.
fn shortened(times: &TimeGrid, n: usize, step: f64) -> Result<TimeGrid, crate::time::TimeError> {
    let (start, end) = (times.instants()[n], times.end());
    let rest = TimeGrid::with_step(end - start, step)?;
    let mut instants = times.instants()[..=n].to_vec();
    instants.extend(rest.instants()[1..].iter().map(|t| start + t));
    if let Some(last) = instants.last_mut() {
        *last = end;
    }
    TimeGrid::from_instants(instants)
}

/// A sink that looks at the stable step.
struct Watch<'a, const D: usize> {
    problem: &'a Problem<D>,
    kernel: &'a PointKernel<Elastic, D>,
    times: &'a TimeGrid,
    courant: f64,
    /// The step at which it looks again.
    next: usize,
    /// Nodes that touched at the last step.
    touching: usize,
    /// The stable step it saw last (s).
    last: f64,
    inner: &'a mut dyn StateSink,
    /// Where the steps must become shorter, and the step (s).
    shorter: Option<(Checkpoint, f64)>,
    left: &'a AtomicBool,
}

impl<const D: usize> StateSink for Watch<'_, D> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.inner.accept(state)?;
        let (n, touching) = (state.step().index, state.step().touching.iter().filter(|t| **t).count());
        // Contact changes the stiffness fastest.
        let due = n >= self.next || touching != self.touching;
        self.touching = touching;
        if !due || n >= self.times.step_count() {
            return Ok(());
        }
        let stable = self.kernel.stable_step(self.problem, vectors(state.step().displacement));
        let falls = stable < (1.0 - FALLING) * self.last;
        (self.last, self.next) = (stable, n + if falls { 1 } else { EVERY });
        // A step that was shortened by ROOM is not shortened again at once.
        if self.times.step(n) > self.courant * stable {
            self.shorter = state.checkpoint().map(|checkpoint| (checkpoint, self.courant * stable));
            self.left.store(true, Relaxed);
        }
        Ok(())
    }
}

/// Stops a pass where the steps must become shorter, or when another observer wishes.
struct Stop<'a> {
    inner: &'a mut dyn Observer,
    left: &'a AtomicBool,
    asked: bool,
}

impl Observer for Stop<'_> {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        let asked = self.inner.observe(Progress { stage: "finding stable steps", ..progress });
        self.asked |= asked == ControlFlow::Break(());
        if self.left.load(Relaxed) { ControlFlow::Break(()) } else { asked }
    }
}
