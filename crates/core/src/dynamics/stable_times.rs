//! Steps that follow the stiffness of finite laws: a pass of the integrator finds them before the run.

use super::{Dynamics, SimulationError, entry};
use crate::border::vectors;
use crate::history::{Checkpoint, SinkError, State, StateSink};
use crate::kernel::{PointKernel, ProblemKernel};
use crate::observer::{Observer, Progress};
use crate::on_problem;
use crate::problem::{Problem, ProblemRef};
use crate::time::TimeGrid;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// A run looks at the stable step each so many steps: a look takes as long as two steps, and an unstable run needs some
/// tens of steps to be seen by its energy.
const RUN: usize = 20;
/// The pass that finds the steps looks more often. In a step the stable one falls by 4 % at the most (rubber at
/// 40 m/s) …
const EVERY: usize = 5;
/// … and by less than this, where it is computed again at once.
const FALLING: f64 = 0.005;
/// A shorter step leaves room for the fall until the next look, and keeps the number of passes small.
const ROOM: f64 = 0.98;
/// The stable step of the elements is 0.87 to 0.92 times the critical one: a step up to this factor above it is stable.
const SLACK: f64 = 1.08;

/// Instants with stable steps.
#[derive(Clone, Debug)]
pub struct StableTimes {
    /// The instants to the end.
    pub times: TimeGrid,
    /// Steps done, all of them unless the observer stopped the pass.
    pub steps: usize,
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

fn find<const D: usize>(
    problem: &Problem<D>,
    [end, courant]: [f64; 2],
    threads: Option<usize>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<StableTimes, SimulationError> {
    let kernel = PointKernel::new(problem);
    let first = courant * kernel.stable_step(problem, problem.initial_displacement());
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
            last: f64::INFINITY,
            inner: sink,
            shorter: None,
            left: &left,
        };
        let mut stop = Stop { inner: observer, left: &left, asked: false };
        let done = match &checkpoint {
            None => entry::simulate_threaded(problem, &times, threads, &mut watch, &mut stop),
            Some(checkpoint) => entry::resume(problem, &times, threads, checkpoint, &mut watch, &mut stop),
        };
        let done = match done {
            // The run itself fails there, with its steps stored.
            Err(SimulationError::InsideOut { .. } | SimulationError::Unstable { .. }) => {
                let steps = times.step_count();
                return Ok(StableTimes { times, steps });
            }
            done => done?,
        };
        let Some((from, step)) = watch.shorter else { return Ok(StableTimes { times, steps: done.steps }) };
        let n = from.step;
        times = shortened(&times, n, ROOM * step).map_err(SimulationError::Times)?;
        checkpoint = Some(from);
        if stop.asked {
            return Ok(StableTimes { times, steps: n });
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
    kernel: &'a PointKernel<crate::material::Elastic, D>,
    times: &'a TimeGrid,
    courant: f64,
    /// The step at which it looks again.
    next: usize,
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
        let n = state.step().index;
        if n < self.next || n >= self.times.step_count() {
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

/// Refuses a step that is not stable at the displacements of its start.
pub(super) fn check_step<const D: usize>(
    dynamics: &Dynamics<'_, D>,
    n: usize,
    displacement: &[[f64; D]],
) -> Result<(), SimulationError> {
    let ProblemKernel::Points(kernel) = &dynamics.kernel else { return Ok(()) };
    if !n.is_multiple_of(RUN) || n >= dynamics.times.step_count() {
        return Ok(());
    }
    let (step, stable) = (dynamics.times.step(n), kernel.stable_step(dynamics.problem, displacement));
    if step <= SLACK * stable {
        return Ok(());
    }
    Err(SimulationError::StepTooLong { time: dynamics.times.instants()[n], step, stable })
}
