//! The tangential part of the contact problem of a step: A λ + b = 0 within |λ| ≤ μ λ_n.

use super::normal::{NormalProblem, relax};
use super::skyline::Skyline;

/// Solves for the tangential multipliers `force` within these limits (N/m). The normal part does not depend on them.
/// With `normal`, which has the factors of the same matrix, relaxation starts where all that is pressed sticks.
pub(super) fn solve(
    matrix: &Skyline,
    right: &[f64],
    limit: &[f64],
    normal: Option<&NormalProblem>,
    (force, reduced): (&mut Vec<f64>, &mut Vec<f64>),
) {
    force.clear();
    force.resize(right.len(), 0.0);
    if let Some(normal) = normal {
        reduced.clear();
        reduced.extend(normal.pressed().iter().map(|&k| -right[k]));
        normal.factors().solve(reduced);
        normal.pressed().iter().zip(&*reduced).for_each(|(&k, stick)| force[k] = *stick);
        if force.iter().zip(limit).all(|(stick, limit)| stick.abs() <= *limit) {
            return;
        }
    }
    relax(matrix, right, force, |k, force| force.clamp(-limit[k], limit[k]));
}
