//! The loop over the steps, eq. \[28\]–\[32\].

use super::Dynamics;
use super::balance::BalanceKeeper;
use super::contact::StepContact;
use super::moving::MovingBody;
use super::node_update::NodeMotion;
use super::simulation::{Simulation, SimulationError, unstable};
use super::start::{restart, start};
use super::step_check::StabilityCheck;
use crate::history::{Checkpoint, State, StateSink, Step};
use crate::observer::{Observer, Progress};
use crate::problem::Problem;
use crate::time::TimeGrid;
use std::ops::ControlFlow;

/// Threads pay from so many elements on: a step then takes as long as some ten starts of a task.
const FEWEST_ELEMENTS: usize = 20_000;
/// Strips of each parity share two threads.
const FEWEST_STRIPS: usize = 4;

/// Runs a problem over a time grid, on so many threads, from the start or from a checkpoint on.
pub(super) fn simulate<const D: usize>(
    problem: &Problem<D>,
    times: &TimeGrid,
    threads: Option<usize>,
    checkpoint: Option<&Checkpoint>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    let mut dynamics = Dynamics::new(problem, times);
    let threads = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
    let strips = dynamics.strips().count();
    if threads > 1 && strips >= FEWEST_STRIPS && problem.mesh().element_count() >= FEWEST_ELEMENTS {
        // The steps run inside the pool: a step of 50 µs leaves no time to wake a thread. A pool of its own: a process
        // forked later must not wait for threads it does not have.
        if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads.min(strips / 2)).build() {
            dynamics.parallel = true;
            return pool.install(|| run(&dynamics, checkpoint, sink, observer));
        }
    }
    run(&dynamics, checkpoint, sink, observer)
}

/// The loop over the steps.
fn run<const D: usize>(
    dynamics: &Dynamics<'_, D>,
    checkpoint: Option<&Checkpoint>,
    sink: &mut dyn StateSink,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    let Dynamics { problem, times, .. } = *dynamics;
    let mut body = MovingBody::new(dynamics);
    let mut contact = StepContact::new(dynamics);
    let mut balance = BalanceKeeper::new(problem, times);
    let mut steps = StabilityCheck::new(dynamics);
    let mut balance_over_time = Vec::with_capacity(times.step_count() + 1);
    let (mut done, mut interrupted) = (0, false);
    if let Some(checkpoint) = checkpoint {
        balance = restart(dynamics, checkpoint, &mut body, &mut contact);
        done = checkpoint.step;
    }

    for n in checkpoint.map_or(0, |checkpoint| checkpoint.step + 1)..=times.step_count() {
        if let Some(last) = n.checked_sub(1) {
            let motion = NodeMotion::Advance { h: times.velocity_step(last), dt: times.step(last) };
            body.step(dynamics, n, motion);
            contact.react(dynamics, n, &body.displacement, &body.velocity, &mut body.forces.total);
        } else {
            start(dynamics, &mut body, &mut contact)?;
        }
        body.sum_up(dynamics, n);
        let step = Step {
            index: n,
            time: times.instants()[n],
            displacement: body.displacement.as_flattened(),
            reaction: contact.reaction.as_flattened(),
            touching: &contact.touching,
            internal: &body.internal,
            velocity: None,
            acceleration: None,
        };
        let state = State::new(step, times, &body.forces, &body.velocity, &dynamics.inverse_mass);
        if !balance.record(problem, times, &state) {
            return Err(unstable(dynamics, n, [&body.displacement, &body.velocity], balance.balance()));
        }
        sink.accept(&state.with_sums(&balance.sums())).map_err(|cause| SimulationError::Sink { step: n, cause })?;
        balance_over_time.push(*balance.balance());
        done = n;
        let progress = Progress { stage: "simulating", done, total: times.step_count() };
        if observer.observe(progress) == ControlFlow::Break(()) && n < times.step_count() {
            interrupted = true;
            break;
        }
        steps.check(n, &body.displacement)?;
    }
    Ok(Simulation { balance: *balance.balance(), balance_over_time, steps: done, interrupted })
}
