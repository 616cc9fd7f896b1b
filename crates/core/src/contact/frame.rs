//! Normal and tangential parts of vectors.

/// The frame of an obstacle at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<const D: usize> {
    normal: [f64; D],
}

impl<const D: usize> Frame<D> {
    /// The frame of a unit normal.
    #[inline]
    pub(crate) fn new(normal: [f64; D]) -> Self {
        Self { normal }
    }

    /// Unit normal n, from the obstacle to the body.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> &[f64; D] {
        &self.normal
    }

    /// Splits a vector into its normal component and its tangential part, eq. \[1\].
    ///
    /// The tangential part comes from the antisymmetric products w_cb = v_c n_b − v_b n_c, not by subtraction of the
    /// normal part: it is orthogonal to the normal to rounding of itself, however large the normal component is.
    #[inline]
    #[must_use]
    pub fn split(&self, v: &[f64; D]) -> (f64, [f64; D]) {
        let (n, mut tangential) = (&self.normal, [0.0; D]);
        for c in 0..D {
            for b in (0..D).filter(|&b| b != c) {
                tangential[c] += (v[c] * n[b] - v[b] * n[c]) * n[b];
            }
        }
        (dot(v, &self.normal), tangential)
    }
}

#[inline]
pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
