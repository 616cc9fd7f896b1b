//! Projected Gauss–Seidel, where an active set does not settle.

use super::band::Band;

/// Solves A λ + b = 0 with λ projected by `project`, for some rows in ascending order, until no sweep changes more than
/// 1e-13 of the largest. Other rows keep their values.
pub(super) fn relax(
    matrix: &Band,
    right: impl Fn(usize) -> f64,
    force: &mut [f64],
    rows: impl Iterator<Item = usize> + Clone,
    project: impl Fn(usize, f64) -> f64,
) {
    const SWEEPS: usize = 10_000;
    const SMALL: f64 = 1e-13;
    for k in rows.clone() {
        force[k] = project(k, force[k]);
    }
    for _ in 0..SWEEPS {
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for k in rows.clone() {
            let diagonal = matrix.diagonal(k);
            if diagonal <= 0.0 {
                continue;
            }
            let next = project(k, force[k] - (matrix.product(k, force) + right(k)) / diagonal);
            change = change.max((next - force[k]).abs());
            largest = largest.max(next.abs());
            force[k] = next;
        }
        if change <= SMALL * largest || !change.is_finite() {
            return;
        }
    }
}
