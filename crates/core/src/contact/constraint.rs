//! Contact constraints of one step.

use super::coulomb::Coulomb;
use super::frame::{Frame, dot};
use super::prediction::Prediction;
use super::surface::ContactSurface;

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
    /// The nodes that may have one, by their position. Those of non-matching interfaces have none here.
    candidates: Vec<usize>,
    /// [`ContactSurface::moved_mass`] of all nodes (kg).
    moved: Vec<f64>,
    /// Those that are violated.
    pub(super) single: Vec<Constraint<D>>,
    /// Both of nodes at two planes, of which at least one is violated.
    pub(super) corners: Vec<[Constraint<D>; 2]>,
}

/// The motion of a node against its obstacle without its reaction: the frame, the gap at t_{n+1} (m) and v_{n+½} (m/s).
#[derive(Clone, Copy)]
struct RelativeMotion<const D: usize> {
    frame: Frame<D>,
    gap: f64,
    velocity: [f64; D],
}

impl<const D: usize> RelativeMotion<D> {
    #[inline]
    fn new(surface: &ContactSurface<D>, at: usize, prediction: &Prediction<'_, D>) -> Self {
        let mut motion = prediction.nodes[at];
        if let Some(partner) = surface.nodes()[at].partner {
            motion = motion.against(&prediction.nodes[partner]);
        }
        let frame = surface.frame(at, &motion.displacement);
        let gap = surface.gap(at, &motion.displacement) + prediction.steps[0] * dot(&motion.velocity, frame.normal());
        Self { frame, gap, velocity: motion.velocity }
    }
}

impl<const D: usize> Constraints<D> {
    /// From the masses of all nodes (kg).
    pub(crate) fn new(surface: &ContactSurface<D>, mass: &[f64]) -> Self {
        let nodes = surface.nodes();
        let has = |at: &usize| nodes[*at].free && surface.leads(*at) && surface.non_matching_of(*at).is_none();
        Self {
            candidates: (0..nodes.len()).filter(has).collect(),
            moved: (0..nodes.len()).map(|at| surface.moved_mass(at, mass)).collect(),
            single: Vec::new(),
            corners: Vec::new(),
        }
    }

    /// Collects those of a step.
    pub(crate) fn collect(&mut self, surface: &ContactSurface<D>, prediction: &Prediction<'_, D>) {
        let Self { candidates, moved, single, corners } = self;
        single.clear();
        corners.clear();
        let nodes = surface.nodes();
        let is_violated = |motion: &RelativeMotion<D>| motion.gap < -prediction.tolerance;
        let constraint = |at: usize, RelativeMotion { frame, gap, velocity }: RelativeMotion<D>| {
            let (law, mass) = (surface.law(at), moved[at]);
            Constraint { at, frame, law, mass, gap, velocity }
        };
        for &at in &*candidates {
            let second_slot = nodes[at].second_slot.filter(|&second_slot| nodes[second_slot].free);
            if second_slot.is_some_and(|second_slot| second_slot < at) {
                continue;
            }
            let own = RelativeMotion::new(surface, at, prediction);
            let violated = is_violated(&own);
            if let Some(second_slot) = second_slot {
                let other = RelativeMotion::new(surface, second_slot, prediction);
                if violated || is_violated(&other) {
                    corners.push([(at, own), (second_slot, other)].map(|(at, motion)| constraint(at, motion)));
                }
            } else if violated {
                single.push(constraint(at, own));
            }
        }
    }
}
