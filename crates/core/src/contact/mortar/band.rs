//! Symmetric matrices with few entries beside the diagonal.

use super::narrow;

/// The least width. Loops of this width are compiled on their own, and most surfaces need no more.
const LEAST: usize = 4;

/// The lower half of a symmetric matrix, whose entries farther than `width` from the diagonal are 0. A row has the
/// `width` entries before the diagonal and the diagonal. Those before the first column are 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Band {
    width: usize,
    values: Vec<f64>,
}

impl Band {
    /// A matrix of zeros at least this wide, in the same memory.
    pub(super) fn reset(&mut self, rows: usize, width: usize) {
        self.width = width.max(LEAST);
        self.values.clear();
        self.values.resize(rows * (self.width + 1), 0.0);
    }

    /// The number of entries before the diagonal.
    #[inline]
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// The entries of all rows, the diagonal last.
    pub(super) fn rows_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.values.chunks_exact_mut(self.width + 1)
    }

    /// Adds a multiple of the square of the difference between an entry of a vector and the next one.
    pub(super) fn add_difference(&mut self, row: usize, factor: f64) {
        let size = self.width + 1;
        let (own, next) = (row * size + self.width, (row + 1) * size + self.width);
        self.values[own] += factor;
        self.values[next] += factor;
        self.values[next - 1] -= factor;
    }

    #[inline]
    pub(super) fn diagonal(&self, row: usize) -> f64 {
        self.values[row * (self.width + 1) + self.width]
    }

    /// One component of the product with a vector.
    #[inline]
    pub(super) fn product(&self, row: usize, vector: &[f64]) -> f64 {
        match self.width {
            LEAST => product(LEAST, &self.values, row, vector),
            width => product(width, &self.values, row, vector),
        }
    }
}

#[inline(always)]
fn product(width: usize, values: &[f64], row: usize, vector: &[f64]) -> f64 {
    let (values, size) = (&values[row * (width + 1)..], width + 1);
    // The entries below the diagonal are in the next rows, one place further to the left in each.
    if row >= width && row + width < vector.len() {
        let (values, vector) = (&values[..size * size], &vector[row - width..=row + width]);
        let own: f64 = (0..size).map(|at| values[at] * vector[at]).sum();
        return own + (1..size).map(|at| values[at * width + width] * vector[width + at]).sum::<f64>();
    }
    let before = row.min(width);
    let own: f64 = values[width - before..size].iter().zip(&vector[row - before..]).map(|(a, x)| a * x).sum();
    let below = values[size..].chunks_exact(size).zip(&vector[row + 1..]).zip((0..width).rev());
    own + below.map(|((values, x), at)| values[at] * x).sum::<f64>()
}

/// The factors L D Lᵀ of some rows and columns of a positive definite matrix.
#[derive(Clone, Debug, Default)]
pub(super) struct Factors {
    /// L without its diagonal; rows and columns outside the set are 0.
    lower: Band,
    /// 1/D; 0 outside the set.
    inverse: Vec<f64>,
}

impl Factors {
    /// Factorises the rows and columns inside a set. Whether the part is positive definite.
    pub(super) fn factorise(&mut self, matrix: &Band, inside: &[bool]) -> bool {
        let Self { lower, inverse } = self;
        // With the rows of zeros that `narrow` needs behind.
        lower.reset(inside.len() + matrix.width, matrix.width);
        inverse.clear();
        inverse.resize(inside.len(), 0.0);
        if matrix.width == LEAST {
            return narrow::factorise::<LEAST>(&matrix.values, inside, &mut lower.values, inverse);
        }
        (0..inside.len())
            .filter(|&row| inside[row])
            .all(|row| eliminate(matrix.width, &matrix.values, &mut lower.values, inverse, row))
    }

    /// Solves for some right-hand sides, in their place. The solution is 0 outside the set.
    pub(super) fn solve<const V: usize>(&self, vectors: &mut [[f64; V]]) {
        if self.lower.width == LEAST {
            narrow::substitute::<LEAST, V>(&self.lower.values, &self.inverse, vectors);
        } else {
            substitute(self.lower.width, &self.lower.values, &self.inverse, vectors);
        }
    }
}

/// Computes a row of L and of 1/D. Whether D is positive.
#[inline(always)]
fn eliminate(width: usize, matrix: &[f64], lower: &mut [f64], inverse: &mut [f64], row: usize) -> bool {
    let (begin, before) = (row * (width + 1), row.min(width));
    let (done, rest) = lower.split_at_mut(begin);
    let (now, given) = (&mut rest[..=width], &matrix[begin..][..=width]);
    let rows = done[(row - before) * (width + 1)..].chunks_exact(width + 1);
    for (at, other) in (width - before..width).zip(rows) {
        // Columns that both rows have.
        let common = now[..at].iter().zip(&other[width - at..width]);
        now[at] = given[at] - common.map(|(y, l)| y * l).sum::<f64>();
    }
    let mut pivot = given[width];
    for (value, inverse) in now[width - before..width].iter_mut().zip(&inverse[row - before..row]) {
        let scaled = *value * inverse;
        pivot -= *value * scaled;
        *value = scaled;
    }
    inverse[row] = 1.0 / pivot;
    pivot > 0.0
}

/// Solves with L, D and Lᵀ.
#[inline(always)]
fn substitute<const W: usize>(width: usize, lower: &[f64], inverse: &[f64], vectors: &mut [[f64; W]]) {
    for (row, values) in lower.chunks_exact(width + 1).take(vectors.len()).enumerate() {
        let (before, mut own) = (row.min(width), vectors[row]);
        for (l, x) in values[width - before..width].iter().zip(&vectors[row - before..row]) {
            (0..W).for_each(|w| own[w] -= l * x[w]);
        }
        vectors[row] = own;
    }
    for (values, inverse) in vectors.iter_mut().zip(inverse) {
        values.iter_mut().for_each(|value| *value *= inverse);
    }
    for (row, values) in lower.chunks_exact(width + 1).take(vectors.len()).enumerate().rev() {
        let (before, own) = (row.min(width), vectors[row]);
        for (x, l) in vectors[row - before..row].iter_mut().zip(&values[width - before..width]) {
            (0..W).for_each(|w| x[w] -= l * own[w]);
        }
    }
}
