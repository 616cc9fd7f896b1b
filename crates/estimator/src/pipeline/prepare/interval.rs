//! What becomes known over a step: F_DA, then ã, ∫ã dt and the contact part of η.

use super::Preparation;
use crate::kinematic::Knot;
use crate::reconstruction::{self, Densities, Interval, Reading};
use crate::time_level::TimeLevel;
use percute_core::problem::Problem;

impl<const D: usize, const N: usize> Preparation<'_, D, N> {
    /// Finds F_DA over the earliest step that lacks it; then ã and ∫ã are known up to its end.
    pub(super) fn complete_interval(&mut self) {
        let first = self.ready;
        let level = |k: usize| self.levels.get(first + k);
        let (Some(now), Some(next)) = (level(0), level(1)) else { return };
        let after = level(2).map(|l| &l.surface);
        let before = self.before.as_ref();
        let interval = self.reading.interval(self.problem, before, &now.surface, &next.surface, after);
        let off_contact = self.reading.acts_off_contact();
        let residuals = &mut self.residuals;
        reconstruction::check(self.problem, &now.surface, &next.surface, &interval, off_contact, residuals);
        self.impulse.add(self.problem, self.times, now.index, &interval, &now.surface.reaction);
        self.before = Some(self.levels[first].surface.clone());
        if let Reading::Corrected(whole) = &self.reading {
            let pressures = whole.pressures(self.problem, &now.surface, &next.surface, &interval);
            self.levels[first + 1].pressures.push(pressures);
        }
        self.set_accelerations(first, interval);
        self.integrate_acceleration(first);
        self.add_contact_misfit(first);
        self.ready += 1;
    }

    /// ã after t_n at the beginning of the step, before t_{n+1} at its end \[55\].
    fn set_accelerations(&mut self, first: usize, interval: Interval<D>) {
        let surface = self.problem.surface().nodes();
        let inverse_mass = self.dynamics.inverse_mass();
        let corrected = |level: &TimeLevel<D>, densities| -> Vec<[f64; D]> {
            let each = surface.iter().zip(pull(self.problem, densities)).map(|(contact, force)| {
                let i = contact.node.index();
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
                reconstruction::misfit_power(problem, facet, density, &velocity)
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

/// What moves each node of the contact surface under a density: its nodal force (N), but for the tangential
/// part at a guided node, whose tangential motion is prescribed, whatever pulls at it.
pub(super) fn pull<const D: usize, const N: usize>(problem: &Problem<D, N>, densities: &Densities<D>) -> Vec<[f64; D]> {
    let mut forces = reconstruction::nodal_forces(problem, densities);
    for (contact, force) in problem.surface().nodes().iter().zip(&mut forces).filter(|(contact, _)| contact.guided) {
        let plane = &problem.obstacles()[contact.obstacle];
        *force = plane.normal().map(|n| n * plane.split(force).0);
    }
    forces
}
