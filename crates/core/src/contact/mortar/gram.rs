//! The matrix of the contact problem of a step.

use super::coupling::Coupling;
use super::skyline::Skyline;

/// A = D m⁻¹ Dᵀ + M m'⁻¹ Mᵀ (m²/kg): the relative acceleration of weighted values that multipliers cause. `inverse` has
/// 1/m of the nodes of the slave and of the master (1/kg).
pub(super) fn gram(matrix: &mut Skyline, coupling: &Coupling, inverse: [&[f64]; 2], scaled: &mut Vec<f64>) {
    matrix.clear();
    let (mut first, mut last) = (0, 0);
    for row in 0..coupling.len() {
        let own = coupling.slave_row(row);
        let (low, values) = coupling.master_row(row);
        // Another body may begin before the end of the last one.
        if low < last {
            first = 0;
        }
        last = low;
        scaled.clear();
        scaled.extend(values.iter().zip(&inverse[1][low..]).map(|(value, inverse)| value * inverse));
        // Where edges are cut, D joins nodes up to two apart.
        while first + 2 < row && !reaches(coupling, first, low) {
            first += 1;
        }
        let sums = matrix.add_row(first);
        for (column, sum) in (first..).zip(&mut *sums) {
            let (other_low, other) = coupling.master_row(column);
            let (from, to) = (low.max(other_low), (low + values.len()).min(other_low + other.len()));
            if from < to {
                let common = scaled[from - low..to - low].iter().zip(&other[from - other_low..]);
                *sum = common.map(|(scaled, other)| scaled * other).sum();
            }
        }
        let mut add = |apart: usize, product: f64, node: usize| {
            if product != 0.0 {
                sums[row - first - apart] += product * inverse[0][node];
            }
        };
        add(0, own[1] * own[1], row);
        add(0, own[0] * own[0], row.wrapping_sub(1));
        add(0, own[2] * own[2], row + 1);
        if row > 0 {
            let before = coupling.slave_row(row - 1);
            add(1, own[0] * before[1], row - 1);
            add(1, own[1] * before[2], row);
        }
        if row > 1 {
            add(2, own[0] * coupling.slave_row(row - 2)[2], row - 1);
        }
    }
}

/// Whether a row of M has columns from this one on.
fn reaches(coupling: &Coupling, row: usize, column: usize) -> bool {
    let (first, values) = coupling.master_row(row);
    first + values.len() > column
}
