//! Symmetric matrices with few entries beside the diagonal.

/// The lower half of a symmetric matrix, whose entries farther than `width` from the diagonal are 0. A row has the
/// `width` entries before the diagonal and the diagonal. Those before the first column are 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Band {
    width: usize,
    values: Vec<f64>,
}

impl Band {
    /// A matrix of zeros, in the same memory.
    pub(super) fn reset(&mut self, rows: usize, width: usize) {
        self.width = width;
        self.values.clear();
        self.values.resize(rows * (width + 1), 0.0);
    }

    /// The number of entries before the diagonal.
    #[cfg(test)]
    pub(super) fn width(&self) -> usize {
        self.width
    }

    #[inline]
    fn row(&self, row: usize) -> &[f64] {
        &self.values[row * (self.width + 1)..][..=self.width]
    }

    /// The entries of all rows, the diagonal last.
    pub(super) fn rows_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.values.chunks_exact_mut(self.width + 1)
    }

    #[inline]
    pub(super) fn diagonal(&self, row: usize) -> f64 {
        self.row(row)[self.width]
    }

    /// One component of the product with a vector.
    #[inline]
    pub(super) fn product(&self, row: usize, vector: &[f64]) -> f64 {
        let (width, before) = (self.width, row.min(self.width));
        let own = self.row(row)[width - before..].iter().zip(&vector[row - before..]);
        let mut sum: f64 = own.map(|(a, x)| a * x).sum();
        let below = self.values[(row + 1) * (width + 1)..].chunks_exact(width + 1);
        for ((values, x), at) in below.zip(&vector[row + 1..]).zip((0..width).rev()) {
            sum += values[at] * x;
        }
        sum
    }
}

/// The factors L D Lᵀ of some rows and columns of a positive definite matrix.
#[derive(Clone, Debug, Default)]
pub(super) struct Factors {
    /// L; rows outside the set are 0.
    lower: Band,
    /// 1/D; 0 outside the set.
    inverse: Vec<f64>,
}

impl Factors {
    /// Factorises the rows and columns inside a set. Whether the part is positive definite.
    pub(super) fn factorise(&mut self, matrix: &Band, inside: &[bool]) -> bool {
        let width = matrix.width;
        self.lower.reset(inside.len(), width);
        self.inverse.clear();
        self.inverse.resize(inside.len(), 0.0);
        for row in (0..inside.len()).filter(|&row| inside[row]) {
            let (done, rest) = self.lower.values.split_at_mut(row * (width + 1));
            let (now, given, before) = (&mut rest[..=width], matrix.row(row), row.min(width));
            let rows = done[(row - before) * (width + 1)..].chunks_exact(width + 1);
            for (at, other) in (width - before..width).zip(rows) {
                // Columns that both rows have. Those outside the set are 0 in L.
                let common = now[..at].iter().zip(&other[width - at..width]);
                now[at] = given[at] - common.map(|(y, l)| y * l).sum::<f64>();
            }
            let mut pivot = given[width];
            for (value, inverse) in now[width - before..width].iter_mut().zip(&self.inverse[row - before..row]) {
                let scaled = *value * inverse;
                pivot -= *value * scaled;
                *value = scaled;
            }
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            self.inverse[row] = 1.0 / pivot;
        }
        true
    }

    /// Solves for some right-hand sides, in their place. The solution is 0 outside the set.
    pub(super) fn solve<const W: usize>(&self, vectors: &mut [[f64; W]]) {
        let width = self.lower.width;
        for row in 0..vectors.len() {
            let (before, mut own) = (row.min(width), vectors[row]);
            for (l, x) in self.lower.row(row)[width - before..width].iter().zip(&vectors[row - before..row]) {
                (0..W).for_each(|w| own[w] -= l * x[w]);
            }
            vectors[row] = own;
        }
        for (values, inverse) in vectors.iter_mut().zip(&self.inverse) {
            values.iter_mut().for_each(|value| *value *= inverse);
        }
        for row in (0..vectors.len()).rev() {
            let (before, own) = (row.min(width), vectors[row]);
            for (x, l) in vectors[row - before..row].iter_mut().zip(&self.lower.row(row)[width - before..width]) {
                (0..W).for_each(|w| x[w] -= l * own[w]);
            }
        }
    }
}
