//! A rigid plane, eq. \[2\] and \[3\].

use super::frame::{Frame, dot};

/// A plane through a point, with the normal as it was stated.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane<const D: usize> {
    point: [f64; D],
    direction: [f64; D],
    normal: [f64; D],
}

impl<const D: usize> Plane<D> {
    /// None if the normal is zero or not finite.
    pub(super) fn new(point: [f64; D], direction: [f64; D]) -> Option<Self> {
        let length = dot(&direction, &direction).sqrt();
        let usable = length.is_finite() && length > 0.0;
        usable.then(|| Self { point, direction, normal: direction.map(|n| n / length) })
    }

    /// The stated point (m).
    #[must_use]
    pub fn point(&self) -> &[f64; D] {
        &self.point
    }

    /// The stated normal, of any length: it gives the same plane again, bit by bit.
    #[must_use]
    pub fn direction(&self) -> &[f64; D] {
        &self.direction
    }

    /// Signed distance of a point (m), positive outside, eq. \[3\].
    #[inline]
    #[must_use]
    pub fn gap(&self, x: &[f64; D]) -> f64 {
        (0..D).map(|c| (x[c] - self.point[c]) * self.normal[c]).sum()
    }

    #[inline]
    pub(super) fn frame(&self) -> Frame<D> {
        Frame::new(self.normal)
    }

    /// The plane, moved against its normal by a distance (m).
    pub(super) fn moved_back(&self, distance: f64) -> Self {
        Self { point: self.point_behind(distance), ..self.clone() }
    }

    /// The stated point (m), moved against the normal by a depth.
    pub(crate) fn point_behind(&self, depth: f64) -> [f64; D] {
        std::array::from_fn(|c| self.point[c] - depth * self.normal[c])
    }
}
