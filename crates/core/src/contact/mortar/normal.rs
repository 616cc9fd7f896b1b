//! The normal part of the contact problem of a step: A λ + b ≥ 0, λ ≥ 0, λ·(A λ + b) = 0.

use super::band::{Band, Factors};
use super::partition::larger;
use super::relaxation::relax;

/// Rounds of the active set before relaxation takes over.
pub(super) const ROUNDS: usize = 60;
/// A residual above minus this part of the largest right-hand side is rounding.
pub(super) const RESIDUAL: f64 = 1e-14;

/// The largest of some numbers, and at least 0.
pub(super) fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |most, number| larger(number, most))
}

/// Its solver, with its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct NormalProblem {
    inside: Vec<bool>,
    factors: Factors,
    /// For each multiplier the normal and the tangential part on the set (N/m).
    solution: Vec<[f64; 2]>,
    /// Those in the set, ascending.
    pressed: Vec<usize>,
    /// λ (N/m).
    force: Vec<f64>,
}

impl NormalProblem {
    /// λ of the last problem (N/m).
    #[inline]
    pub(super) fn force(&self) -> &[f64] {
        &self.force
    }

    /// The multipliers that are positive, ascending.
    #[inline]
    pub(super) fn pressed(&self) -> &[usize] {
        &self.pressed
    }

    /// For each multiplier the normal and the tangential part (N/m) if all that are pressed stick and the same matrix
    /// holds for both parts; empty if relaxation found the set.
    pub(super) fn sticking(&self) -> &[[f64; 2]] {
        &self.solution
    }

    /// Solves by the primal–dual active set, for the multipliers that act; others are 0. `right` has b of the normal
    /// part, and that of the tangential one for [`NormalProblem::sticking`]. Returns the number of rounds.
    pub(super) fn solve(&mut self, matrix: &Band, right: &[[f64; 2]], acts: impl Fn(usize) -> bool) -> usize {
        let count = right.len();
        let bound = RESIDUAL * largest(right.iter().map(|[b, _]| b.abs()));
        self.inside.clear();
        self.inside.extend((0..count).map(|k| right[k][0] < 0.0 && acts(k)));
        self.force.clear();
        self.force.resize(count, 0.0);
        for round in 1..=ROUNDS {
            if !self.solve_on_set(matrix, right) {
                break;
            }
            let mut changed = false;
            for k in (0..count).filter(|&k| acts(k)) {
                let stays = if self.inside[k] {
                    self.force[k] > 0.0
                } else {
                    matrix.product(k, &self.force) + right[k][0] < -bound
                };
                changed |= stays != self.inside[k];
                self.inside[k] = stays;
            }
            if !changed {
                self.collect();
                return round;
            }
        }
        let project = |k: usize, force: f64| if acts(k) { force.max(0.0) } else { 0.0 };
        relax(matrix, |k| right[k][0], &mut self.force, 0..count, project);
        (0..count).for_each(|k| self.inside[k] = self.force[k] > 0.0);
        self.collect();
        self.solution.clear();
        ROUNDS
    }

    fn collect(&mut self) {
        self.pressed.clear();
        self.pressed.extend((0..self.inside.len()).filter(|&k| self.inside[k]));
    }

    /// Solves as if the set were right. Whether that is possible.
    fn solve_on_set(&mut self, matrix: &Band, right: &[[f64; 2]]) -> bool {
        if !self.factors.factorise(matrix, &self.inside) {
            return false;
        }
        self.solution.clear();
        self.solution.extend(right.iter().map(|b| b.map(|b| -b)));
        self.factors.solve(&mut self.solution);
        self.force.clear();
        self.force.extend(self.solution.iter().map(|[force, _]| force));
        true
    }
}
