//! Products of combinations of the stresses of the reference triangle.

use super::reference::{ALL, PAIRS, Reference};
use percute_core::simd::lanes::Lanes;

/// For each pair of components, ∫ of products of some combinations of the basis over the reference triangle, on and
/// below the diagonal.
#[derive(Debug)]
pub(super) struct CombinedGram(Vec<[f64; PAIRS.len()]>);

impl CombinedGram {
    /// Of these combinations.
    pub(super) fn new(columns: &[[f64; ALL]]) -> Self {
        let gram = &Reference::get().gram;
        let mut products = Vec::with_capacity(columns.len() * (columns.len() + 1) / 2);
        for (i, x) in columns.iter().enumerate() {
            for y in &columns[..=i] {
                products.push(gram.each_ref().map(|gram| {
                    let row = |(x, row): (&f64, &[f64; ALL])| x * row.iter().zip(y).map(|(g, y)| g * y).sum::<f64>();
                    x.iter().zip(gram).map(row).sum()
                }));
            }
        }
        Self(products)
    }

    /// The product of two of them, i ≥ j, with a weight of each pair of components.
    #[inline(always)]
    pub(super) fn entry(&self, i: usize, j: usize, weights: &[Lanes; PAIRS.len()]) -> Lanes {
        let mut sum = Lanes::ZERO;
        for (weight, product) in weights.iter().zip(&self.0[i * (i + 1) / 2 + j]) {
            sum += *weight * *product;
        }
        sum
    }
}

/// A single stress of the basis.
pub(super) fn unit(at: usize) -> [f64; ALL] {
    std::array::from_fn(|i| f64::from(u8::from(i == at)))
}
