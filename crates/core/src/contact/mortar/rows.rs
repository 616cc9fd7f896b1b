//! Matrices whose rows have consecutive columns.

use std::ops::{Range, RangeInclusive};

/// A row has room for so many values at least: most surfaces need no more.
pub(super) const SHORT: usize = 4;

/// A matrix with few values in a row, side by side: in memory at hand, made anew in three stages. All rows are
/// [widened](Rows::widen), then [opened](Rows::open), then [filled](Rows::pair_mut).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rows {
    rows: Vec<Row>,
    /// Room that is left has zeros.
    values: Vec<f64>,
    /// The most values of a row, at least [`SHORT`].
    longest: usize,
}

/// The columns of a row, and the place of its first value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Row {
    first: usize,
    end: usize,
    start: usize,
}

impl Rows {
    /// So many empty rows.
    pub(super) fn reset(&mut self, count: usize) {
        self.rows.clear();
        self.rows.resize(count, Row::default());
    }

    /// A row gets these columns, too: none of them is before its first one, and the last of them is not before its last
    /// one.
    #[inline]
    pub(super) fn widen(&mut self, row: usize, columns: &Range<usize>) {
        let row = &mut self.rows[row];
        if row.end == 0 {
            row.first = columns.start;
        }
        row.end = columns.end;
    }

    /// All values are 0.
    pub(super) fn open(&mut self) {
        let mut room = 0;
        self.longest = SHORT;
        for row in &mut self.rows {
            row.start = room;
            let length = row.end - row.first;
            self.longest = self.longest.max(length);
            room += length.max(SHORT);
        }
        self.values.clear();
        self.values.resize(room, 0.0);
    }

    /// The first columns of a row and of the one after it, and the values from there on: those of the first up to the
    /// second, and those of the second up to the end of all.
    #[inline]
    pub(super) fn pair_mut(&mut self, row: usize) -> [(usize, &mut [f64]); 2] {
        let [own, after] = [self.rows[row], self.rows[row + 1]];
        let (before, rest) = self.values.split_at_mut(after.start);
        [(own.first, &mut before[own.start..]), (after.first, rest)]
    }

    /// The first column of a row, and its values.
    #[inline]
    pub(super) fn row(&self, row: usize) -> (usize, &[f64]) {
        let Row { first, end, start } = self.rows[row];
        (first, &self.values[start..][..end - first])
    }

    /// The same of some rows with zeros behind, if no row is longer.
    #[inline]
    pub(super) fn short(&self, rows: RangeInclusive<usize>) -> impl Iterator<Item = (usize, &[f64; SHORT])> {
        let (values, _) = self.values.as_chunks();
        self.rows[rows.clone()].iter().map(|row| row.first).zip(&values[rows])
    }

    /// The most values of a row, at least [`SHORT`].
    #[inline]
    pub(super) fn longest(&self) -> usize {
        self.longest
    }
}
