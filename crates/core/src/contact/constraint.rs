//! Contact constraints of one step.

use super::coulomb::Coulomb;
use super::frame::Frame;
use super::surface::ContactSurface;
use crate::ids::NodeId;

/// A constraint that the step violates without its reaction: a node must not lie behind its obstacle at t_{n+1}.
/// Of two nodes that may touch, the first one has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constraint<const D: usize> {
    /// Position in the contact surface.
    pub(crate) at: usize,
    pub(super) frame: Frame<D>,
    pub(super) law: Coulomb,
    /// Mass that the reaction moves (kg), [`ContactSurface::moved_mass`].
    pub(super) mass: f64,
    /// Gap at t_{n+1} without the reaction (m).
    pub(super) gap: f64,
    /// Tangential part of v_{n+½} against the obstacle, without the reaction (m/s).
    pub(super) sliding: [f64; D],
}

/// The motion that a step would have without reactions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prediction<'a, const D: usize> {
    /// u_n (m).
    pub(crate) displacement: &'a [[f64; D]],
    /// v_{n−½} (m/s), v₀ at the start.
    pub(crate) velocity: &'a [[f64; D]],
    /// F_n − K u_n (N).
    pub(crate) force: &'a [[f64; D]],
    /// Lumped masses (kg) and their inverses.
    pub(crate) mass: &'a [f64],
    pub(crate) inverse_mass: &'a [f64],
    /// Δt_n and h_n (s).
    pub(crate) steps: [f64; 2],
    /// Gaps above minus this are no contact (m).
    pub(crate) tolerance: f64,
}

impl<const D: usize> Prediction<'_, D> {
    /// v_{n+½} of a node (m/s), h after v_{n−½}.
    #[inline]
    fn velocity_after(&self, node: NodeId, h: f64) -> [f64; D] {
        let node = node.index();
        let mut velocity = self.velocity[node];
        (0..D).for_each(|c| velocity[c] += h * self.inverse_mass[node] * self.force[node][c]);
        velocity
    }
}

/// Collects the violated constraints of a step, in the order of the contact surface.
pub(crate) fn violated<const D: usize>(
    surface: &ContactSurface<D>,
    prediction: &Prediction<'_, D>,
    constraints: &mut Vec<Constraint<D>>,
) {
    constraints.clear();
    let [dt, h] = prediction.steps;
    let nodes = surface.nodes();
    for at in (0..nodes.len()).filter(|&at| nodes[at].free && surface.leads(at)) {
        let displacement = surface.against_obstacle(at, prediction.displacement);
        let frame = surface.frame(at, &displacement);
        let mut predicted = prediction.velocity_after(nodes[at].node, h);
        if let Some(opposite) = nodes[at].opposite {
            let other = prediction.velocity_after(nodes[opposite].node, h);
            (0..D).for_each(|c| predicted[c] -= other[c]);
        }
        let (normal, sliding) = frame.split(&predicted);
        let gap = surface.gap(at, &displacement) + dt * normal;
        if gap < -prediction.tolerance {
            let (law, mass) = (surface.law(at), surface.moved_mass(at, prediction.mass));
            constraints.push(Constraint { at, frame, law, mass, gap, sliding });
        }
    }
}
