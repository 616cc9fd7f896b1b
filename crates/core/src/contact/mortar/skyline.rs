//! Symmetric matrices with few entries beside the diagonal.

/// The lower half of a symmetric matrix, row by row: from the first column that is not 0 to the diagonal. First columns
/// never fall from row to row.
#[derive(Clone, Debug, Default)]
pub(super) struct Skyline {
    first: Vec<usize>,
    start: Vec<usize>,
    values: Vec<f64>,
}

impl Skyline {
    /// Removes all rows.
    pub(super) fn clear(&mut self) {
        self.first.clear();
        self.start.clear();
        self.values.clear();
    }

    /// Adds a row from its first column on; its values are 0.
    pub(super) fn add_row(&mut self, first: usize) -> &mut [f64] {
        let (row, start) = (self.first.len(), self.values.len());
        self.first.push(first);
        self.start.push(start);
        self.values.resize(start + row + 1 - first, 0.0);
        &mut self.values[start..]
    }

    #[inline]
    pub(super) fn first(&self, row: usize) -> usize {
        self.first[row]
    }

    /// From the first column to the diagonal.
    #[inline]
    fn row(&self, row: usize) -> &[f64] {
        let start = self.start[row];
        &self.values[start..start + row + 1 - self.first[row]]
    }

    #[inline]
    pub(super) fn diagonal(&self, row: usize) -> f64 {
        self.values[self.start[row] + row - self.first[row]]
    }

    /// One component of the product with a vector.
    #[inline]
    pub(super) fn product(&self, row: usize, vector: &[f64]) -> f64 {
        let first = self.first[row];
        let mut sum: f64 = self.row(row).iter().zip(&vector[first..]).map(|(a, x)| a * x).sum();
        let below = (row + 1..self.first.len()).take_while(|&other| self.first[other] <= row);
        for other in below {
            sum += self.values[self.start[other] + row - self.first[other]] * vector[other];
        }
        sum
    }
}

/// The factors L D Lᵀ of some rows and columns of a positive definite matrix.
#[derive(Clone, Debug, Default)]
pub(super) struct Factors {
    lower: Skyline,
    /// 1/D.
    inverse: Vec<f64>,
}

impl Factors {
    /// Factorises the rows and columns of a set, in ascending order. Whether the part is positive definite.
    pub(super) fn factorise(&mut self, matrix: &Skyline, set: &[usize]) -> bool {
        self.lower.clear();
        self.inverse.clear();
        let mut left = 0;
        for (row, &of) in set.iter().enumerate() {
            while set[left] < matrix.first(of) {
                left += 1;
            }
            let begin = self.lower.values.len();
            self.lower.add_row(left);
            let (done, now) = self.lower.values.split_at_mut(begin);
            let given = matrix.row(of);
            for column in left..row {
                let (first, start) = (self.lower.first[column], self.lower.start[column]);
                let from = first.max(left);
                let other = &done[start + from - first..start + column - first];
                let sum: f64 = now[from - left..column - left].iter().zip(other).map(|(y, l)| y * l).sum();
                now[column - left] = given[set[column] - matrix.first(of)] - sum;
            }
            let mut pivot = matrix.diagonal(of);
            for (value, inverse) in now.iter_mut().zip(&self.inverse[left..row]) {
                let scaled = *value * inverse;
                pivot -= *value * scaled;
                *value = scaled;
            }
            now[row - left] = 1.0;
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            self.inverse.push(1.0 / pivot);
        }
        true
    }

    /// Solves for some right-hand sides, in their place.
    pub(super) fn solve<const W: usize>(&self, vectors: &mut [[f64; W]]) {
        let count = self.inverse.len();
        for row in 0..count {
            let (first, mut own) = (self.lower.first[row], vectors[row]);
            for (l, x) in self.lower.row(row)[..row - first].iter().zip(&vectors[first..row]) {
                (0..W).for_each(|w| own[w] -= l * x[w]);
            }
            vectors[row] = own;
        }
        for (values, inverse) in vectors.iter_mut().zip(&self.inverse) {
            values.iter_mut().for_each(|value| *value *= inverse);
        }
        for row in (0..count).rev() {
            let (first, own) = (self.lower.first[row], vectors[row]);
            for (x, l) in vectors[first..row].iter_mut().zip(self.lower.row(row)) {
                (0..W).for_each(|w| x[w] -= l * own[w]);
            }
        }
    }
}
