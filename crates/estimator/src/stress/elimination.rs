//! Factors of symmetric matrices that are not negative, side by side.

use percute_core::simd::lanes::{LANES, Lanes};

/// A pivot that is smaller, relative to its diagonal entry, is the rounding of some terms of this entry.
const ROUNDING: f64 = 1e-15;

/// The first `PIVOTS` columns of L of LLᵀ, on and below the diagonal, from the entries of the matrix there; behind them
/// what is left of the entries when the first `PIVOTS` unknowns are eliminated.
#[inline(always)]
pub(super) fn eliminate<const ROWS: usize, const PIVOTS: usize>(
    entry: impl Fn(usize, usize) -> Lanes,
    lower: &mut [[Lanes; ROWS]; ROWS],
) {
    let mut inverse = [Lanes::ZERO; PIVOTS];
    for i in 0..ROWS {
        for j in 0..=i {
            let entry = entry(i, j);
            let mut rest = entry;
            for k in 0..j.min(PIVOTS) {
                rest -= lower[i][k] * lower[j][k];
            }
            if j >= PIVOTS {
                lower[i][j] = rest;
                continue;
            }
            if i > j {
                lower[i][j] = rest * inverse[j];
                continue;
            }
            lower[i][i] = Lanes::ZERO;
            for lane in 0..LANES {
                // In needles that are almost incompressible, nothing but rounding may be left of a pivot: its column is
                // then 0.
                if rest.0[lane] > ROUNDING * entry.0[lane] {
                    lower[i][i].0[lane] = rest.0[lane].sqrt();
                    inverse[i].0[lane] = 1.0 / lower[i][i].0[lane];
                }
            }
        }
    }
}
