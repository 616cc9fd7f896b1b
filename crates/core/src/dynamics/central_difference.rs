//! The loop over the steps, eq. \[28\]–\[32\].

use super::balance::BalanceKeeper;
use super::contact::Contact;
use super::moving::MovingBody;
use super::node_update::Motion;
use super::{Balance, Dynamics};
use crate::history::{SinkError, State, StateSink, Step};
use crate::observer::{Observer, Progress};
use crate::problem::Problem;
use crate::time::TimeGrid;
use std::ops::ControlFlow;
use thiserror::Error;

/// Threads pay from so many elements on: a step then takes as long as some ten starts of a task.
const FEWEST_ELEMENTS: usize = 20_000;
/// Strips of each parity share two threads.
const FEWEST_STRIPS: usize = 4;

/// Why a simulation stopped before its end.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// Energy out of nothing.
    #[error(
        "the simulation became unstable at step {step}, t = {time:.6e} s: node {node} moves at {speed:.3e} m/s and the \
         energy exceeds ten times the sum of the initial energy and the work of loads and supports; take smaller time \
         steps (the longest is {longest_step:.4e} s, the critical one {critical_step:.4e} s), or steps that do not \
         jump from one to the next"
    )]
    Unstable {
        /// The step.
        step: usize,
        /// Its time (s).
        time: f64,
        /// The node with the most kinetic energy.
        node: usize,
        /// Its speed (m/s).
        speed: f64,
        /// Longest step of the grid (s).
        longest_step: f64,
        /// Critical step (s).
        critical_step: f64,
    },
    /// A node that touches at step 1 from too near: no admissible velocity brings it to rest.
    #[error(
        "node {node} starts {gap:.6e} m from its plane at {speed} m/s and touches in the first step of {step:.4e} s, \
         too near to come to rest there; start at least {smallest_gap:.6e} m away, or with a first step of at most \
         {largest_step:.4e} s"
    )]
    StartsTooNear {
        /// The node.
        node: usize,
        /// Which obstacle, from 0.
        obstacle: usize,
        /// Its gap (m).
        gap: f64,
        /// Its speed towards the obstacle (m/s).
        speed: f64,
        /// The first step (s).
        step: f64,
        /// The smallest gap that will do (m).
        smallest_gap: f64,
        /// The largest first step that will do (s).
        largest_step: f64,
    },
    /// Whoever takes the steps failed.
    #[error("step {step} could not be passed on: {cause}")]
    Sink {
        /// The step.
        step: usize,
        /// Why.
        cause: SinkError,
    },
}

/// How a simulation ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Energies, works and drifts at the last step.
    pub balance: Balance,
    /// The same at every step, from 0 on.
    pub balance_over_time: Vec<Balance>,
    /// Number of steps done, all of them unless it was interrupted.
    pub steps: usize,
    /// Whether the observer stopped it.
    pub interrupted: bool,
}

/// Runs a problem over a time grid and hands every step n = 0 … N to `sink`.
///
/// The observer is asked after each step; if it breaks, the run ends cleanly there.
///
/// # Errors
/// [`SimulationError`]: an unstable run, a start too near to an obstacle, a sink that fails.
pub fn simulate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    sink: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    run(&Dynamics::new(problem, times), sink, observer)
}

/// The same on so many threads, by default one for each core. The result does not depend on their number. A mesh that
/// is too small for threads to pay runs on one, and so does one whose order has no strips, or if threads cannot be
/// started.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_threaded<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    threads: Option<usize>,
    sink: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    let mut dynamics = Dynamics::new(problem, times);
    let threads = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, Into::into));
    let strips = dynamics.stiffness.strips.count();
    if threads > 1 && strips >= FEWEST_STRIPS && problem.mesh().element_count() >= FEWEST_ELEMENTS {
        // The steps run inside the pool: a step of 50 µs leaves no time to wake a thread. A pool of its own: a process
        // forked later must not wait for threads it does not have.
        if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads.min(strips / 2)).build() {
            dynamics.parallel = true;
            return pool.install(|| run(&dynamics, sink, observer));
        }
    }
    run(&dynamics, sink, observer)
}

/// The loop over the steps.
fn run<const D: usize, const N: usize>(
    dynamics: &Dynamics<'_, D, N>,
    sink: &mut dyn StateSink<D>,
    observer: &mut dyn Observer,
) -> Result<Simulation, SimulationError> {
    let Dynamics { problem, times, .. } = *dynamics;
    let mut body = MovingBody::new(dynamics);
    let mut contact = Contact::new(problem.surface().nodes().len());
    let mut balance = BalanceKeeper::new(problem, times);
    let mut balance_over_time = Vec::with_capacity(times.step_count() + 1);
    let (mut done, mut interrupted) = (0, false);

    for n in 0..=times.step_count() {
        if let Some(last) = n.checked_sub(1) {
            let motion = Motion::Advance { h: times.velocity_step(last), dt: times.step(last) };
            body.step(dynamics, n, motion);
            contact.react(dynamics, n, &body.displacement, &body.velocity, &mut body.forces.total);
        } else {
            start(dynamics, &mut body, &mut contact)?;
        }
        body.sum_up(dynamics, n);
        let step = Step {
            index: n,
            time: times.instants()[n],
            displacement: &body.displacement,
            reaction: &contact.reaction,
            touching: &contact.touching,
            velocity: None,
            acceleration: None,
        };
        let state = State::new(step, times, &body.forces, &body.velocity, &dynamics.inverse_mass);
        if !balance.record(problem, times, &state) {
            return Err(unstable(dynamics, n, &body.velocity));
        }
        sink.accept(&state).map_err(|cause| SimulationError::Sink { step: n, cause })?;
        balance_over_time.push(*balance.balance());
        done = n;
        let progress = Progress { stage: "simulating", done, total: times.step_count() };
        if observer.observe(progress) == ControlFlow::Break(()) && n < times.step_count() {
            interrupted = true;
            break;
        }
    }
    Ok(Simulation { balance: *balance.balance(), balance_over_time, steps: done, interrupted })
}

/// The forces and the contact at t_0.
fn start<const D: usize, const N: usize>(
    dynamics: &Dynamics<'_, D, N>,
    body: &mut MovingBody<D>,
    contact: &mut Contact<D>,
) -> Result<(), SimulationError> {
    body.step(dynamics, 0, Motion::Start);
    contact.react(dynamics, 0, &body.displacement, &body.velocity, &mut body.forces.total);
    contact.settle_start(dynamics);
    refuse_a_start_too_near(dynamics, contact)
}

/// Refuses a start that a simulation refuses, before anything is made for it.
///
/// # Errors
/// [`SimulationError::StartsTooNear`].
pub fn check_start<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
) -> Result<(), SimulationError> {
    let dynamics = &Dynamics::new(problem, times);
    start(dynamics, &mut MovingBody::new(dynamics), &mut Contact::new(problem.surface().nodes().len()))
}

/// A node that touches at step 1, but not at 0, must be able to slow down: its gap must be at
/// least |v_n|Δt₀/4, or no admissible kinematic field exists (problem P_CA).
fn refuse_a_start_too_near<const D: usize, const N: usize>(
    dynamics: &Dynamics<'_, D, N>,
    contact: &Contact<D>,
) -> Result<(), SimulationError> {
    let problem = dynamics.problem;
    let step = dynamics.times.step(0);
    for (at, node) in problem.surface().nodes().iter().enumerate() {
        if contact.touching[at] || !contact.touching_next[at] {
            continue;
        }
        let (gap, normal) = problem.start_of_contact(at);
        let speed = -normal;
        let smallest_gap = 0.25 * speed * step;
        if gap < smallest_gap {
            let largest_step = 4.0 * gap / speed;
            let obstacle = node.obstacle;
            return Err(SimulationError::StartsTooNear {
                node: node.node.index(),
                obstacle,
                gap,
                speed,
                step,
                smallest_gap,
                largest_step,
            });
        }
    }
    Ok(())
}

/// The error of an unstable run, with the node that has the most kinetic energy.
fn unstable<const D: usize, const N: usize>(
    dynamics: &Dynamics<'_, D, N>,
    step: usize,
    velocity: &[[f64; D]],
) -> SimulationError {
    let speed = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let energy = |(v, m): (&[f64; D], &f64)| m * speed(v) * speed(v);
    let energies: Vec<f64> = velocity.iter().zip(dynamics.problem.mass()).map(energy).collect();
    // Beyond the range of numbers counts as most.
    let rank = |e: f64| if e.is_nan() { f64::INFINITY } else { e };
    let node = (0..energies.len()).fold(0, |best, i| if rank(energies[i]) > rank(energies[best]) { i } else { best });
    SimulationError::Unstable {
        step,
        time: dynamics.times.instants()[step],
        node,
        speed: speed(&velocity[node]),
        longest_step: dynamics.times.longest_step(),
        critical_step: super::critical_time_step(dynamics.problem),
    }
}
