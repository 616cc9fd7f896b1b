//! Matrices whose rows have consecutive columns.

use std::ops::Range;

/// A row has room for so many values at least: most surfaces need no more.
pub(super) const SHORT: usize = 4;

/// A matrix with few values in a row, side by side: in memory at hand. Rows get columns in ascending order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rows {
    rows: Vec<Row>,
    /// Zeros of rows without columns, then the values of the others, each with [`SHORT`] zeros behind at least.
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
        self.values.clear();
        self.values.extend_from_slice(&[0.0; 2 * SHORT]);
        self.longest = SHORT;
    }

    /// A row and the one after it get these columns, too, with zeros: none of them is before their first one, and the
    /// last of them is not before their last one. Later rows have none yet. Gives the values of all rows, and where
    /// column 0 of both rows would be among them, modulo 2⁶⁴.
    #[inline]
    pub(super) fn widen(&mut self, row: usize, columns: Range<usize>) -> (&mut [f64], [usize; 2]) {
        let places = [row, row + 1].map(|row| {
            let row = &mut self.rows[row];
            if row.end == 0 {
                (row.first, row.start) = (columns.start, self.values.len());
                self.values.extend_from_slice(&[0.0; 2 * SHORT]);
            }
            row.end = columns.end;
            let length = row.end - row.first;
            if length > SHORT {
                self.values.resize(row.start + length + SHORT, 0.0);
                self.longest = self.longest.max(length);
            }
            row.start.wrapping_sub(row.first)
        });
        (&mut self.values, places)
    }

    /// The first column of a row, and its values.
    #[inline]
    pub(super) fn row(&self, row: usize) -> (usize, &[f64]) {
        let Row { first, end, start } = self.rows[row];
        (first, &self.values[start..][..end - first])
    }

    /// The first column of a row, and its values with zeros behind, if no row is longer.
    #[inline]
    pub(super) fn short(&self, row: usize) -> (usize, &[f64; SHORT]) {
        let Row { first, start, .. } = self.rows[row];
        (first, &self.values.as_chunks().0[start / SHORT])
    }

    /// So many values of a row from a column on, with zeros beyond: none if the row begins after it, or so far before.
    #[inline]
    pub(super) fn from(&self, row: usize, column: usize) -> Option<&[f64; SHORT]> {
        let Row { first, start, .. } = self.rows[row];
        let skipped = column.wrapping_sub(first);
        if skipped < SHORT { self.values[start + skipped..].first_chunk() } else { None }
    }

    /// The columns of a row.
    #[inline]
    pub(super) fn columns(&self, row: usize) -> Range<usize> {
        self.rows[row].first..self.rows[row].end
    }

    /// The most values of a row, at least [`SHORT`].
    #[inline]
    pub(super) fn longest(&self) -> usize {
        self.longest
    }
}
