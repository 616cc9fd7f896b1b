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
//!
//! Where the star of a node of a body that turns is strained much, the undeformed star says too little of its
//! compliance: the force of the simulation stays, or comes back.
//!
//! A node goes back to the force of the simulation where it touches with a neighbour that has one: beside it, an own
//! force would take back the work of a force that the auxiliary contact does not know.

use super::isolated_contact::{IsolatedContact, Own, tangent_of};
use super::{Concentration, Faced, NodeCosts};
use crate::concentrated::TractionShape;
use crate::reconstruction::corrected::auxiliary::Approach;
use percute_core::problem::Problem;
use std::cell::OnceCell;

/// Forces that move each other are made in turn at most so often, until they change by less than this part. Those at
/// two planes of a node settle in 10 to 30 turns, but where widths jump.
const TURNS: usize = 60;
const SETTLED: f64 = 1e-10;

/// The auxiliary contact forces of the nodes of the contact surface.
#[derive(Clone, Debug)]
pub(in crate::reconstruction::corrected) struct AuxiliaryForces<const D: usize> {
    /// The contacts with a force at the step before.
    contacts: Vec<Option<IsolatedContact<D>>>,
    /// Nodes whose force has been replaced at any step.
    replaced: Vec<bool>,
}

/// The data of a step, and the forces that are replaced.
pub(in crate::reconstruction::corrected) struct Known<'a, const D: usize> {
    pub(in crate::reconstruction::corrected) problem: &'a Problem<D>,
    pub(in crate::reconstruction::corrected) concentration: &'a Concentration<D>,
    /// Gaps of the simulation (m).
    pub(in crate::reconstruction::corrected) gap: &'a [f64],
    /// The step over the time τ of each node.
    pub(in crate::reconstruction::corrected) steps: &'a dyn Fn(usize) -> f64,
    /// Whether the star of a node is strained too much for an auxiliary contact.
    pub(in crate::reconstruction::corrected) strained: &'a dyn Fn(usize) -> bool,
    /// A vector at a node, turned back with its star.
    pub(in crate::reconstruction::corrected) unturned: &'a dyn Fn(usize, &[f64; D]) -> [f64; D],
    /// The smoothed forces of the simulation (N).
    pub(in crate::reconstruction::corrected) contact: &'a mut [[f64; D]],
    /// The reactions of which the normal work is measured (N): none at nodes whose force is replaced, where the loss is
    /// in the misfit of the motion.
    pub(in crate::reconstruction::corrected) arresting: &'a mut [[f64; D]],
}

impl<const D: usize> AuxiliaryForces<D> {
    pub(in crate::reconstruction::corrected) fn new(problem: &Problem<D>) -> Self {
        let count = problem.surface().nodes().len();
        Self { contacts: vec![None; count], replaced: vec![false; count] }
    }

    /// Number of nodes whose force has been replaced at any step.
    pub(in crate::reconstruction::corrected) fn count(&self) -> usize {
        self.replaced.iter().filter(|&&replaced| replaced).count()
    }

    /// The shape of the traction of each node that has an auxiliary contact force.
    pub(in crate::reconstruction::corrected) fn shapes(&self) -> Vec<Option<TractionShape>> {
        self.contacts.iter().map(|own| own.map(|own| own.shape)).collect()
    }

    /// Forgets the contact of a node whose traction cannot be hats any more: the force of the simulation acts again.
    pub(in crate::reconstruction::corrected) fn release(&mut self, at: usize) {
        self.contacts[at] = None;
    }

    /// The same of all nodes.
    pub(in crate::reconstruction::corrected) fn release_all(&mut self) {
        self.contacts.fill(None);
    }

    /// Replaces the forces of nodes that touch alone, from then on until the auxiliary contact force is 0. Those of
    /// non-matching interfaces stay.
    pub(in crate::reconstruction::corrected) fn replace(
        &mut self,
        known: &mut Known<'_, D>,
        free_gap: impl Fn(usize) -> f64,
        approach: impl FnMut(usize, &[[f64; D]]) -> Approach<D>,
    ) {
        let surface = known.problem.surface();
        (0..self.contacts.len()).filter(|&at| (known.strained)(at)).for_each(|at| self.release(at));
        let free = |at: usize| surface.nodes()[at].free && surface.leads(at) && surface.non_matching_of(at).is_none();
        let stands = |at: usize| free(at) && !(known.strained)(at);
        let touches = |at: usize| self.contacts[at].is_some() || known.contact[at] != [0.0; D] || free_gap(at) < 0.0;
        let nodes = (0..surface.nodes().len()).filter(|&at| stands(at) && touches(at));
        self.replace_in_turn(nodes.map(|at| (at, Faced::WHOLE)).collect(), known, approach);
    }

    /// The same at nodes that move each other, with all that they face, in turn. `approach` is the motion of one under
    /// the forces of the others and its own friction.
    pub(in crate::reconstruction::corrected) fn replace_in_turn(
        &mut self,
        nodes: Vec<(usize, Faced)>,
        known: &mut Known<'_, D>,
        mut approach: impl FnMut(usize, &[[f64; D]]) -> Approach<D>,
    ) {
        let simulated = known.contact.to_vec();
        let last: Vec<_> = nodes.iter().map(|&(at, _)| self.contacts[at].take()).collect();
        let mut made: Vec<Option<(Approach<D>, Option<IsolatedContact<D>>)>> = vec![None; nodes.len()];
        // The costs of shapes are the same in all turns.
        let costs: Vec<OnceCell<Option<NodeCosts<'_>>>> = vec![OnceCell::new(); nodes.len()];
        for _ in 0..TURNS {
            let (mut size, mut change) = (0.0_f64, 0.0_f64);
            for ((((at, faced), last), made), costs) in nodes.iter().zip(&last).zip(&mut made).zip(&costs) {
                let (before, under) = (known.contact[*at], approach(*at, known.contact));
                if made.is_none_or(|(known, _)| known != under) {
                    let costs = || costs.get_or_init(|| known.costs((*at, faced), *last)).as_ref();
                    let own = known.isolated_contact(*at, *last, &simulated, under, costs);
                    known.act(*at, own.map_or(simulated[*at], |own| own.force));
                    *made = Some((under, own));
                }
                for (after, before) in known.contact[*at].iter().zip(before) {
                    size = size.max(after.abs());
                    change = change.max((after - before).abs());
                }
            }
            if change <= SETTLED * size {
                break;
            }
        }
        for (&(at, _), own) in nodes.iter().zip(made) {
            if let Some((_, Some(own))) = own {
                self.contacts[at] = Some(own).filter(|own| own.force != [0.0; D]);
                for at in [Some(at), known.problem.surface().nodes()[at].partner].into_iter().flatten() {
                    known.arresting[at] = [0.0; D];
                    self.replaced[at] = true;
                }
            }
        }
    }
}

impl<'a, const D: usize> Known<'a, D> {
    /// Puts a force (N) on a node, and the opposite one on the node that it faces.
    fn act(&mut self, at: usize, force: [f64; D]) {
        self.contact[at] = force;
        if let Some(partner) = self.problem.surface().nodes()[at].partner {
            self.contact[partner] = force.map(|f| -f);
        }
    }

    /// The contact of its own of a node that touches alone or did at the step before, in place of its force among
    /// those of the simulation (N).
    fn isolated_contact<'c>(
        &self,
        at: usize,
        last: Option<IsolatedContact<D>>,
        simulated: &[[f64; D]],
        approach: Approach<D>,
        costs: impl FnOnce() -> Option<&'c NodeCosts<'c>>,
    ) -> Option<IsolatedContact<D>> {
        let Self { problem, concentration, steps, unturned, .. } = self;
        let node = &problem.surface().nodes()[at];
        let obstacle = &problem.obstacles()[node.obstacle];
        // Reactions of a foreign history need not be in the cone.
        let pushed = obstacle.flat_frame().split(&obstacle.project_into_cone(&simulated[at])).0;
        let depth = last.map_or((-approach.gap_now).max(0.0), |last| last.depth);
        let depth = depth * (1.0 - steps(at).min(1.0).powi(2));
        let frame = obstacle.flat_frame();
        let axes = [*frame.normal(), tangent_of(frame.normal())].map(|axis| {
            let axis = unturned(at, &axis);
            [axis[0], axis[D - 1]]
        });
        let own = Own {
            frame,
            axes,
            turns: problem.is_finite(),
            // Along a support the reaction is the support's.
            law: (!node.guided).then(|| obstacle.law()),
            approach,
            depth,
        };
        let largest = own.largest();
        if last.is_none() && pushed == 0.0 && largest == 0.0 {
            return None;
        }
        let costs = costs()?;
        let shape = costs.shape_again(if pushed > 0.0 { pushed } else { largest });
        let keeps = match last {
            None => costs.is_alone(&shape),
            Some(_) => pushed == 0.0 || !concentration.touches_beside(at, costs.wide(&shape), simulated),
        };
        if !keeps {
            return None;
        }
        Some(own.contact(costs, own.normal(costs, largest, last), steps(at), last))
    }

    /// The costs of the shapes of a node; none where its tributary density is best.
    fn costs(&self, (at, faced): (usize, &Faced), last: Option<IsolatedContact<D>>) -> Option<NodeCosts<'a>> {
        let Self { problem, concentration, gap, .. } = self;
        let gaps = concentration.gaps(at, faced, gap)?;
        let frame = problem.obstacles()[problem.surface().nodes()[at].obstacle].flat_frame();
        let direction = last.map_or(*frame.normal(), |last| last.direction);
        concentration.costs(problem, at, faced, &(self.unturned)(at, &direction), &gaps)
    }
}
