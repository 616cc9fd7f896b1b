//! The matrix of the contact problem of a step.

use super::coupling::Coupling;
use super::skyline::Skyline;

/// A = D m⁻¹ Dᵀ + M m'⁻¹ Mᵀ (m²/kg): the relative acceleration of weighted values that multipliers cause. `inverse` has
/// 1/m of the nodes of the slave and of the master (1/kg).
pub(super) fn gram(matrix: &mut Skyline, coupling: &Coupling, inverse: [&[f64]; 2], scaled: &mut Vec<f64>) {
    matrix.clear();
    let mut first = 0;
    for row in 0..coupling.len() {
        let own = coupling.slave_row(row);
        let (low, values) = coupling.master_row(row);
        scaled.clear();
        scaled.extend(values.iter().zip(&inverse[1][low..]).map(|(value, inverse)| value * inverse));
        // Neighbours have a common node of the slave at most, others two nodes apart only where edges are cut.
        while first + 2 < row && !reaches(coupling, first, low) {
            first += 1;
        }
        for (column, sum) in (first..).zip(matrix.add_row(first)) {
            let (other_low, other) = coupling.master_row(column);
            let common = low.max(other_low)..(low + values.len()).min(other_low + other.len());
            for node in common {
                *sum += scaled[node - low] * other[node - other_low];
            }
            if row - column <= 2 {
                *sum += slave_part([&coupling.slave_row(column), &own], column, row, inverse[0]);
            }
        }
    }
}

/// Whether a row of M has columns from this one on.
fn reaches(coupling: &Coupling, row: usize, column: usize) -> bool {
    let (first, values) = coupling.master_row(row);
    first + values.len() > column
}

/// Σ_i D_ki D_li / m_i of two rows, at most two apart.
fn slave_part(rows: [&[f64; 3]; 2], column: usize, row: usize, inverse: &[f64]) -> f64 {
    let apart = row - column;
    let mut sum = 0.0;
    for at in apart..3 {
        let product = rows[0][at] * rows[1][at - apart];
        if product != 0.0 {
            sum += product * inverse[column + at - 1];
        }
    }
    sum
}
