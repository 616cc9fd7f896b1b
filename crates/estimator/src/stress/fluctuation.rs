//! The stress of an element without its mean.

use super::combined_gram::{CombinedGram, unit};
use super::reference::{ALL, FREE, LOADS, PAIRS, Reference};
use percute_core::simd::lanes::Value;
use std::sync::OnceLock;

/// Coordinates of a fluctuation in which its energy (J per unit of section or thickness) is the sum of squares. There
/// are as many as numbers that make up the fluctuation: the deviations of the tractions on each face from their mean
/// there, D − 1 vectors, and the volume load at each node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fluctuation<const D: usize, const N: usize, T = f64> {
    /// For each k, D − 1 vectors of face k, then that of node k.
    pub(crate) coordinates: [[[T; D]; D]; N],
}

impl<const D: usize, const N: usize, T: Value> Fluctuation<D, N, T> {
    /// The same number in all coordinates.
    #[inline(always)]
    pub(crate) fn filled(number: T) -> Self {
        Self { coordinates: [[[number; D]; D]; N] }
    }

    /// ½∫σ : K⁻¹ σ (J per unit of section or thickness).
    #[inline(always)]
    pub(crate) fn energy(&self) -> T {
        let mut energy = self.coordinates[0][0][0].zero();
        for k in 0..N {
            for c in 0..D {
                for r in 0..D {
                    energy += self.coordinates[k][r][c] * self.coordinates[k][r][c];
                }
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
        let mut both = Self::filled(number(a.coordinates[0][0][0], b.coordinates[0][0][0]));
        for k in 0..N {
            for r in 0..D {
                for c in 0..D {
                    both.coordinates[k][r][c] = number(a.coordinates[k][r][c], b.coordinates[k][r][c]);
                }
            }
        }
        both
    }
}

/// Numbers that make up a fluctuation of a triangle: two for each edge, then two for each node.
pub(super) const FLUCTUATION_LOADS: usize = 12;
/// Free stresses of the reference triangle, and stresses of a unit of each load of a fluctuation.
pub(super) const MODES: usize = FREE + FLUCTUATION_LOADS;
/// The first that belongs to a load: differences of tractions on the edges, then volume loads at the nodes.
pub(super) const START: usize = FREE;

/// The products of these stresses, made at first use.
pub(super) fn gram() -> &'static CombinedGram<{ PAIRS.len() }> {
    static GRAM: OnceLock<CombinedGram<{ PAIRS.len() }>> = OnceLock::new();
    GRAM.get_or_init(|| {
        let column = |i: usize| if i < START { unit(LOADS + i) } else { loads(i - START) };
        let reference = Reference::get();
        CombinedGram::new(&std::array::from_fn::<_, MODES, _>(column), |x, y| reference.product(x, y))
    })
}

/// The loads on the reference triangle that a unit of a load of a fluctuation brings about: those that put no force on
/// any node.
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
