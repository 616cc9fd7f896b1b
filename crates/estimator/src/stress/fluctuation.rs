//! The stress of an element without its mean.

use super::reference::{ALL, FREE, LOADS, PAIRS, Reference};
use crate::lanes::{Lanes, Value};
use std::sync::OnceLock;

/// Coordinates of a fluctuation in which its energy (J per unit of section or thickness) is the sum of squares, two for each edge, which a
/// bar has none of, and node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fluctuation<const D: usize, const N: usize, T = f64> {
    pub(crate) edges: [[T; D]; N],
    pub(crate) nodes: [[T; D]; N],
}

impl<const D: usize, const N: usize, T: Value> Fluctuation<D, N, T> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self { edges: [[T::ZERO; D]; N], nodes: [[T::ZERO; D]; N] }
    }

    /// ½∫σ : K⁻¹ σ (J per unit of section or thickness).
    #[inline(always)]
    pub(crate) fn energy(&self) -> T {
        let mut energy = T::ZERO;
        for k in 0..N {
            for c in 0..D {
                energy += self.edges[k][c] * self.edges[k][c];
                energy += self.nodes[k][c] * self.nodes[k][c];
            }
        }
        energy
    }

    /// The coordinates that `number` makes of those of two.
    #[inline(always)]
    pub(crate) fn combine<A: Value, B: Value>(
        a: &Fluctuation<D, N, A>,
        b: &Fluctuation<D, N, B>,
        number: impl Fn(A, B) -> T,
    ) -> Self {
        let mut both = Self::zero();
        for k in 0..N {
            for c in 0..D {
                both.edges[k][c] = number(a.edges[k][c], b.edges[k][c]);
                both.nodes[k][c] = number(a.nodes[k][c], b.nodes[k][c]);
            }
        }
        both
    }
}

/// Free stresses of the reference triangle, and stresses of a unit of each load of a fluctuation.
pub(super) const MODES: usize = FREE + 12;
/// The first that belongs to a load: differences of tractions on the edges, then volume loads at the nodes.
pub(super) const START: usize = FREE;

/// ∫ of products of these stresses over the reference triangle, for each pair of components.
#[derive(Debug)]
pub(super) struct FluctuationGram(Vec<[f64; PAIRS.len()]>);

impl FluctuationGram {
    /// Those of the reference triangle, made at first use.
    pub(super) fn get() -> &'static Self {
        static GRAM: OnceLock<FluctuationGram> = OnceLock::new();
        GRAM.get_or_init(Self::combine)
    }

    fn combine() -> Self {
        let gram = &Reference::get().gram;
        let free = |at: usize| std::array::from_fn(|i| f64::from(u8::from(i == LOADS + at)));
        let columns: [[f64; ALL]; MODES] = std::array::from_fn(|i| if i < START { free(i) } else { loads(i - START) });
        let mut products = Vec::with_capacity(MODES * (MODES + 1) / 2);
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

    /// The weight of each pair of components.
    pub(super) fn weights(weight: impl Fn(usize, usize) -> Lanes) -> [Lanes; PAIRS.len()] {
        PAIRS.map(|(a, b)| weight(a, b))
    }

    /// The product of two stresses, i ≥ j, with these weights.
    #[inline(always)]
    pub(super) fn entry(&self, i: usize, j: usize, weights: &[Lanes; PAIRS.len()]) -> Lanes {
        let mut sum = Lanes::ZERO;
        for (weight, product) in weights.iter().zip(&self.0[i * (i + 1) / 2 + j]) {
            sum += *weight * *product;
        }
        sum
    }
}

/// The loads on the reference triangle that a unit of a load of a fluctuation brings about: those that put no force on any node.
fn loads(at: usize) -> [f64; ALL] {
    let (k, c) = (at / 2 % 3, at % 2);
    // Differences of the moments of tractions at the ends of each edge, and forces of the volume load on the nodes.
    let (mut differences, mut inner, mut loads) = ([0.0; 3], [0.0; 3], [0.0; ALL]);
    if at < 6 {
        differences[k] = 1.0 / 6.0;
    } else {
        // On the triangle of area ½, ∫φ_i φ_j is 1/24, and twice that for i = j.
        inner = std::array::from_fn(|i| if i == k { 1.0 / 12.0 } else { 1.0 / 24.0 });
        loads[12 + 2 * k + c] = 1.0;
    }
    // The resultants of the two edges at each node.
    let around: [f64; 3] =
        std::array::from_fn(|i| 2.0 * inner[i] + differences[(i + 2) % 3] - differences[(i + 1) % 3]);
    let half_sum = 0.5 * around.iter().sum::<f64>();
    for edge in 0..3 {
        let (resultant, difference) = (half_sum - around[edge], differences[edge]);
        let moments = [0.5 * (resultant - difference), 0.5 * (resultant + difference)];
        (0..2).for_each(|p| loads[4 * edge + 2 * p + c] = 4.0 * moments[p] - 2.0 * moments[1 - p]);
    }
    loads
}
