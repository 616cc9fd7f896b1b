//! Factors L D Lᵀ of symmetric matrices with `W` entries before the diagonal, where `W` is known when this is compiled.
//!
//! A row needs the last `W` ones at once. They stay in registers: from memory they would come too late.

/// Forgets the first of the last few items for a new one.
#[inline(always)]
fn shift<T: Copy, const W: usize>(last: &mut [T; W], new: T) {
    *last = std::array::from_fn(|at| if at + 1 < W { last[at + 1] } else { new });
}

/// Computes a row of L and of 1/D after the last ones, from a row of the matrix, diagonal last.
#[inline(always)]
fn eliminate<const W: usize>(given: &[f64], last: &[[f64; W]; W], inverse: &[f64; W]) -> ([f64; W], f64) {
    let mut row = [0.0; W];
    for at in 0..W {
        // Columns that both rows have.
        let common = row[..at].iter().zip(&last[at][W - at..]);
        row[at] = given[at] - common.map(|(y, l)| y * l).sum::<f64>();
    }
    let mut pivot = given[W];
    for (value, inverse) in row.iter_mut().zip(inverse) {
        let scaled = *value * inverse;
        pivot -= *value * scaled;
        *value = scaled;
    }
    (row, pivot)
}

/// Computes L and 1/D for the rows and columns inside a set. Both are 0 before. Whether D is positive.
pub(super) fn factorise<const W: usize>(
    matrix: &[f64],
    inside: &[bool],
    lower: &mut [f64],
    inverse: &mut [f64],
) -> bool {
    let (mut last, mut last_inverse) = ([[0.0; W]; W], [0.0; W]);
    let rows = matrix.chunks_exact(W + 1).zip(lower.chunks_exact_mut(W + 1));
    for ((given, lower), (inside, inverse)) in rows.zip(inside.iter().zip(inverse)) {
        let mut row = [0.0; W];
        if *inside {
            let pivot;
            (row, pivot) = eliminate(given, &last, &last_inverse);
            if pivot > 0.0 {
                *inverse = 1.0 / pivot;
            } else {
                return false;
            }
            lower[..W].copy_from_slice(&row);
        }
        shift(&mut last, row);
        shift(&mut last_inverse, *inverse);
    }
    true
}

/// Solves with L, D and Lᵀ. Behind the rows of L are `W` rows of zeros.
pub(super) fn substitute<const W: usize, const V: usize>(lower: &[f64], inverse: &[f64], vectors: &mut [[f64; V]]) {
    let mut last = [[0.0; V]; W];
    for (own, row) in vectors.iter_mut().zip(lower.chunks_exact(W + 1)) {
        for (x, l) in last.iter().zip(row) {
            (0..V).for_each(|v| own[v] -= l * x[v]);
        }
        shift(&mut last, *own);
    }
    // The last one is the next value.
    let mut last = [[0.0; V]; W];
    for (row, (own, inverse)) in vectors.iter_mut().zip(inverse).enumerate().rev() {
        let below = &lower[(row + 1) * (W + 1)..][..W * (W + 1)];
        let mut value = own.map(|value| value * inverse);
        for (at, x) in last.iter().enumerate() {
            // In each row below, the entry of this column is one place further to the left.
            let l = below[(W - at) * W - 1];
            (0..V).for_each(|v| value[v] -= l * x[v]);
        }
        *own = value;
        shift(&mut last, value);
    }
}
