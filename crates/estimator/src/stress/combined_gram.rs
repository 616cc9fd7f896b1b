//! Products of combinations of the stresses of a reference element.

use percute_core::simd::lanes::Lanes;

/// For each pair of components of a stress, ∫ of products of some combinations of the basis over the reference element,
/// on and below the diagonal.
#[derive(Debug)]
pub(super) struct CombinedGram<const PAIRS: usize>(Vec<[f64; PAIRS]>);

impl<const PAIRS: usize> CombinedGram<PAIRS> {
    /// Of these combinations, by the product of two.
    pub(super) fn new<C>(combinations: &[C], product: impl Fn(&C, &C) -> [f64; PAIRS]) -> Self {
        let rows = combinations.iter().enumerate();
        Self(rows.flat_map(|(i, x)| combinations[..=i].iter().map(|y| product(x, y)).collect::<Vec<_>>()).collect())
    }

    /// The product of two of them, i ≥ j, with a weight of each pair of components.
    #[inline(always)]
    pub(super) fn entry(&self, i: usize, j: usize, weights: &[Lanes; PAIRS]) -> Lanes {
        let mut sum = Lanes::ZERO;
        for (weight, product) in weights.iter().zip(&self.0[i * (i + 1) / 2 + j]) {
            sum += *weight * *product;
        }
        sum
    }
}

/// A single stress of the basis.
pub(super) fn unit<const ALL: usize>(at: usize) -> [f64; ALL] {
    std::array::from_fn(|i| f64::from(u8::from(i == at)))
}
