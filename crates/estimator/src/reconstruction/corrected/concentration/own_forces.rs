//! The contact forces of the auxiliary solution where a node touches alone.
//!
//! The force of the simulation is too large there, because the mesh lacks the compliance of the body close to the node.
//! A force that is smaller for longer has another impulse after each contact phase. Such a node of the auxiliary
//! solution therefore has a contact of its own, with Coulomb friction: it touches and is released by its own gap.
//!
//! Where neighbours are released, a node that touched with them begins to touch alone. The auxiliary solution, which
//! the forces of the simulation moved until then, may have it behind its plane. To bring it back within a step would
//! take a force that grows with the inverse square of the step. So the depth that a node has at the beginning falls in
//! a step by (Δt/τ)² of it, τ the time of the impulse smoothing. Steps as long as τ bring the node to its plane at
//! once.

use super::Concentration;
use crate::concentrated::{ShapeCosts, TractionShape};
use crate::reconstruction::corrected::motions::Approach;
use percute_core::contact::{Coulomb, Frame};
use percute_core::problem::Problem;

/// A hat with less than this share does not make a node wide.
const SHARE: f64 = 1e-6;

/// The forces at two planes of a node are made in turn at most so often, until they change by less than this part. They
/// settle in 10 to 30 turns, but where widths jump.
const TURNS: usize = 60;
const SETTLED: f64 = 1e-10;

/// Bisections of the force: to 1e-12 of the largest.
const BISECTIONS: usize = 40;

/// The own forces of the nodes of the contact surface.
#[derive(Clone, Debug)]
pub(in crate::reconstruction::corrected) struct OwnForces<const D: usize> {
    /// The contacts with a force at the step before.
    contacts: Vec<Option<OwnContact<D>>>,
    /// Nodes whose force has been replaced at any step.
    replaced: Vec<bool>,
}

/// The contact of one node.
#[derive(Clone, Copy, Debug)]
struct OwnContact<const D: usize> {
    /// The force (N).
    force: [f64; D],
    /// The force over its normal part.
    direction: [f64; D],
    /// Displacement along the plane at which the traction sticks (m).
    anchor: [f64; D],
    /// What is left of the depth that the node had at the beginning (m).
    depth: f64,
}

impl<const D: usize> OwnForces<D> {
    pub(in crate::reconstruction::corrected) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        let count = problem.surface().nodes().len();
        Self { contacts: vec![None; count], replaced: vec![false; count] }
    }

    /// Number of nodes whose force has been replaced at any step.
    pub(in crate::reconstruction::corrected) fn count(&self) -> usize {
        self.replaced.iter().filter(|&&replaced| replaced).count()
    }

    /// Replaces the smoothed forces of the simulation (N), the first of the two fields, at nodes that touch alone, from
    /// then on until the own force is 0. The second field has the reactions of which the normal work is measured: none
    /// at these nodes, where the loss is in the misfit of the motion. `gap` are the gaps of the simulation (m), `steps`
    /// the step over the time τ of each node.
    pub(in crate::reconstruction::corrected) fn apply<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        concentration: &Concentration<D>,
        gap: &[f64],
        approach: impl Fn(usize) -> Approach<D>,
        steps: impl Fn(usize) -> f64,
        [contact, arresting]: [&mut [[f64; D]]; 2],
    ) {
        let surface = problem.surface();
        let mut known = Known { problem, concentration, gap, steps: &steps, contact, arresting };
        let stands = |at: usize| surface.leads(at) && surface.sliding_of(at).is_none();
        for (at, node) in surface.nodes().iter().enumerate().filter(|&(at, node)| node.free && stands(at)) {
            match node.beside {
                None => {
                    let last = self.contacts[at].take();
                    self.contacts[at] = self.replace(at, last, approach(at), &mut known);
                }
                Some(beside) if at < beside => self.replace_both([at, beside], &approach, &mut known),
                Some(_) => {}
            }
        }
    }

    /// The same at both planes of a node, each under the force of the other one, in turn.
    fn replace_both<const N: usize>(
        &mut self,
        entries: [usize; 2],
        approach: &impl Fn(usize) -> Approach<D>,
        known: &mut Known<'_, D, N>,
    ) {
        let nodes = known.problem.surface().nodes();
        let last = entries.map(|at| self.contacts[at].take());
        let simulated = entries.map(|at| known.contact[at]);
        for _ in 0..TURNS {
            let before = entries.map(|at| known.contact[at]);
            for k in (0..2).filter(|&k| nodes[entries[k]].free) {
                let (at, other) = (entries[k], known.contact[entries[1 - k]]);
                let frame = known.problem.obstacles()[nodes[at].obstacle].flat_frame();
                let under = approach(at).under(&frame, &other);
                known.contact[at] = simulated[k];
                self.contacts[at] = self.replace(at, last[k], under, known);
            }
            let after = entries.map(|at| known.contact[at]);
            let size = after.as_flattened().iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            let changes = after.as_flattened().iter().zip(before.as_flattened()).map(|(a, b)| (a - b).abs());
            if changes.fold(0.0, f64::max) <= SETTLED * size {
                return;
            }
        }
    }

    /// Replaces the force of a node, if it touches alone or did at the step before, by that of its own contact, which
    /// is returned.
    fn replace<const N: usize>(
        &mut self,
        at: usize,
        last: Option<OwnContact<D>>,
        approach: Approach<D>,
        known: &mut Known<'_, D, N>,
    ) -> Option<OwnContact<D>> {
        let Known { problem, concentration, gap, steps, contact, arresting } = known;
        let node = &problem.surface().nodes()[at];
        let obstacle = &problem.obstacles()[node.obstacle];
        // Reactions of a foreign history need not be in the cone.
        let simulated = obstacle.flat_frame().split(&obstacle.project_into_cone(&contact[at])).0;
        let depth = last.map_or((-approach.gap_now).max(0.0), |last| last.depth);
        let depth = depth * (1.0 - steps(at).min(1.0).powi(2));
        let largest = (-(approach.gap + depth) / approach.mobility).max(0.0);
        if last.is_none() && simulated == 0.0 && largest == 0.0 {
            return None;
        }
        let gaps = concentration.gaps(at, gap)?;
        let own = Own {
            frame: obstacle.flat_frame(),
            // Along a support the reaction is the support's.
            law: (!node.guided).then(|| obstacle.law()),
            approach,
            depth,
        };
        let direction = last.map_or(*own.frame.normal(), |last| last.direction);
        let costs = concentration.costs(problem, at, &direction, &gaps)?;
        if last.is_none() && !alone(&costs.shape(if simulated > 0.0 { simulated } else { largest })) {
            return None;
        }
        let made = own.contact(&costs, own.normal(&costs, largest), last);
        contact[at] = made.map_or([0.0; D], |own| own.force);
        arresting[at] = [0.0; D];
        self.replaced[at] = true;
        if let Some(opposite) = node.opposite {
            (contact[opposite], arresting[opposite]) = (contact[at].map(|f| -f), [0.0; D]);
            self.replaced[opposite] = true;
        }
        made
    }
}

/// The data of a step, and the forces that are replaced.
struct Known<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D, N>,
    concentration: &'a Concentration<D>,
    /// Gaps of the simulation (m).
    gap: &'a [f64],
    /// The step over the time τ of each node.
    steps: &'a dyn Fn(usize) -> f64,
    contact: &'a mut [[f64; D]],
    arresting: &'a mut [[f64; D]],
}

/// Whether the mesh lacks the local compliance: no hat is as wide as its edge.
fn alone(shape: &TractionShape) -> bool {
    shape.iter().all(|hat| hat.share <= SHARE || hat.halvings > 0)
}

/// A node that has a force of its own.
struct Own<const D: usize> {
    frame: Frame<D>,
    law: Option<Coulomb>,
    approach: Approach<D>,
    /// The depth at which the node may be at the next instant (m).
    depth: f64,
}

impl<const D: usize> Own<D> {
    /// The normal of the plane.
    fn across(&self) -> [f64; 2] {
        let normal = self.frame.normal();
        [normal[0], normal[D - 1]]
    }

    /// The normal force (N) under which the node comes to its plane with the local compliance of its traction;
    /// `largest` brings it there without.
    fn normal(&self, costs: &ShapeCosts<'_>, largest: f64) -> f64 {
        let across = self.across();
        let (mut low, mut high) = (0.0, largest);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let local = costs.approach(&costs.shape(middle), across, middle);
            let remaining = self.approach.gap + self.depth + middle * self.approach.mobility + local;
            if remaining < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// The contact under a normal force (N): the traction sticks where it first touched, or slides at Coulomb's limit;
    /// `None` without a force.
    fn contact(&self, costs: &ShapeCosts<'_>, force: f64, last: Option<OwnContact<D>>) -> Option<OwnContact<D>> {
        if force == 0.0 {
            return None;
        }
        let (shape, normal, [now, next]) = (costs.shape(force), self.frame.normal(), self.approach.along);
        let (across, along) = (self.across(), [-self.across()[1], self.across()[0]]);
        let anchor = last.map_or(now, |last| last.anchor);
        let tangent = [-normal[D - 1], normal[0]];
        let mobility = self.approach.mobility + costs.local(&shape, along, along);
        let away = (0..D).map(|c| (next[c] - anchor[c]) * tangent[c]).sum::<f64>()
            + force * costs.local(&shape, along, across);
        let (stick, limit) = (-away / mobility, self.law.map_or(0.0, |law| law.limit(force)));
        let friction = stick.clamp(-limit, limit);
        let slip = (friction - stick) * mobility;
        Some(OwnContact {
            force: std::array::from_fn(|c| force * normal[c] + friction * tangent[c]),
            direction: std::array::from_fn(|c| normal[c] + friction / force * tangent[c]),
            anchor: std::array::from_fn(|c| anchor[c] + slip * tangent[c]),
            depth: self.depth,
        })
    }
}
