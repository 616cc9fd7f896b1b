//! The matrix of the contact problem of a step.

use super::band::Band;
use super::coupling::Coupling;
use super::rows::SHORT;

/// A = D m⁻¹ Dᵀ + M m'⁻¹ Mᵀ (m²/kg): the relative acceleration of weighted values that multipliers cause. `inverse` has
/// 1/m of the nodes of the slave and of the master (1/kg).
pub(super) fn gram(matrix: &mut Band, coupling: &Coupling, inverse: [&[f64]; 2], window: &mut Vec<f64>) {
    matrix.reset(coupling.len(), width(coupling));
    if coupling.master().longest() == SHORT {
        fill_short(matrix, coupling, inverse);
    } else {
        fill(matrix, coupling, inverse, window);
    }
}

/// Adds up all rows, of which none of M is longer than [`SHORT`].
fn fill_short(matrix: &mut Band, coupling: &Coupling, inverse: [&[f64]; 2]) {
    let (rows, width) = (coupling.master(), matrix.width());
    for (row, sums) in matrix.rows_mut().enumerate() {
        let begin = row.saturating_sub(width);
        // A row of M m'⁻¹ between zeros.
        let (mut window, (low, values)) = ([0.0; 3 * SHORT], rows.row(row));
        let scaled = window[SHORT..].iter_mut().zip(values).zip(&inverse[1][low..]);
        scaled.for_each(|((scaled, value), inverse)| *scaled = value * inverse);
        for (sum, (other_low, other)) in sums[begin + width - row..].iter_mut().zip(rows.short(begin..=row)) {
            let common = window.get((SHORT + other_low).wrapping_sub(low)..).and_then(|window| window.first_chunk());
            if let Some::<&[f64; SHORT]>(common) = common {
                let [a, b, c, d] = std::array::from_fn(|at| common[at] * other[at]);
                *sum = (a + c) + (b + d);
            }
        }
        add_slave(sums, coupling, row, inverse[0]);
    }
}

/// Adds up rows of any length.
fn fill(matrix: &mut Band, coupling: &Coupling, inverse: [&[f64]; 2], window: &mut Vec<f64>) {
    let (rows, width, longest) = (coupling.master(), matrix.width(), coupling.master().longest());
    // A row of M m'⁻¹ between zeros, from so many nodes before its first one on.
    window.clear();
    window.resize(3 * longest, 0.0);
    for (row, sums) in matrix.rows_mut().enumerate() {
        let (low, values) = rows.row(row);
        window[longest..].fill(0.0);
        let scaled = window[longest..].iter_mut().zip(values).zip(&inverse[1][low..]);
        scaled.for_each(|((scaled, value), inverse)| *scaled = value * inverse);
        for apart in 0..=width.min(row) {
            let (other_low, other) = rows.row(row - apart);
            let common = (longest + other_low).checked_sub(low).and_then(|begin| window.get(begin..begin + longest));
            let Some(common) = common else { continue };
            sums[width - apart] = common.iter().zip(other).map(|(scaled, other)| scaled * other).sum();
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
