//! Stresses of a macro-element from the conditions on their coefficients.

use nalgebra::{DMatrix, DVector, SVD};

/// The least coefficients that satisfy the square system of conditions for each column on the right, then those of
/// `FREE` stresses that satisfy it for 0.
pub(super) fn solutions<const COEFFICIENTS: usize, const FREE: usize>(
    conditions: &DMatrix<f64>,
    right: &DMatrix<f64>,
) -> Vec<[f64; COEFFICIENTS]> {
    let svd = SVD::new(conditions.clone(), true, true);
    let mut order: Vec<usize> = (0..COEFFICIENTS).collect();
    order.sort_by(|&i, &j| svd.singular_values[j].total_cmp(&svd.singular_values[i]));
    let (left, modes) = (svd.u.unwrap_or_default(), svd.v_t.unwrap_or_default());
    let (kept, free) = order.split_at(COEFFICIENTS - FREE);
    // The decomposition is good to some 1e-13; corrections by what is left of the equations
    // make the stresses exact to rounding.
    let refined = |mut stress: DVector<f64>, right: &DVector<f64>| {
        for _ in 0..4 {
            let left_over = right - conditions * &stress;
            for &mode in kept {
                let weight = left.column(mode).dot(&left_over) / svd.singular_values[mode];
                stress += modes.row(mode).transpose() * weight;
            }
        }
        std::array::from_fn(|i| stress[i])
    };
    let zero = DVector::zeros(COEFFICIENTS);
    let loads = right.column_iter().map(|load| refined(zero.clone(), &load.into_owned()));
    let frees = free.iter().map(|&mode| refined(modes.row(mode).transpose(), &zero));
    loads.chain(frees).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// How many independent solutions the conditions have for 0.
    pub(in crate::stress) fn free_solutions(conditions: DMatrix<f64>) -> usize {
        let svd = SVD::new(conditions, false, false);
        svd.singular_values.iter().filter(|s| **s < 1e-12 * svd.singular_values.max()).count()
    }
}
