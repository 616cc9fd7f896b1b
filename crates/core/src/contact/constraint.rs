//! Contact constraints of one step.

use super::coulomb::Coulomb;
use super::frame::Frame;
use super::surface::ContactSurface;

/// A constraint that the step violates without its reaction: a node must not lie behind its obstacle at t_{n+1}.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constraint<const D: usize> {
    /// Position in the contact surface.
    pub(crate) at: usize,
    pub(super) frame: Frame<D>,
    pub(super) law: Coulomb,
    /// Mass that the reaction moves (kg).
    pub(super) mass: f64,
    /// Gap at t_{n+1} without the reaction (m).
    pub(super) gap: f64,
    /// Tangential part of v_{n+½} without the reaction (m/s).
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

/// Collects the violated constraints of a step, in the order of the contact surface.
pub(crate) fn violated<const D: usize>(
    surface: &ContactSurface<D>,
    prediction: &Prediction<'_, D>,
    constraints: &mut Vec<Constraint<D>>,
) {
    constraints.clear();
    let [dt, h] = prediction.steps;
    for (at, contact) in surface.nodes().iter().enumerate().filter(|(_, contact)| contact.free) {
        let node = contact.node.index();
        let displacement = &prediction.displacement[node];
        let frame = surface.frame(at, displacement);
        let mut predicted = prediction.velocity[node];
        (0..D).for_each(|c| predicted[c] += h * prediction.inverse_mass[node] * prediction.force[node][c]);
        let (normal, sliding) = frame.split(&predicted);
        let gap = surface.gap(at, displacement) + dt * normal;
        if gap < -prediction.tolerance {
            let (law, mass) = (surface.law(at), prediction.mass[node]);
            constraints.push(Constraint { at, frame, law, mass, gap, sliding });
        }
    }
}
