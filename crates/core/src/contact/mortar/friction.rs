//! The tangential part of the contact problem of a step: A λ + b = 0 within |λ| ≤ μ λ_n.

use super::band::{Band, Factors};
use super::normal::{RESIDUAL, ROUNDS, largest};
use super::relaxation::relax;

/// Its solver, with its memory. The normal part does not depend on it.
#[derive(Clone, Debug, Default)]
pub(super) struct FrictionProblem {
    /// For each pressed multiplier the sign of its force while it slips, 0 while it sticks.
    slips: Vec<f64>,
    /// Those that stick, among all.
    sticks: Vec<bool>,
    factors: Factors,
    solution: Vec<[f64; 1]>,
    /// λ (N/m).
    force: Vec<f64>,
}

impl FrictionProblem {
    /// λ of the last problem (N/m).
    #[inline]
    pub(super) fn force(&self) -> &[f64] {
        &self.force
    }

    /// No friction, for so many multipliers.
    pub(super) fn clear(&mut self, count: usize) {
        self.force.clear();
        self.force.resize(count, 0.0);
    }

    /// Solves by the primal–dual active set of those that stick, for the pressed multipliers, within these limits (N/m)
    /// of all. `sticking` has the forces of all (N/m) if all pressed ones stick, or is empty. Returns
    /// the number of rounds, 0 if these are within the limits.
    pub(super) fn solve(
        &mut self,
        matrix: &Band,
        right: impl Fn(usize) -> f64,
        limit: &[f64],
        (pressed, sticking): (&[usize], &[[f64; 2]]),
    ) -> usize {
        self.clear(limit.len());
        self.slips.clear();
        self.slips.resize(pressed.len(), 0.0);
        if !sticking.is_empty() && !slip(&mut self.slips, |k| sticking[k][1], limit, pressed) {
            pressed.iter().for_each(|&k| self.force[k] = sticking[k][1]);
            return 0;
        }
        let bound = RESIDUAL * largest(pressed.iter().map(|&k| right(k).abs()));
        for round in 1..=ROUNDS {
            if !self.solve_on_set(matrix, &right, limit, pressed) {
                break;
            }
            if !self.change_sets(matrix, &right, (limit, bound), pressed) {
                return round;
            }
        }
        let project = |k: usize, force: f64| force.clamp(-limit[k], limit[k]);
        relax(matrix, right, &mut self.force, pressed.iter().copied(), project);
        ROUNDS
    }

    /// Solves as if the sets were right. Whether that is possible.
    fn solve_on_set(&mut self, matrix: &Band, right: impl Fn(usize) -> f64, limit: &[f64], pressed: &[usize]) -> bool {
        let Self { slips, sticks, factors, solution, force } = self;
        sticks.clear();
        sticks.resize(limit.len(), false);
        for (&k, slips) in pressed.iter().zip(slips) {
            force[k] = *slips * limit[k];
            sticks[k] = *slips == 0.0;
        }
        if !sticks.contains(&true) {
            return true;
        }
        if !factors.factorise(matrix, sticks) {
            return false;
        }
        solution.clear();
        solution.resize(limit.len(), [0.0]);
        let sticking = || pressed.iter().filter(|k| sticks[**k]);
        sticking().for_each(|&k| solution[k] = [-matrix.product(k, force) - right(k)]);
        factors.solve(solution);
        sticking().for_each(|&k| force[k] = solution[k][0]);
        true
    }

    /// What sticks beyond its limit slips, and what slips along its force sticks. Whether anything changes.
    fn change_sets(
        &mut self,
        matrix: &Band,
        right: impl Fn(usize) -> f64,
        (limit, bound): (&[f64], f64),
        pressed: &[usize],
    ) -> bool {
        let mut changed = false;
        for (&k, slips) in pressed.iter().zip(&mut self.slips).filter(|(k, slips)| **slips != 0.0 && limit[**k] > 0.0) {
            if *slips * (matrix.product(k, &self.force) + right(k)) > bound {
                *slips = 0.0;
                changed = true;
            }
        }
        // Those that have just come to stick have forces at their limits, not beyond.
        let Self { slips, force, .. } = self;
        slip(slips, |k| force[k], limit, pressed) || changed
    }
}

/// What sticks with a force beyond its limit slips. Whether anything does.
#[inline]
fn slip(slips: &mut [f64], force: impl Fn(usize) -> f64, limit: &[f64], pressed: &[usize]) -> bool {
    let mut changed = false;
    for (&k, slips) in pressed.iter().zip(slips).filter(|(_, slips)| **slips == 0.0) {
        let force = force(k);
        if force.abs() > limit[k] {
            *slips = force.signum();
            changed = true;
        }
    }
    changed
}
