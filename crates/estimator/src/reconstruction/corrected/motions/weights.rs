//! The corrections of the acceleration, and the steps after which they are left out.

use super::lanes::{FirstPair, MOTIONS, Nodal};
use percute_core::time::TimeGrid;

/// Which part of each correction a motion has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Shares {
    /// That of the lumped mass.
    pub(in crate::reconstruction::corrected) mass: f64,
    /// That of the central differences.
    pub(in crate::reconstruction::corrected) time: f64,
}

impl Shares {
    /// Both corrections.
    pub(in crate::reconstruction::corrected) const ALL: Self = Self { mass: 1.0, time: 1.0 };
    /// None: the scheme of the simulation.
    pub(in crate::reconstruction::corrected) const NONE: Self = Self { mass: 0.0, time: 0.0 };
}

/// The corrections that elements and steps, or steps alone, half as long need no more: errors are of second order.
const QUARTERS: f64 = 0.75;

/// Those of the half-size solution, the half-step solution and the contact difference.
const BESIDE: [Shares; 3] =
    [Shares { mass: QUARTERS, time: QUARTERS }, Shares { mass: 0.0, time: QUARTERS }, Shares::NONE];

/// Reversals after which corrections are no longer made. Steps that are long and short in turn drive waves that need
/// four of them for a period; the corrected scheme has such waves from shorter steps on than the plain one, and can be
/// unstable where the simulation is not. A few do no harm; and the plain scheme is as stable as the simulation.
const FEW: usize = 8;
/// Relative difference from which on a step is longer than another.
const LONGER: f64 = 1e-3;

/// The weights of the corrections of all motions.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    shares: [Shares; MOTIONS],
    /// β.
    damping: f64,
    /// How often so far a step has been longer than both its neighbours, or shorter.
    reversals: usize,
}

/// Factors of the parts of a correction at one level.
#[derive(Clone, Copy, Debug)]
pub(super) struct LevelWeights {
    /// Of −M⁻¹Kã (s²) for the acceleration from t_n on, and up to t_n.
    pub(super) time: [Nodal; 2],
    /// Of M⁻¹(M − M_c)ã once and twice.
    pub(super) mass: [FirstPair; 2],
}

impl Weights {
    /// Those in `D` dimensions, with these shares of the auxiliary solution.
    pub(super) fn new<const D: usize>(auxiliary: Shares) -> Self {
        let [half_size, half_step, contact] = BESIDE;
        Self { shares: [auxiliary, half_size, half_step, contact], damping: damping::<D>(), reversals: 0 }
    }

    /// Those at t_n. Levels come in order.
    pub(super) fn at(&mut self, times: &TimeGrid, n: usize) -> LevelWeights {
        self.reversals += usize::from(n < times.step_count() && reverses(times, n));
        let shares = if self.reversals <= FEW { self.shares } else { [Shares::NONE; MOTIONS] };
        let (next, last) = (times.step(n.min(times.step_count() - 1)), times.step(n.saturating_sub(1)));
        let [first, second] = [shares[0].mass, shares[1].mass];
        let mass = |factor: f64| FirstPair([factor * first, factor * second, factor * first, factor * second]);
        let time = |square: f64| Nodal::new(shares.map(|share| [share.time * square / 12.0; 2]));
        LevelWeights { time: [time(next * last), time(last * last)], mass: [mass(0.5), mass(-self.damping)] }
    }
}

/// β of p(μ) = μ/2 − βμ².
///
/// The eigenvalues μ of an element are 0 and (D+1)/(D+2). In 2D, without β the shortest waves would be unstable from
/// 0.97 of the critical step on. With the β that makes p ≤ ⅓, x(1 + p − x/12) ≤ 4 for all x = Δt²ω² ≤ 4: the auxiliary
/// solution is stable wherever the simulation is. In 1D this β is 0. But there the simulation takes the critical step
/// exactly, its shortest wave grows with time once it is excited, and an auxiliary solution with the same growth does
/// not show it. With β ≥ 1/36 the auxiliary solution does not grow, at the price of a larger estimate at that step.
/// This changes errors of the order that is left anyway.
pub(super) fn damping<const D: usize>() -> f64 {
    let largest = (D + 1) as f64 / (D + 2) as f64;
    ((0.5 * largest - 1.0 / 3.0) / (largest * largest)).max(1.0 / 36.0)
}

/// Whether the step before t_n is longer than those beside it, or shorter.
fn reverses(times: &TimeGrid, n: usize) -> bool {
    let change = |k: usize| times.step(k) / times.step(k - 1) - 1.0;
    n >= 2 && change(n) * change(n - 1) < 0.0 && change(n).abs().min(change(n - 1).abs()) > LONGER
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding, steps that become shorter once, or swing slowly, do not reverse; steps in turn do.
    #[test]
    fn which_steps_reverse() {
        let count = |steps: Vec<f64>| {
            let times = TimeGrid::from_steps(&steps).unwrap();
            (0..steps.len()).filter(|&n| reverses(&times, n)).count()
        };
        assert_eq!(count(vec![0.1; 997]), 0);
        assert_eq!(count([vec![0.1; 50], vec![0.05; 50], vec![0.001]].concat()), 0);
        assert_eq!(count((0..1000).map(|n| 1.0 + 0.1 * (0.006 * n as f64).sin()).collect()), 0);
        assert_eq!(count((0..20).map(|n| if n % 2 == 0 { 0.1 } else { 0.09 }).collect()), 18);
    }
}
