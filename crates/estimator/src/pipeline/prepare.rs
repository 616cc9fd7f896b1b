//! The sequential part: motion, contact force and ã of each step, in order.

use crate::contact_force::{self, Interval, Reading, SurfaceStep};
use crate::error::EstimateError;
use crate::estimate::Given;
use crate::kinematic::{ContactTrack, FreeMotion, Knot, NormalStep};
use crate::level::Level;
use crate::options::Options;
use crate::residual::{Residuals, worse};
use crate::traction::Equilibration;
use percute_core::dynamics::Dynamics;
use percute_core::history::{Step, StepCheck};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::collections::VecDeque;

/// Turns steps into levels whose fields are known on both sides.
#[derive(Debug)]
pub(crate) struct Preparation<'p, const D: usize, const N: usize> {
    problem: &'p Problem<D, N>,
    times: &'p TimeGrid,
    dynamics: Dynamics<'p, D, N>,
    equilibration: Equilibration<'p, D, N>,
    reading: Reading<D>,
    every: usize,
    motion: FreeMotion<D>,
    tracks: Vec<ContactTrack>,
    /// Exact displacement of prescribed components (m), and the longest way of any (m).
    prescribed: (Vec<f64>, f64),
    /// Levels not yet handed on; `ready` of them are complete.
    levels: VecDeque<Level<D>>,
    ready: usize,
    /// The step before the first of `levels` that is not complete.
    before: Option<SurfaceStep<D>>,
    steps: StepCheck,
    /// Normal impulse (Ns) of the admissible and of the simulation's contact force.
    pub(crate) impulse: (f64, f64),
    pub(crate) residuals: Residuals,
}

impl<'p, const D: usize, const N: usize> Preparation<'p, D, N> {
    pub(super) fn new(problem: &'p Problem<D, N>, times: &'p TimeGrid, options: &Options) -> Self {
        Self {
            problem,
            times,
            dynamics: Dynamics::new(problem, times),
            equilibration: Equilibration::new(problem),
            reading: Reading::new(options.contact_force, problem),
            every: options.every,
            motion: FreeMotion::new(problem),
            tracks: Vec::new(),
            prescribed: (Vec::new(), 0.0),
            levels: VecDeque::new(),
            ready: 0,
            before: None,
            steps: StepCheck::default(),
            impulse: (0.0, 0.0),
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
            _ => Ok(()),
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
        self.dynamics.forces_without_contact(n, step.displacement, &mut force);
        // The equilibrium of ã needs what the scheme makes of u_n; the motion takes what is given.
        let acceleration =
            step.acceleration.map_or_else(|| self.total_acceleration(&force, step.reaction), <[_]>::to_vec);
        let (mid, now) = self.motion.advance(self.problem, self.times, &acceleration, step.velocity);

        let instants = self.times.instants();
        let knot = |(displacement, velocity)| Knot { displacement, velocity, increment: Vec::new() };
        let (mid, knot) = (mid.map(knot), knot(now));
        self.track_contact(step, mid.as_ref(), &knot);
        self.check_supports(n, &knot);

        let none = contact_force::none(self.problem);
        self.levels.push_back(Level {
            index: n,
            knot,
            mid,
            displacement: step.displacement.to_vec(),
            force,
            body_force: self.problem.body_force_at(instants[n]),
            load_moments: self.equilibration.load_moments(instants[n]),
            surface: SurfaceStep { reaction: step.reaction.to_vec(), touching: step.touching.to_vec() },
            acceleration: Vec::new(),
            acceleration_before: Vec::new(),
            density_before: none.clone(),
            contact: vec![[0.0; 2]; none.len()],
            density_after: none,
            stress: Vec::new(),
            force_scale: 0.0,
            flux: Vec::new(),
            flux_before: Vec::new(),
        });
        if n == 0 {
            self.start();
        } else if n >= 2 {
            self.complete_interval();
        }
    }

    /// Takes in that no more steps come.
    pub(super) fn finish(&mut self) {
        self.complete_interval();
        self.add_last_impulse();
        if let Some(last) = self.levels.back_mut() {
            // No step follows: both sides are one.
            last.density_after = last.density_before.clone();
        }
        self.ready = self.levels.len();
        let tolerance = self.problem.contact_tolerance();
        self.tracks.iter_mut().for_each(|track| track.finish(tolerance));
    }

    /// The next complete level that is sampled; others only carry the integral of ã on.
    pub(super) fn next_ready(&mut self, last: bool) -> Option<Level<D>> {
        while self.ready > 0 {
            self.ready -= 1;
            let level = self.levels.pop_front()?;
            let end = last && self.levels.is_empty();
            if level.index % self.every == 0 || end {
                return Some(level);
            }
        }
        None
    }

    /// a_n of the simulation.
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

    /// Compares u_CA with the exact displacement of the supports.
    fn check_supports(&mut self, n: usize, knot: &Knot<D>) {
        let problem = self.problem;
        let (exact, longest) = &mut self.prescribed;
        for (k, p) in problem.prescribed().iter().enumerate() {
            let start = problem.initial_displacement()[p.node.index()][p.component];
            if n == 0 {
                exact.push(start);
                continue;
            }
            let velocity = |m: usize| problem.prescribed_velocity(p, self.times.instants()[m]);
            exact[k] += 0.5 * self.times.step(n - 1) * (velocity(n - 1) + velocity(n));
            *longest = longest.max(exact[k].abs());
            let scale = exact[k].abs().max(start.abs()).max(1e-12 * *longest);
            let miss = (knot.displacement[p.node.index()][p.component] - exact[k]).abs();
            let relative = if miss == 0.0 { 0.0 } else { miss / scale };
            self.residuals.supports = worse(self.residuals.supports, relative);
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

    /// Finds F_DA over the earliest step that lacks it; then ã and ∫ã are known up to its end.
    fn complete_interval(&mut self) {
        let first = self.ready;
        let level = |k: usize| self.levels.get(first + k);
        let (Some(now), Some(next)) = (level(0), level(1)) else { return };
        let after = level(2).map(|l| &l.surface);
        let before = self.before.as_ref();
        let interval = self.reading.interval(self.problem, before, &now.surface, &next.surface, after);
        contact_force::check(self.problem, &now.surface, &next.surface, &interval, &mut self.residuals);
        self.add_impulse(first, &interval);
        self.before = Some(self.levels[first].surface.clone());
        self.set_accelerations(first, interval);
        self.integrate_acceleration(first);
        self.add_contact_misfit(first);
        self.ready += 1;
    }

    /// Normal impulses over the step, and the simulation's h_n R_n.
    fn add_impulse(&mut self, first: usize, interval: &Interval<D>) {
        let n = self.levels[first].index;
        let surface = self.problem.surface().nodes();
        let normal = |forces: &[[f64; D]]| {
            let each = surface.iter().zip(forces).map(|(s, f)| self.problem.obstacles()[s.obstacle].split(f).0);
            each.sum::<f64>()
        };
        let [start, end] = [&interval.start, &interval.end].map(|d| contact_force::nodal_forces(self.problem, d));
        self.impulse.0 += 0.5 * self.times.step(n) * (normal(&start) + normal(&end));
        self.impulse.1 += self.times.velocity_step(n) * normal(&self.levels[first].surface.reaction);
    }

    /// The simulation's impulse over the last half step, ½Δt_{N−1} R_N.
    fn add_last_impulse(&mut self) {
        if let Some(last) = self.levels.back() {
            let forces = self.problem.surface().nodes().iter().zip(&last.surface.reaction);
            let normal: f64 = forces.map(|(s, f)| self.problem.obstacles()[s.obstacle].split(f).0).sum();
            self.impulse.1 += 0.5 * self.times.step(last.index - 1) * normal;
        }
    }

    /// ã after t_n at the beginning of the step, before t_{n+1} at its end \[55\].
    fn set_accelerations(&mut self, first: usize, interval: Interval<D>) {
        let surface = self.problem.surface().nodes();
        let inverse_mass = self.dynamics.inverse_mass();
        let corrected = |level: &Level<D>, densities| -> Vec<[f64; D]> {
            let forces = contact_force::nodal_forces(self.problem, densities);
            let each = surface.iter().zip(forces).map(|(contact, force)| {
                let i = contact.node.index();
                let plane = &self.problem.obstacles()[contact.obstacle];
                // A guided node's tangential motion is prescribed, whatever pulls at it.
                let force = if contact.guided { plane.normal().map(|n| n * plane.split(&force).0) } else { force };
                std::array::from_fn(|c| (level.force[i][c] + force[c]) * inverse_mass[i])
            });
            each.collect()
        };
        let after = corrected(&self.levels[first], &interval.start);
        let before = corrected(&self.levels[first + 1], &interval.end);
        if self.levels[first].acceleration.is_empty() {
            // The first level has no earlier side.
            let mut base = self.levels[first].force.clone();
            self.over_mass(&mut base);
            let level = &mut self.levels[first];
            (level.acceleration, level.acceleration_before) = (base, after.clone());
            level.density_before = interval.start.clone();
        }
        let mut base = self.levels[first + 1].force.clone();
        self.over_mass(&mut base);
        self.levels[first].density_after = interval.start;
        self.levels[first].force = Vec::new();
        self.levels[first + 1].density_before = interval.end;
        self.levels[first + 1].acceleration = base;
        for ((contact, after), before) in surface.iter().zip(after).zip(&before) {
            self.levels[first].acceleration[contact.node.index()] = after;
            self.levels[first + 1].acceleration[contact.node.index()] = *before;
        }
        self.levels[first + 1].acceleration_before = before;
    }

    /// ∫ã dt at t_{n+½} and t_{n+1}: ã is linear over the step.
    fn integrate_acceleration(&mut self, first: usize) {
        let dt = self.times.step(self.levels[first].index);
        let (now, next) = (&self.levels[first], &self.levels[first + 1]);
        let weigh = |a: f64, b: f64| -> Vec<[f64; D]> {
            let each = now.knot.increment.iter().zip(now.acceleration.iter().zip(&next.acceleration));
            each.map(|(w, (x, y))| std::array::from_fn(|c| w[c] + dt * (a * x[c] + b * y[c]))).collect()
        };
        let (mid, end) = (weigh(0.375, 0.125), weigh(0.5, 0.5));
        let next = &mut self.levels[first + 1];
        next.knot.increment = end;
        if let Some(knot) = &mut next.mid {
            knot.increment = mid;
        }
    }

    /// Contact part of η over the step: the trapezoidal rule over its three knots.
    fn add_contact_misfit(&mut self, first: usize) {
        let problem = self.problem;
        let dt = self.times.step(self.levels[first].index);
        let (now, next) = (&self.levels[first], &self.levels[first + 1]);
        let mut contact = Vec::with_capacity(problem.surface().facets().len());
        for (f, facet) in problem.surface().facets().iter().enumerate() {
            let (start, end) = (&now.density_after[f], &next.density_before[f]);
            let mut middle = *start;
            (0..D).for_each(|p| (0..D).for_each(|c| middle[p][c] = 0.5 * (start[p][c] + end[p][c])));
            let power = |knot: &Knot<D>, density| {
                let velocity = facet.nodes.map(|k| knot.velocity[problem.surface().nodes()[k].node.index()]);
                contact_force::misfit_power(problem, facet, density, &velocity)
            };
            let (a, b) = (power(&now.knot, start), power(&next.knot, end));
            let m = next.mid.as_ref().map_or(0.0, |mid| power(mid, &middle));
            let so_far = now.contact[f][1];
            // 2∫[…], twice over half a step each.
            contact.push([so_far + 0.5 * dt * (a + m), so_far + 0.5 * dt * (a + 2.0 * m + b)]);
        }
        self.levels[first + 1].contact = contact;
    }
}

#[cfg(test)]
mod tests;
