//! The matrix of the contact problem of a step.

use super::band::Band;
use super::coupling::Coupling;

/// A = D m⁻¹ Dᵀ + M m'⁻¹ Mᵀ (m²/kg): the relative acceleration of weighted values that multipliers cause. `inverse` has
/// 1/m of the nodes of the slave and of the master (1/kg).
pub(super) fn gram(matrix: &mut Band, coupling: &Coupling, inverse: [&[f64]; 2]) {
    matrix.reset(coupling.len(), width(coupling));
    let width = matrix.width();
    for (row, sums) in matrix.rows_mut().enumerate() {
        let (low, values) = coupling.master_row(row);
        for apart in 0..=width.min(row) {
            let (other_low, other) = coupling.master_row(row - apart);
            let from = low.max(other_low);
            if let (Some(own), Some(other)) = (values.get(from - low..), other.get(from - other_low..)) {
                let common = own.iter().zip(&inverse[1][from..]).zip(other);
                sums[width - apart] = common.map(|((own, inverse), other)| own * inverse * other).sum();
            }
        }
        add_slave(sums, coupling, row, inverse[0]);
    }
}

/// Adds a row of D m⁻¹ Dᵀ.
fn add_slave(sums: &mut [f64], coupling: &Coupling, row: usize, inverse: &[f64]) {
    let (own, last) = (coupling.slave_row(row), sums.len() - 1);
    let mut add = |apart: usize, product: f64, node: usize| {
        if product != 0.0 {
            sums[last - apart] += product * inverse[node];
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

/// How far from the diagonal A has entries.
fn width(coupling: &Coupling) -> usize {
    // Where edges are cut, D joins nodes up to two apart.
    let (mut width, mut first, mut last) = (2, 0, 0);
    for row in 0..coupling.len() {
        let (low, values) = coupling.master_row(row);
        if values.is_empty() {
            continue;
        }
        // Another body may begin before the end of the last one.
        if low < last {
            first = 0;
        }
        last = low;
        while first + width < row && !reaches(coupling, first, low) {
            first += 1;
        }
        width = width.max(row - first);
    }
    width
}

/// Whether a row of M has columns from this one on.
fn reaches(coupling: &Coupling, row: usize, column: usize) -> bool {
    let (first, values) = coupling.master_row(row);
    first + values.len() > column
}
