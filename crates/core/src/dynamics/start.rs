//! The state from which the steps go on: that at t_0, or a checkpoint.

use super::balance::BalanceKeeper;
use super::contact::StepContact;
use super::moving::MovingBody;
use super::node_update::NodeMotion;
use super::{Dynamics, SimulationError};
use crate::border::vectors;
use crate::history::{Checkpoint, State, Step};
use crate::problem::Problem;
use crate::time::TimeGrid;

/// The forces and the contact at t_0.
pub(super) fn start<const D: usize>(
    dynamics: &Dynamics<'_, D>,
    body: &mut MovingBody<D>,
    contact: &mut StepContact<D>,
) -> Result<(), SimulationError> {
    body.step(dynamics, 0, NodeMotion::Start);
    contact.react(dynamics, 0, &body.displacement, &body.velocity, &mut body.forces.total);
    contact.settle_start(dynamics);
    refuse_a_start_too_near(dynamics, contact)
}

/// The forces and the contact at the step of a checkpoint; its sums are those of the balance.
pub(super) fn restart<const D: usize>(
    dynamics: &Dynamics<'_, D>,
    checkpoint: &Checkpoint,
    body: &mut MovingBody<D>,
    contact: &mut StepContact<D>,
) -> BalanceKeeper<D> {
    let Dynamics { problem, times, .. } = *dynamics;
    let Checkpoint { step: n, displacement, half_step, internal, sums } = checkpoint;
    let motion = [vectors(displacement), vectors(half_step)];
    body.displacement.copy_from_slice(motion[0]);
    body.velocity.copy_from_slice(motion[1]);
    // Those at t_n: the same strain once more changes none of them.
    body.internal.copy_from_slice(internal);
    body.step(dynamics, *n, NodeMotion::Start);
    contact.react(dynamics, *n, motion[0], motion[1], &mut body.forces.total);
    body.sum_up(dynamics, *n);
    let (index, time) = (*n, times.instants()[*n]);
    let (reaction, touching) = (contact.reaction.as_flattened(), &contact.touching[..]);
    let step = Step { index, time, displacement, reaction, touching, internal, velocity: None, acceleration: None };
    let state = State::new(step, times, &body.forces, &body.velocity, &dynamics.inverse_mass);
    BalanceKeeper::resumed(problem, times, &state, sums)
}

/// Refuses a start that a simulation refuses.
pub(super) fn check_start<const D: usize>(problem: &Problem<D>, times: &TimeGrid) -> Result<(), SimulationError> {
    let dynamics = &Dynamics::new(problem, times);
    start(dynamics, &mut MovingBody::new(dynamics), &mut StepContact::new(dynamics))
}

/// A node that touches at step 1, but not at 0, must be able to slow down: its gap must be at
/// least |v_n|Δt₀/4, or no admissible kinematic field exists (problem P_CA).
fn refuse_a_start_too_near<const D: usize>(
    dynamics: &Dynamics<'_, D>,
    contact: &StepContact<D>,
) -> Result<(), SimulationError> {
    let problem = dynamics.problem;
    let step = dynamics.times.step(0);
    let surface = problem.surface();
    for (at, (gap, normal)) in problem.starts_of_contact().into_iter().enumerate() {
        if contact.touching[at] || !contact.touching_next[at] || !surface.leads(at) {
            continue;
        }
        let node = &surface.nodes()[at];
        let speed = -normal;
        let smallest_gap = 0.25 * speed * step;
        if gap < smallest_gap {
            let largest_step = 4.0 * gap / speed;
            let obstacle = node.obstacle;
            let plane = problem.obstacles()[obstacle].as_plane().is_some();
            return Err(SimulationError::StartsTooNear {
                node: node.node.index(),
                obstacle,
                plane,
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
