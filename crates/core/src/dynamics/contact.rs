//! Reactions and touching status along the steps.

use super::Dynamics;
use crate::contact::{Constraints, NonMatchingContact, Predicted, Prediction, solve};

/// Contact at one step.
#[derive(Clone, Debug)]
pub(super) struct StepContact<const D: usize> {
    /// R_n on the nodes of the contact surface (N), global axes.
    pub(super) reaction: Vec<[f64; D]>,
    /// Touching status at t_n.
    pub(super) touching: Vec<bool>,
    /// Touching status at t_{n+1}.
    pub(super) touching_next: Vec<bool>,
    /// Each node of the contact surface among those of the mesh, and 1/m (1/kg).
    nodes: Vec<(usize, f64)>,
    predicted: Vec<Predicted<D>>,
    constraints: Constraints<D>,
    /// One for each non-matching interface.
    non_matching: Vec<NonMatchingContact>,
}

impl<const D: usize> StepContact<D> {
    pub(super) fn new(dynamics: &Dynamics<'_, D>) -> Self {
        let surface = dynamics.problem.surface();
        let count = surface.nodes().len();
        let node = |at: usize| surface.nodes()[at].node.index();
        let nodes = (0..count).map(|at| (node(at), dynamics.inverse_mass[node(at)]));
        let non_matching = |index| NonMatchingContact::new(surface, index, &dynamics.inverse_mass);
        Self {
            reaction: vec![[0.0; D]; count],
            touching: vec![false; count],
            touching_next: vec![false; count],
            nodes: nodes.collect(),
            predicted: Vec::with_capacity(count),
            constraints: Constraints::new(surface, dynamics.problem.mass()),
            non_matching: (0..surface.non_matching().len()).map(non_matching).collect(),
        }
    }

    /// Reactions at t_n that keep candidate nodes out of the obstacles at t_{n+1}; they are added to
    /// `force`. `velocity` is v_{n−½} (v₀ at the start).
    pub(super) fn react(
        &mut self,
        dynamics: &Dynamics<'_, D>,
        n: usize,
        displacement: &[[f64; D]],
        velocity: &[[f64; D]],
        force: &mut [[f64; D]],
    ) {
        let problem = dynamics.problem;
        let steps = [dynamics.times.step(n), dynamics.times.velocity_step(n)];
        // All reads of scattered nodes are here, side by side.
        let predict = |&(node, inverse): &(usize, f64)| {
            Predicted::new(displacement[node], &velocity[node], &force[node], steps[1] * inverse)
        };
        self.predicted.clear();
        self.predicted.extend(self.nodes.iter().map(predict));
        let prediction = Prediction { nodes: &self.predicted, steps, tolerance: problem.contact_tolerance() };
        self.constraints.collect(problem.surface(), &prediction);
        std::mem::swap(&mut self.touching, &mut self.touching_next);
        self.touching_next.fill(false);
        self.reaction.fill([0.0; D]);
        for non_matching in &mut self.non_matching {
            non_matching.react(problem.surface(), &prediction, &mut self.reaction, &mut self.touching_next);
        }
        solve(&self.constraints, steps, problem.contact_tolerance(), |at, reaction| {
            let nodes = problem.surface().nodes();
            let mut act = |at: usize, reaction: [f64; D]| {
                let node = self.nodes[at].0;
                (0..D).for_each(|c| force[node][c] += reaction[c]);
                self.reaction[at] = reaction;
                self.touching_next[at] = true;
            };
            act(at, reaction);
            if let Some(partner) = nodes[at].partner {
                act(partner, reaction.map(|r| -r));
            }
        });
        self.non_matching.iter().for_each(|non_matching| non_matching.add(problem.surface(), &self.reaction, force));
    }

    /// Touching at t_0: a node on its obstacle, without normal velocity, whose multiplier at t_0 is active; a node of a
    /// master that such a multiplier acts on, if it faces the slave at t_0 already.
    pub(super) fn settle_start(&mut self, dynamics: &Dynamics<'_, D>) {
        let problem = dynamics.problem;
        let starts = problem.starts_of_contact();
        for (at, &(gap, normal)) in starts.iter().enumerate() {
            self.touching[at] = self.touching_next[at]
                && gap <= problem.contact_tolerance()
                && normal.abs() <= problem.speed_tolerance();
        }
        for non_matching in &self.non_matching {
            non_matching.settle_master(problem.surface(), &mut self.touching);
        }
        for (touches, (gap, _)) in self.touching.iter_mut().zip(&starts) {
            *touches &= gap.is_finite();
        }
    }
}
