//! The normal part of the contact problem of a step: A λ + b ≥ 0, λ ≥ 0, λ·(A λ + b) = 0.

use super::skyline::{Factors, Skyline};

/// Rounds of the active set before relaxation takes over.
const ROUNDS: usize = 60;
/// A residual above minus this part of the largest right-hand side is rounding.
const RESIDUAL: f64 = 1e-14;

/// Its solver, with its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct NormalProblem {
    set: Vec<usize>,
    inside: Vec<bool>,
    factors: Factors,
    reduced: Vec<f64>,
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
        &self.set
    }

    /// The factors of A for these.
    #[inline]
    pub(super) fn factors(&self) -> &Factors {
        &self.factors
    }

    /// Solves by the primal–dual active set, for the multipliers that act. Others are 0.
    pub(super) fn solve(&mut self, matrix: &Skyline, right: &[f64], acts: impl Fn(usize) -> bool) {
        let count = right.len();
        let bound = RESIDUAL * right.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
        self.inside.clear();
        self.inside.extend((0..count).map(|k| right[k] < 0.0 && acts(k)));
        self.force.clear();
        self.force.resize(count, 0.0);
        for _ in 0..ROUNDS {
            if !self.solve_on_set(matrix, right) {
                break;
            }
            let mut changed = false;
            for k in (0..count).filter(|&k| acts(k)) {
                let stays = if self.inside[k] {
                    self.force[k] > 0.0
                } else {
                    matrix.product(k, &self.force) + right[k] < -bound
                };
                changed |= stays != self.inside[k];
                self.inside[k] = stays;
            }
            if !changed {
                return;
            }
        }
        relax(matrix, right, &mut self.force, |k, force| if acts(k) { force.max(0.0) } else { 0.0 });
        (0..count).for_each(|k| self.inside[k] = self.force[k] > 0.0);
        self.collect();
        self.factors.factorise(matrix, &self.set);
    }

    fn collect(&mut self) {
        self.set.clear();
        self.set.extend((0..self.inside.len()).filter(|&k| self.inside[k]));
    }

    /// Solves as if the set were right. Whether that is possible.
    fn solve_on_set(&mut self, matrix: &Skyline, right: &[f64]) -> bool {
        self.collect();
        if !self.factors.factorise(matrix, &self.set) {
            return false;
        }
        self.reduced.clear();
        self.reduced.extend(self.set.iter().map(|&k| -right[k]));
        self.factors.solve(&mut self.reduced);
        self.force.fill(0.0);
        self.set.iter().zip(&self.reduced).for_each(|(&k, force)| self.force[k] = *force);
        true
    }
}

/// Projected Gauss–Seidel for A λ + b = 0 with λ projected by `project`, until no sweep changes more than 1e-13 of the
/// largest.
pub(super) fn relax(matrix: &Skyline, right: &[f64], force: &mut [f64], project: impl Fn(usize, f64) -> f64) {
    const SWEEPS: usize = 10_000;
    const SMALL: f64 = 1e-13;
    for k in 0..force.len() {
        force[k] = project(k, force[k]);
    }
    for _ in 0..SWEEPS {
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for k in 0..force.len() {
            let diagonal = matrix.diagonal(k);
            if diagonal <= 0.0 {
                continue;
            }
            let next = project(k, force[k] - (matrix.product(k, force) + right[k]) / diagonal);
            change = change.max((next - force[k]).abs());
            largest = largest.max(next.abs());
            force[k] = next;
        }
        if change <= SMALL * largest || !change.is_finite() {
            return;
        }
    }
}
