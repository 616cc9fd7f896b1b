//! Contact reactions of one step (§5.3).

use super::Dynamics;
use crate::obstacle::dot;

/// What contact did at one step.
#[derive(Clone, Debug)]
pub(super) struct Contact<const D: usize> {
    /// R_n on the nodes of the contact surface (N), global axes.
    pub(super) reaction: Vec<[f64; D]>,
    /// Touching status at t_n.
    pub(super) touching: Vec<bool>,
    /// Touching status at t_{n+1}.
    pub(super) touching_next: Vec<bool>,
}

impl<const D: usize> Contact<D> {
    pub(super) fn new(count: usize) -> Self {
        Self { reaction: vec![[0.0; D]; count], touching: vec![false; count], touching_next: vec![false; count] }
    }

    /// Reactions at t_n that keep candidate nodes out of the planes at t_{n+1}; they are added to
    /// `force`. `velocity` is v_{n−½} (v₀ at the start).
    ///
    /// With a lumped mass no node's reaction moves another node, so that the fixed point of
    /// Tresca problems is reached in one pass. Coupled nodes (a consistent mass, deformable
    /// obstacles) would repeat this pass until the tangential forces settle.
    pub(super) fn react<const N: usize>(
        &mut self,
        dynamics: &Dynamics<'_, D, N>,
        n: usize,
        displacement: &[[f64; D]],
        velocity: &[[f64; D]],
        force: &mut [[f64; D]],
    ) {
        let problem = dynamics.problem;
        let (dt, h) = (dynamics.times.step(n), dynamics.times.velocity_step(n));
        let tolerance = problem.contact_tolerance();
        std::mem::swap(&mut self.touching, &mut self.touching_next);
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            let node = contact.node.index();
            self.reaction[at] = [0.0; D];
            self.touching_next[at] = false;
            if !contact.free {
                continue;
            }
            let plane = &problem.obstacles()[contact.obstacle];
            let (mass, inverse_mass) = (problem.mass()[node], dynamics.inverse_mass[node]);
            let mut predicted = velocity[node];
            (0..D).for_each(|c| predicted[c] += h * inverse_mass * force[node][c]);
            let (normal, tangential) = plane.split(&predicted);
            let gap = problem.surface().gap(at, &displacement[node], problem.obstacles()) + dt * normal;
            if gap >= -tolerance {
                continue;
            }
            // Normal: end exactly on the plane. Tangential: stop, as far as Coulomb's cone allows.
            let normal_force = -mass * gap / (dt * h);
            let stop = mass / h;
            let wanted = stop * dot(&tangential, &tangential).sqrt();
            // Where the support takes the tangential reaction, there is no friction.
            let limit = if contact.guided { 0.0 } else { plane.friction() * normal_force };
            let scale = if wanted > limit { stop * limit / wanted } else { stop };
            for c in 0..D {
                self.reaction[at][c] = normal_force * plane.normal()[c] - scale * tangential[c];
                force[node][c] += self.reaction[at][c];
            }
            self.touching_next[at] = true;
        }
    }

    /// Touching at t_0: a node on its plane, without normal velocity, whose multiplier at t_0 is
    /// active.
    pub(super) fn settle_start<const N: usize>(&mut self, dynamics: &Dynamics<'_, D, N>) {
        let problem = dynamics.problem;
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            let node = contact.node.index();
            let gap = problem.surface().gap(at, &problem.initial_displacement()[node], problem.obstacles());
            let (normal, _) = problem.obstacles()[contact.obstacle].split(&problem.initial_velocity()[node]);
            self.touching[at] = self.touching_next[at]
                && gap <= problem.contact_tolerance()
                && normal.abs() <= problem.speed_tolerance();
        }
    }
}
