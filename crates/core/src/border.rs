//! Vectors and fields without a dimension in their type, as problems of any dimension hand them to other crates.
//!
//! A single vector has three components, those beyond the dimension are 0. A field is numbers in rows, one row for each
//! node, with one number for each dimension.

/// A vector; components beyond the dimension are 0.
pub type Vector = [f64; 3];

/// A vector of a dimension with three components.
#[inline]
#[must_use]
pub fn padded<const D: usize>(vector: &[f64; D]) -> Vector {
    std::array::from_fn(|c| if c < D { vector[c] } else { 0.0 })
}

/// The first components of a vector.
#[inline]
#[must_use]
pub fn cut<const D: usize>(vector: &Vector) -> [f64; D] {
    std::array::from_fn(|c| vector[c])
}

/// The rows of a field as vectors of a dimension.
#[inline]
#[must_use]
pub fn vectors<const D: usize>(rows: &[f64]) -> &[[f64; D]] {
    rows.as_chunks().0
}

/// The row of a node in a field, as a vector.
#[inline]
#[must_use]
pub fn row(field: &[f64], node: usize, dimension: usize) -> Vector {
    let mut vector = [0.0; 3];
    vector[..dimension].copy_from_slice(&field[dimension * node..dimension * (node + 1)]);
    vector
}
