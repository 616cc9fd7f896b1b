//! The sequential part: motion, contact force and ã of each step, in order.

mod impulse;
mod interval;
mod supports;

use crate::error::EstimateError;
use crate::estimate::Given;
use crate::kinematic::{ContactTrack, FreeMotion, Knot, Motion, NormalStep};
use crate::loaded::LoadedFacets;
use crate::options::{Ablation, Options};
use crate::reconstruction::{AuxiliarySolution, ImpulseSmoothing, Pressure, Reading, SurfaceStep, kinetic_energy};
use crate::residual::{Residuals, worse};
use crate::time_level::TimeLevel;
pub(crate) use impulse::Impulse;
use percute_core::dynamics::Dynamics;
use percute_core::history::{Step, StepCheck};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::collections::VecDeque;
use supports::SupportCheck;

/// A auxiliary solution whose kinetic energy is so many times the largest energy of the simulation is unstable: its error would be a
/// thousand times what there is.
const UNSTABLE: f64 = 1e6;

/// Turns steps into levels whose fields are known on both sides.
#[derive(Debug)]
pub(crate) struct Preparation<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    dynamics: Dynamics<'p, D, N>,
    loaded: LoadedFacets<'p, D, N>,
    reading: Reading<D>,
    /// What the balance of the reading `corrected` is built on.
    auxiliary: Option<AuxiliarySolution<D>>,
    stopping: Option<ImpulseSmoothing<D>>,
    /// Largest kinetic and strain energy of the simulation so far (J), for the auxiliary solution.
    liveliest: f64,
    every: usize,
    motion: FreeMotion<D>,
    tracks: Vec<ContactTrack>,
    supports: SupportCheck,
    /// Levels not yet handed on; `ready` of them are complete.
    levels: VecDeque<TimeLevel<D>>,
    ready: usize,
    /// Normal pressures of the steps since the last sampled level that was handed on.
    pressures: Vec<Vec<[Pressure<D>; 2]>>,
    /// The step before the first of `levels` that is not complete.
    before: Option<SurfaceStep<D>>,
    steps: StepCheck,
    pub(crate) impulse: Impulse,
    pub(crate) residuals: Residuals,
}

impl<'p, const D: usize, const N: usize> Preparation<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: &Options) -> Self {
        let reading = Reading::new(options.reconstruction, problem).without(options.ablation);
        Self {
            problem,
            times,
            dynamics: Dynamics::new(problem, times),
            loaded: LoadedFacets::new(problem),
            auxiliary: (matches!(reading, Reading::Corrected(_)) && options.ablation != Ablation::AuxiliarySolution)
                .then(|| AuxiliarySolution::new(problem, options.ablation != Ablation::Correction)),
            stopping: (reading.acts_off_contact() && options.ablation != Ablation::ImpulseSmoothing)
                .then(|| ImpulseSmoothing::new(problem)),
            liveliest: 0.0,
            reading,
            every: options.every,
            motion: FreeMotion::new(problem),
            tracks: Vec::new(),
            supports: SupportCheck::default(),
            levels: VecDeque::new(),
            ready: 0,
            pressures: Vec::new(),
            before: None,
            steps: StepCheck::default(),
            impulse: Impulse::default(),
            residuals: Residuals::default(),
        }
    }

    /// Number of steps taken in.
    pub(super) fn count(&self) -> usize {
        self.steps.count()
    }

    /// What the history brings of its own.
    pub(super) fn given(&self) -> Given {
        let [velocity, acceleration] = self.steps.given();
        Given { velocity, acceleration }
    }

    /// Which steps are sampled.
    pub(super) fn every(&self) -> usize {
        self.every
    }

    pub(super) fn tracks(&self) -> &[ContactTrack] {
        &self.tracks
    }

    /// Refuses a step that does not fit.
    pub(super) fn check(&self, step: &Step<'_, D>) -> Result<(), EstimateError> {
        self.steps.check(self.problem, self.times, step)?;
        match step.index {
            0 => self.check_start(step),
            1 => self.check_first_touch(step),
            _ => self.check_auxiliary(step),
        }
    }

    /// The first step is the initial state, and a node that touches in it rests on its plane.
    fn check_start(&self, step: &Step<'_, D>) -> Result<(), EstimateError> {
        let problem = self.problem;
        let tolerance = problem.contact_tolerance();
        for (node, (u, u0)) in step.displacement.iter().zip(problem.initial_displacement()).enumerate() {
            if u.iter().zip(u0).any(|(a, b)| (a - b).abs() > tolerance) {
                return Err(EstimateError::Start { node });
            }
        }
        for (node, (v, v0)) in step.velocity.unwrap_or_default().iter().zip(problem.initial_velocity()).enumerate() {
            if v.iter().zip(v0).any(|(a, b)| (a - b).abs() > problem.speed_tolerance()) {
                return Err(EstimateError::StartVelocity { node });
            }
        }
        for (at, contact) in problem.surface().nodes().iter().enumerate().filter(|&(at, _)| step.touching[at]) {
            let node = contact.node.index();
            let gap = problem.surface().gap(at, &step.displacement[node], problem.obstacles());
            let speed = problem.obstacles()[contact.obstacle].split(&problem.initial_velocity()[node]).0;
            if gap > tolerance || speed.abs() > problem.speed_tolerance() {
                return Err(EstimateError::StartsTouching { node, gap, speed });
            }
        }
        Ok(())
    }

    /// A node that touches at step 1 must start at least |v_n|Δt₀/4 away, or P_CA has no solution.
    fn check_first_touch(&self, step: &Step<'_, D>) -> Result<(), EstimateError> {
        let at_start = &self.levels[0].surface.touching;
        for (at, contact) in self.problem.surface().nodes().iter().enumerate() {
            if step.touching[at] && !at_start[at] {
                let (velocity, gap) = self.tracks[at].at(0);
                let smallest_gap = -0.25 * velocity * self.times.step(0);
                if gap < smallest_gap {
                    return Err(EstimateError::StartsTooNear { node: contact.node.index(), gap, smallest_gap });
                }
            }
        }
        Ok(())
    }

    /// Takes in one step.
    pub(super) fn push(&mut self, step: &Step<'_, D>) {
        let n = step.index;
        self.steps.accept(step);
        let mut force = vec![[0.0; D]; step.displacement.len()];
        let strain = self.dynamics.forces_without_contact(n, step.displacement, &mut force);
        // The equilibrium of ã needs what the scheme makes of u_n; the motion takes what is given.
        let acceleration =
            step.acceleration.map_or_else(|| self.total_acceleration(&force, step.reaction), <[_]>::to_vec);
        let (mid, now) = self.motion.advance(self.problem, self.times, &acceleration, step.velocity);

        let knot = |(displacement, velocity)| Knot { displacement, velocity, increment: Vec::new() };
        let (mid, knot) = (mid.map(knot), knot(now));
        self.track_contact(step, mid.as_ref(), &knot);
        let miss = self.supports.advance(self.problem, self.times, n, &knot);
        self.residuals.supports = worse(self.residuals.supports, miss);

        let smoothed_reaction = match &mut self.stopping {
            Some(stopping) => stopping.advance(self.problem, self.times, n, step.reaction, &acceleration),
            None => step.reaction.to_vec(),
        };
        let (displacement, force) = self.source_of_balance(n, step.displacement, &smoothed_reaction, force);
        if self.auxiliary.is_some() {
            self.liveliest = self.liveliest.max(strain + kinetic_energy(&knot.velocity, self.problem.mass()));
        }
        self.levels.push_back(TimeLevel {
            displacement,
            force,
            body_force: self.problem.body_force_at(self.times.instants()[n]),
            load_moments: self.loaded.moments(self.times.instants()[n]),
            surface: SurfaceStep {
                reaction: step.reaction.to_vec(),
                smoothed_reaction,
                touching: step.touching.to_vec(),
            },
            ..TimeLevel::new(n, mid, knot, self.problem.surface().facets().len())
        });
        if n == 0 {
            self.start();
        } else if n >= 2 {
            self.complete_interval();
        }
    }

    /// Refuses to go on with an auxiliary solution that has become unstable, as it does where a history of another scheme takes
    /// steps above the critical one: a stable one has about the energy of the simulation, an unstable one soon any.
    fn check_auxiliary(&self, step: &Step<'_, D>) -> Result<(), EstimateError> {
        let Some(auxiliary) = &self.auxiliary else { return Ok(()) };
        let energy = auxiliary.kinetic_energy(self.problem.mass());
        // A body that starts unstrained at rest has no energy before it is loaded.
        if self.liveliest > 0.0 && energy > UNSTABLE * self.liveliest {
            let longest_step = self.times.longest_step();
            return Err(EstimateError::AuxiliarySolution { step: step.index, time: step.time, longest_step });
        }
        Ok(())
    }

    /// Takes in that no more steps come.
    pub(super) fn finish(&mut self) {
        self.complete_interval();
        if let Some(last) = self.levels.back_mut() {
            self.impulse.add_last(self.problem, self.times, last.index, &last.surface.reaction);
            // No step follows: both sides are one.
            last.density_after = last.density_before.clone();
        }
        self.ready = self.levels.len();
        let tolerance = self.problem.contact_tolerance();
        self.tracks.iter_mut().for_each(|track| track.finish(tolerance));
    }

    /// The next complete level that is sampled; others only carry the integral of ã on, and leave it their pressures.
    pub(super) fn next_ready(&mut self, last: bool) -> Option<TimeLevel<D>> {
        while self.ready > 0 {
            self.ready -= 1;
            let mut level = self.levels.pop_front()?;
            self.pressures.append(&mut level.pressures);
            let end = last && self.levels.is_empty();
            if level.index % self.every == 0 || end {
                level.pressures = std::mem::take(&mut self.pressures);
                return Some(level);
            }
        }
        None
    }

    /// M⁻¹ of these forces and of those of contact: a_n of the simulation, ã_n of the auxiliary solution.
    fn total_acceleration(&self, force: &[[f64; D]], reaction: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut acceleration = force.to_vec();
        for (contact, reaction) in self.problem.surface().nodes().iter().zip(reaction) {
            (0..D).for_each(|c| acceleration[contact.node.index()][c] += reaction[c]);
        }
        self.over_mass(&mut acceleration);
        acceleration
    }

    fn over_mass(&self, force: &mut [[f64; D]]) {
        for (f, inverse) in force.iter_mut().zip(self.dynamics.inverse_mass()) {
            (0..D).for_each(|c| f[c] *= inverse);
        }
    }

    /// The displacement whose stress is equilibrated, and its forces but contact: those of the simulation, or the
    /// auxiliary solution's, which then goes on to the next step.
    fn source_of_balance(
        &mut self,
        n: usize,
        displacement: &[[f64; D]],
        smoothed_reaction: &[[f64; D]],
        mut force: Vec<[f64; D]>,
    ) -> Motion<D> {
        let (Some(auxiliary), Reading::Corrected(whole)) = (&self.auxiliary, &self.reading) else {
            return (displacement.to_vec(), force);
        };
        let displacement = auxiliary.displacement().to_vec();
        self.dynamics.forces_without_contact(n, &displacement, &mut force);
        let pull = interval::pull(self.problem, &whole.densities(self.problem, smoothed_reaction));
        let acceleration = self.total_acceleration(&force, &pull);
        if let Some(auxiliary) = &mut self.auxiliary {
            auxiliary.advance(self.problem, &self.dynamics, self.times, n, &acceleration);
        }
        (displacement, force)
    }

    /// Hands the normal motion of the candidate nodes to their tracks.
    fn track_contact(&mut self, step: &Step<'_, D>, mid: Option<&Knot<D>>, now: &Knot<D>) {
        let tolerance = self.problem.contact_tolerance();
        let size = self.problem.mesh().size();
        for (at, contact) in self.problem.surface().nodes().iter().enumerate() {
            let (i, plane) = (contact.node.index(), &self.problem.obstacles()[contact.obstacle]);
            let normal = |knot: &Knot<D>| plane.split(&knot.velocity[i]).0;
            let Some(mid) = mid else {
                let gap = self.problem.surface().gap(at, &now.displacement[i], self.problem.obstacles());
                let start = (gap, normal(now));
                let track = ContactTrack::new(contact.undeformed_gap, size, contact.free, start, step.touching[at]);
                self.tracks.push(track);
                continue;
            };
            let half = 0.5 * self.times.step(step.index - 1);
            let normal_step = NormalStep { half, velocity: [normal(mid), normal(now)], touching: step.touching[at] };
            self.tracks[at].push(&normal_step, tolerance);
        }
    }

    /// The initial conditions hold by construction; checked all the same.
    fn start(&mut self) {
        let knot = &mut self.levels[0].knot;
        knot.increment = vec![[0.0; D]; knot.velocity.len()];
        let fields = [
            (&knot.displacement, self.problem.initial_displacement()),
            (&knot.velocity, self.problem.initial_velocity()),
        ];
        for (made, given) in fields {
            let largest = given.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (a, b) in made.iter().flatten().zip(given.iter().flatten()) {
                let scale = b.abs().max(1e-12 * largest).max(f64::MIN_POSITIVE);
                let residual = (a - b).abs() / scale;
                self.residuals.initial_conditions = worse(self.residuals.initial_conditions, residual);
            }
        }
    }
}

#[cfg(test)]
mod tests;
