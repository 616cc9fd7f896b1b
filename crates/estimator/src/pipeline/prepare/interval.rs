//! The fields that become known over a step: F_DA, then ã, ∫ã dt and the friction part of η.

use super::Preparation;
use crate::acceleration::accelerate;
use crate::contact_density::{CornerSliding, Densities, OffContact, driving_forces};
use crate::increment::Increment;
use crate::nodal_field::NodalField;
use crate::reconstruction::{self, SurfaceSteps};
use crate::time_level::{BeforeJump, ForcesBefore, ForcesKnown, KnownInertia, MotionKnown, Velocities};

impl<const D: usize, const N: usize> Preparation<'_, D, N> {
    /// Finds F_DA over the earliest step that lacks it; then ã and ∫ã are known up to its end.
    pub(super) fn complete_interval(&mut self) {
        let Some(next) = self.motions.pop_front() else { return };
        let Some(mut now) = self.current.take() else { return };
        let after = self.motions.front().map(|motion| &motion.level.surface);
        let (surface, before) = (&now.forces.level.surface, self.before.as_ref());
        let steps = SurfaceSteps { before, now: surface, next: &next.level.surface, after };
        let densities = self.reconstruction.densities(&steps);
        let off_contact = self.reconstruction.off_contact(&steps, &densities);
        reconstruction::check(self.problem, &steps, &densities, off_contact.is_some(), &mut self.residuals);
        self.impulse.add(self.problem, self.times, now.forces.level.index, &densities, &surface.reaction);
        // The densities of the level are in those of the step.
        now.forces.level.surface.densities = None;
        self.before = Some(now.forces.level.surface.clone());
        let now = self.after(now, densities.start);
        self.current = Some(self.reach(&now, next, densities.end, off_contact));
        self.ready.push_back(now);
    }

    /// The first level, before which there is no contact force.
    pub(super) fn first(&self, first: MotionKnown<D>) -> ForcesBefore<D> {
        let MotionKnown { level, now: motion, inertia, .. } = first;
        let increment = Increment::zero(&self.pool);
        let skew_increment = level.split.as_ref().map(|_| increment.clone());
        let (acceleration, surface_force) = self.acceleration(inertia, &[]);
        let forces = ForcesKnown {
            level,
            now: Velocities { motion, increment, skew_increment },
            mid_velocity: None,
            acceleration,
            density: Densities::none(self.problem),
            before: None,
            off_contact: Vec::new(),
            corner_sliding: Vec::new(),
            friction: vec![[0.0; 2]; self.problem.surface().faces().len()],
        };
        ForcesBefore { forces, surface_force }
    }

    /// A level with the density at the beginning of the step that follows: ã after t_n \[55\].
    fn after(&self, level: ForcesBefore<D>, density: Densities<D>) -> ForcesKnown<D> {
        let ForcesBefore { mut forces, surface_force } = level;
        let pull = driving_forces(self.problem, &density);
        let earlier = std::mem::replace(&mut forces.density, density);
        if forces.level.index > 0 && earlier != forces.density {
            forces.before = Some(BeforeJump { acceleration: self.on_surface(&forces.acceleration), density: earlier });
        }
        let surface = self.problem.surface();
        for (at, (contact, force)) in surface.nodes().iter().zip(&surface_force).enumerate() {
            let (i, pull) = (contact.node.index(), surface.force_on_node(at, &pull));
            forces.acceleration[i] = std::array::from_fn(|c| (force[c] + pull[c]) * self.dynamics.inverse_mass()[i]);
        }
        forces
    }

    /// The level after `now`, with the density at the end of the step between: ã before t_{n+1} \[55\], and ∫ã dt, as ã
    /// is linear over the step, like o₂.
    fn reach(
        &self,
        now: &ForcesKnown<D>,
        next: MotionKnown<D>,
        density: Densities<D>,
        off_contact: Option<OffContact<D>>,
    ) -> ForcesBefore<D> {
        let length = self.times.step(now.level.index);
        let friction = self.reconstruction.friction(self.problem, length, now, &next, &density);
        let corner_sliding = next.mid_velocity.as_ref().map_or_else(Vec::new, |middle| {
            let velocities = [now.now.motion.velocity(), middle, next.now.velocity()];
            CornerSliding::all(self.problem, now.level.index, velocities, [&now.density, &density])
        });
        let MotionKnown { level, now: motion, mid_velocity, inertia } = next;
        let (acceleration, surface_force) = self.acceleration(inertia, &driving_forces(self.problem, &density));
        let increment = now.now.increment.advance(length, &now.acceleration, &acceleration);
        let skew = now.now.skew_increment.as_ref().zip(now.level.skew().zip(level.skew()));
        let skew_increment = skew.map(|(so_far, (start, end))| so_far.advance(length, start, end));
        let forces = ForcesKnown {
            level,
            now: Velocities { motion, increment, skew_increment },
            mid_velocity,
            acceleration,
            density,
            before: None,
            off_contact: off_contact.into_iter().collect(),
            corner_sliding,
            friction,
        };
        ForcesBefore { forces, surface_force }
    }

    /// ã under these nodal forces of F_DA (N), and the forces but these on the contact surface, where ã depends on
    /// them.
    fn acceleration(&self, inertia: KnownInertia<D>, pull: &[[f64; D]]) -> (NodalField<D>, Vec<[f64; D]>) {
        match inertia {
            KnownInertia::Forces(mut force) => {
                let surface_force = self.on_surface(&force);
                accelerate(self.problem, self.dynamics.inverse_mass(), &mut force, pull);
                (force, surface_force)
            }
            KnownInertia::Acceleration(acceleration) => (acceleration, Vec::new()),
        }
    }

    /// The values of a nodal field on the contact surface.
    fn on_surface(&self, field: &[[f64; D]]) -> Vec<[f64; D]> {
        self.problem.surface().nodes().iter().map(|contact| field[contact.node.index()]).collect()
    }
}
