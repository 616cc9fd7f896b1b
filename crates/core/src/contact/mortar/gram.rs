//! The matrix of the contact problem of a step.

use super::band::Band;
use super::coupling::{Coupling, SHORT};

/// A = D m⁻¹ Dᵀ + M m'⁻¹ Mᵀ (m²/kg): the relative acceleration of weighted values that multipliers cause. `inverse` has
/// 1/m of the nodes of the slave and of the master (1/kg).
pub(super) fn gram(matrix: &mut Band, coupling: &Coupling, inverse: [&[f64]; 2], window: &mut Vec<f64>) {
    matrix.reset(coupling.len(), width(coupling));
    let longest = (0..coupling.len()).map(|row| coupling.room_of_row(row).1.len()).fold(SHORT, usize::max);
    // Short rows are compiled on their own.
    if longest == SHORT {
        fill(SHORT, matrix, coupling, inverse, window);
    } else {
        fill(longest, matrix, coupling, inverse, window);
    }
}

/// Adds up all rows. None of M is longer than `longest`.
#[inline(always)]
fn fill(longest: usize, matrix: &mut Band, coupling: &Coupling, inverse: [&[f64]; 2], window: &mut Vec<f64>) {
    // A row of M m'⁻¹ between zeros, from so many nodes before its first one on.
    window.clear();
    window.resize(3 * longest, 0.0);
    let room = |row: usize| {
        let (low, values) = coupling.room_of_row(row);
        (low, if longest == SHORT { &values[..SHORT] } else { values })
    };
    let width = matrix.width();
    for (row, sums) in matrix.rows_mut().enumerate() {
        let (low, values) = room(row);
        window[longest..].fill(0.0);
        for (node, (scaled, value)) in (low..).zip(window[longest..].iter_mut().zip(values)) {
            *scaled = value * inverse[1].get(node).unwrap_or(&0.0);
        }
        for apart in 0..=width.min(row) {
            let (other_low, other) = room(row - apart);
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
