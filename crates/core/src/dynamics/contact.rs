//! Reactions and touching status along the steps.

use super::Dynamics;
use crate::contact::{Constraints, ContactSurface, Prediction, SlidingContact, solve};

/// Contact at one step.
#[derive(Clone, Debug)]
pub(super) struct Contact<const D: usize> {
    /// R_n on the nodes of the contact surface (N), global axes.
    pub(super) reaction: Vec<[f64; D]>,
    /// Touching status at t_n.
    pub(super) touching: Vec<bool>,
    /// Touching status at t_{n+1}.
    pub(super) touching_next: Vec<bool>,
    constraints: Constraints<D>,
    /// One for each two surfaces that slide along each other.
    sliding: Vec<SlidingContact>,
}

impl<const D: usize> Contact<D> {
    pub(super) fn new<const N: usize>(dynamics: &Dynamics<'_, D, N>) -> Self {
        let surface = dynamics.problem.surface();
        let count = surface.nodes().len();
        let sliding = |index| SlidingContact::new(surface, index, &dynamics.inverse_mass);
        Self {
            reaction: vec![[0.0; D]; count],
            touching: vec![false; count],
            touching_next: vec![false; count],
            constraints: Constraints::new(surface),
            sliding: (0..surface.sliding().len()).map(sliding).collect(),
        }
    }

    /// Reactions at t_n that keep candidate nodes out of the obstacles at t_{n+1}; they are added to
    /// `force`. `velocity` is v_{n−½} (v₀ at the start).
    pub(super) fn react<const N: usize>(
        &mut self,
        dynamics: &Dynamics<'_, D, N>,
        n: usize,
        displacement: &[[f64; D]],
        velocity: &[[f64; D]],
        force: &mut [[f64; D]],
    ) {
        let problem = dynamics.problem;
        let steps = [dynamics.times.step(n), dynamics.times.velocity_step(n)];
        let prediction = Prediction {
            displacement,
            velocity,
            force,
            mass: problem.mass(),
            inverse_mass: &dynamics.inverse_mass,
            steps,
            tolerance: problem.contact_tolerance(),
        };
        self.constraints.collect(problem.surface(), &prediction);
        std::mem::swap(&mut self.touching, &mut self.touching_next);
        self.touching_next.fill(false);
        self.reaction.fill([0.0; D]);
        self.slide(problem.surface(), &prediction);
        solve(&self.constraints, steps, problem.contact_tolerance(), |at, reaction| {
            let nodes = problem.surface().nodes();
            let mut act = |at: usize, reaction: [f64; D]| {
                let node = nodes[at].node.index();
                (0..D).for_each(|c| force[node][c] += reaction[c]);
                self.reaction[at] = reaction;
                self.touching_next[at] = true;
            };
            act(at, reaction);
            if let Some(opposite) = nodes[at].opposite {
                act(opposite, reaction.map(|r| -r));
            }
        });
        self.sliding.iter().for_each(|sliding| sliding.add(problem.surface(), &self.reaction, force));
    }

    /// Reactions and touching status on surfaces that slide.
    fn slide(&mut self, surface: &ContactSurface<D>, prediction: &Prediction<'_, D>) {
        let Self { reaction, touching_next, sliding, .. } = self;
        for sliding in sliding {
            sliding.react(surface, prediction, |at, force| match force {
                Some(force) => reaction[at] = force,
                None => touching_next[at] = true,
            });
        }
    }

    /// Touching at t_0: a node on its obstacle, without normal velocity, whose multiplier at t_0 is
    /// active.
    pub(super) fn settle_start<const N: usize>(&mut self, dynamics: &Dynamics<'_, D, N>) {
        let problem = dynamics.problem;
        for (at, (gap, normal)) in problem.starts_of_contact().into_iter().enumerate() {
            self.touching[at] = self.touching_next[at]
                && gap <= problem.contact_tolerance()
                && normal.abs() <= problem.speed_tolerance();
        }
        for sliding in &self.sliding {
            sliding.settle_master(problem.surface(), &mut self.touching);
        }
    }
}
