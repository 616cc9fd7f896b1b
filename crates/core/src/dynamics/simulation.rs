//! How a simulation ended, and why it stopped before.

use super::critical_step::critical_time_step;
use super::{Balance, Dynamics};
use crate::element_state::displacement_gradient;
use crate::history::SinkError;
use crate::ids::ElementId;
use crate::material::volume_ratio;
use crate::problem::Problem;
use crate::time::TimeError;
use thiserror::Error;

/// Why a simulation stopped before its end.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// Energy out of nothing.
    #[error(
        "the simulation became unstable at step {step}, t = {time:.6e} s: node {node} moves at {speed:.3e} m/s and the \
         energy exceeds ten times the sum of the initial energy and the work of loads and supports; {} (the longest \
         step is {longest_step:.4e} s, the critical one {critical_step:.4e} s)",
        if *.by_contact {
            "most of it is the work of contact forces: refine the surfaces that touch, or name groups of edges that \
             face each other"
        } else {
            "take smaller time steps, or steps that do not jump from one to the next"
        }
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
        /// Whether steps are stable without contact, and contact forces did most of the work.
        by_contact: bool,
    },
    /// More steps than a run can have.
    #[error(transparent)]
    Times(TimeError),
    /// An element of a finite law whose nodes have passed each other.
    #[error(
        "element {element} is turned inside out at step {step}, t = {time:.4e} s: its volume is {ratio:.2} times that \
         of the undeformed element; {}",
        if *.step == 0 { "check the initial displacement" } else {
            "the steps before are stored. Take a slower impact, shorter steps or a finer mesh there; law = \"svk\" \
             softens in compression, the others do not"
        }
    )]
    InsideOut {
        /// The step.
        step: usize,
        /// Its time (s).
        time: f64,
        /// The element.
        element: usize,
        /// det F.
        ratio: f64,
    },
    /// A step above the stable one of the present stiffness.
    #[error(
        "the step from t = {time:.6e} s on, {step:.4e} s, is above the stable step of the deformed body, \
         {stable:.4e} s: give courant = 0.9, with which steps follow the stiffness, or shorter steps from there on"
    )]
    StepTooLong {
        /// Its time (s).
        time: f64,
        /// The step (s).
        step: f64,
        /// The stable step (s).
        stable: f64,
    },
    /// A node that touches at step 1 from too near: no admissible velocity brings it to rest.
    #[error(
        "node {node} starts {gap:.6e} m from {} at {speed} m/s and touches in the first step of {step:.4e} s, too near \
         to come to rest there; start at least {:.6e} m away{}, or with a first step of at most {:.4e} s",
        if *.plane { "its plane" } else { "the other body" },
        // As they are printed they will do.
        (1.0 + 1e-6) * *.smallest_gap,
        if *.plane { ", as a plane with the `gap` \"auto\" in place of a point does" } else { "" },
        (1.0 - 1e-4) * *.largest_step
    )]
    StartsTooNear {
        /// The node.
        node: usize,
        /// Which obstacle, from 0.
        obstacle: usize,
        /// Whether this is a plane, or else another body.
        plane: bool,
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
    /// A body enters another one where no contact is stated or found.
    #[error(
        "at step {step}, t = {time:.6e} s, node {node} of \"{}\" is {depth:.3e} m inside \"{}\": no contact was \
         defined there, and none was found from the positions and velocities at the start; define a contact by \
         `groups` of these edges, or end the run before", .bodies[0], .bodies[1]
    )]
    Missed {
        /// The step.
        step: usize,
        /// Its time (s).
        time: f64,
        /// The node.
        node: usize,
        /// The names of its body and of the other one.
        bodies: [String; 2],
        /// How deep it is (m).
        depth: f64,
    },
    /// The sink of the steps failed.
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
    /// The same at every step of this run, from 0 on, or from the one after its checkpoint on.
    pub balance_over_time: Vec<Balance>,
    /// Number of steps done, all of them unless it was interrupted.
    pub steps: usize,
    /// Whether the observer stopped it.
    pub interrupted: bool,
}

/// The error of an unstable run, with the node that has the most kinetic energy.
pub(super) fn unstable<const D: usize>(
    dynamics: &Dynamics<'_, D>,
    step: usize,
    [displacement, velocity]: [&[[f64; D]]; 2],
    balance: &Balance,
) -> SimulationError {
    if let Some((element, ratio)) = inside_out(dynamics.problem, displacement) {
        return SimulationError::InsideOut { step, time: dynamics.times.instants()[step], element, ratio };
    }
    let speed = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let energy = |(v, m): (&[f64; D], &f64)| m * speed(v) * speed(v);
    let energies: Vec<f64> = velocity.iter().zip(dynamics.problem.mass()).map(energy).collect();
    // Beyond the range of numbers counts as most.
    let rank = |e: f64| if e.is_nan() { f64::INFINITY } else { e };
    let node = (0..energies.len()).fold(0, |best, i| if rank(energies[i]) > rank(energies[best]) { i } else { best });
    let (longest_step, critical_step) = (dynamics.times.longest_step(), critical_time_step(dynamics.problem));
    SimulationError::Unstable {
        step,
        time: dynamics.times.instants()[step],
        node,
        speed: speed(&velocity[node]),
        longest_step,
        critical_step,
        by_contact: longest_step < critical_step && 2.0 * balance.given_by_contact() > balance.kinetic + balance.strain,
    }
}

/// The element of a finite law with the least det F, if that is not positive.
pub(super) fn inside_out<const D: usize>(problem: &Problem<D>, displacement: &[[f64; D]]) -> Option<(usize, f64)> {
    let elements = (0..problem.mesh().element_count()).map(ElementId::new);
    let ratio = |e: ElementId| (e.index(), volume_ratio(&displacement_gradient(problem.mesh(), e, displacement)));
    let finite = elements.filter(|e| problem.material(*e).is_finite()).map(ratio);
    finite.filter(|(_, ratio)| *ratio <= 0.0).min_by(|a, b| a.1.total_cmp(&b.1))
}
