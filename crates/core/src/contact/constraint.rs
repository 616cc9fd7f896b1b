//! Contact constraints of one step.

use super::coulomb::Coulomb;
use super::frame::{Frame, dot};
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
    /// v_{n+½} against the obstacle, without the reaction (m/s).
    pub(super) velocity: [f64; D],
}

impl<const D: usize> Constraint<D> {
    /// The reaction (N) if no other constraint has the node, for a step of these Δt_n and h_n (s).
    pub(super) fn alone(&self, [dt, h]: [f64; 2]) -> [f64; D] {
        let Self { frame, law, mass, gap, velocity, .. } = self;
        // Normal: end exactly on the obstacle. Tangential: stop, as far as Coulomb's cone allows.
        let normal = -mass * gap / (dt * h);
        let (stop, (_, sliding)) = (mass / h, frame.split(velocity));
        let scale = law.admissible(normal, stop * dot(&sliding, &sliding).sqrt(), stop);
        std::array::from_fn(|c| normal * frame.normal()[c] - scale * sliding[c])
    }
}

/// The constraints of a step, in the order of the contact surface.
#[derive(Clone, Debug)]
pub(crate) struct Constraints<const D: usize> {
    /// The nodes that may have one, by their position. Those of surfaces that slide have none here.
    candidates: Vec<usize>,
    /// Those that are violated.
    pub(super) single: Vec<Constraint<D>>,
    /// Both of nodes at two planes, of which at least one is violated.
    pub(super) corners: Vec<[Constraint<D>; 2]>,
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
    /// v_{n+½} of a node (m/s), from h_n over its mass (s/kg).
    #[inline]
    pub(super) fn velocity_after(&self, node: usize, over_mass: f64) -> [f64; D] {
        let mut velocity = self.velocity[node];
        (0..D).for_each(|c| velocity[c] += over_mass * self.force[node][c]);
        velocity
    }

    /// The motion of a node of the contact surface against its obstacle.
    #[inline]
    fn motion(&self, surface: &ContactSurface<D>, at: usize) -> Motion<D> {
        let ([dt, h], contact) = (self.steps, &surface.nodes()[at]);
        let displacement = surface.against_obstacle(at, self.displacement);
        let frame = surface.frame(at, &displacement);
        let velocity_of = |node: NodeId| self.velocity_after(node.index(), h * self.inverse_mass[node.index()]);
        let mut velocity = velocity_of(contact.node);
        if let Some(opposite) = contact.opposite {
            let other = velocity_of(surface.nodes()[opposite].node);
            (0..D).for_each(|c| velocity[c] -= other[c]);
        }
        let gap = surface.gap(at, &displacement) + dt * frame.split(&velocity).0;
        Motion { frame, gap, velocity }
    }

    /// The constraint of a node with this motion.
    #[inline]
    fn constraint(&self, surface: &ContactSurface<D>, at: usize, motion: Motion<D>) -> Constraint<D> {
        let Motion { frame, gap, velocity } = motion;
        let (law, mass) = (surface.law(at), surface.moved_mass(at, self.mass));
        Constraint { at, frame, law, mass, gap, velocity }
    }

    fn is_violated(&self, motion: &Motion<D>) -> bool {
        motion.gap < -self.tolerance
    }
}

/// The motion of a node against its obstacle without its reaction: the frame, the gap at t_{n+1} (m) and v_{n+½} (m/s).
#[derive(Clone, Copy)]
struct Motion<const D: usize> {
    frame: Frame<D>,
    gap: f64,
    velocity: [f64; D],
}

impl<const D: usize> Constraints<D> {
    pub(crate) fn new(surface: &ContactSurface<D>) -> Self {
        let nodes = surface.nodes();
        let has = |at: &usize| nodes[*at].free && surface.leads(*at) && surface.sliding_of(*at).is_none();
        Self { candidates: (0..nodes.len()).filter(has).collect(), single: Vec::new(), corners: Vec::new() }
    }

    /// Collects those of a step.
    pub(crate) fn collect(&mut self, surface: &ContactSurface<D>, prediction: &Prediction<'_, D>) {
        let Self { candidates, single, corners } = self;
        single.clear();
        corners.clear();
        let nodes = surface.nodes();
        for &at in &*candidates {
            let beside = nodes[at].beside.filter(|&beside| nodes[beside].free);
            if beside.is_some_and(|beside| beside < at) {
                continue;
            }
            let own = prediction.motion(surface, at);
            let violated = prediction.is_violated(&own);
            if let Some(beside) = beside {
                let other = prediction.motion(surface, beside);
                if violated || prediction.is_violated(&other) {
                    corners.push(
                        [(at, own), (beside, other)].map(|(at, motion)| prediction.constraint(surface, at, motion)),
                    );
                }
            } else if violated {
                single.push(prediction.constraint(surface, at, own));
            }
        }
    }
}
