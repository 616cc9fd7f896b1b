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
        let (low, values) = rows.short(row);
        let scaled = scaled(values, &inverse[1][low..]);
        let before = row.min(width);
        for (other, sum) in (row - before..).zip(&mut sums[width - before..]) {
            if let Some(other) = rows.from(other, low) {
                *sum = product(&scaled, other);
            } else if rows.columns(other).start > low {
                // Of another body.
                let (first, other) = rows.short(other);
                let scaled = |at: usize| scaled.get(first - low + at).copied().unwrap_or(0.0);
                *sum = product(&std::array::from_fn(scaled), other);
            }
        }
        add_slave(sums, coupling, row, inverse[0]);
    }
}

#[inline]
fn product(a: &[f64; SHORT], b: &[f64; SHORT]) -> f64 {
    let [first, second, third, fourth] = std::array::from_fn(|at| a[at] * b[at]);
    (first + third) + (second + fourth)
}

/// A row of M m'⁻¹, whose last places may be beyond the last node.
#[inline]
fn scaled(values: &[f64; SHORT], inverse: &[f64]) -> [f64; SHORT] {
    match inverse.first_chunk::<SHORT>() {
        Some(inverse) => std::array::from_fn(|at| values[at] * inverse[at]),
        None => std::array::from_fn(|at| inverse.get(at).map_or(0.0, |inverse| values[at] * inverse)),
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
#[inline]
fn add_slave(sums: &mut [f64], coupling: &Coupling, row: usize, inverse: &[f64]) {
    let (own, before, last) = (coupling.slave_row(row), coupling.slave_row(row.saturating_sub(1)), sums.len() - 1);
    if own[0] == 0.0 && own[2] == 0.0 && before[2] == 0.0 {
        // No cut edge is near.
        sums[last] += own[1] * own[1] * inverse[row];
        return;
    }
    let mut add = |apart: usize, product: f64, node: usize| {
        if product != 0.0 {
            sums[last - apart] += product * inverse[node];
        }
    };
    add(0, own[1] * own[1], row);
    add(0, own[0] * own[0], row.wrapping_sub(1));
    add(0, own[2] * own[2], row + 1);
    if row > 0 {
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
    let (mut width, mut first, mut last, rows) = (2, 0, 0, coupling.master());
    for row in 0..coupling.len() {
        let columns = rows.columns(row);
        if columns.is_empty() {
            continue;
        }
        // Another body may begin before the end of the last one.
        if columns.start < last {
            first = 0;
        }
        last = columns.start;
        while first + width < row && rows.columns(first).end <= columns.start {
            first += 1;
        }
        width = width.max(row - first);
    }
    width
}
