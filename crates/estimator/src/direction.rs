//! Components of vectors.

use percute_core::contact::Frame;

/// Along a plane in 2D: its normal turned back by a quarter.
pub(crate) fn tangent<const D: usize>(frame: &Frame<D>) -> [f64; D] {
    let mut tangent = [0.0; D];
    (tangent[0], tangent[1]) = (frame.normal()[1], -frame.normal()[0]);
    tangent
}

/// The component of a vector along a direction, or a value from those at the nodes with their weights.
#[inline]
pub(crate) fn along<const D: usize>(vector: &[f64; D], direction: &[f64; D]) -> f64 {
    vector.iter().zip(direction).map(|(a, b)| a * b).sum()
}
