//! σ_DA of an element by its mean and the rest.

use crate::stress::Fluctuation;
use percute_core::simd::lanes::Value;

/// σ_DA of an element at one sample, as its mean (Pa) and the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AdmissibleStress<const D: usize, const N: usize, T = f64> {
    pub(crate) mean: [[T; D]; D],
    pub(crate) fluctuation: Fluctuation<D, N, T>,
}

impl<const D: usize, const N: usize> Default for AdmissibleStress<D, N> {
    fn default() -> Self {
        Self { mean: [[0.0; D]; D], fluctuation: Fluctuation::filled(0.0) }
    }
}

impl<const D: usize, const N: usize, T: Value> AdmissibleStress<D, N, T> {
    /// Half way between two instants, \[57\]–\[58\].
    #[inline(always)]
    pub(crate) fn middle(a: &Self, b: &Self) -> Self {
        Self::combine(
            a,
            b,
            #[inline(always)]
            |x, y| (x + y) * 0.5,
        )
    }

    /// The stress that `number` makes of two.
    #[inline(always)]
    pub(crate) fn combine<A: Value, B: Value>(
        a: &AdmissibleStress<D, N, A>,
        b: &AdmissibleStress<D, N, B>,
        number: impl Fn(A, B) -> T,
    ) -> Self {
        let mut mean = [[number(a.mean[0][0], b.mean[0][0]); D]; D];
        for i in 0..D {
            for j in 0..D {
                mean[i][j] = number(a.mean[i][j], b.mean[i][j]);
            }
        }
        Self { mean, fluctuation: Fluctuation::combine(&a.fluctuation, &b.fluctuation, number) }
    }
}
