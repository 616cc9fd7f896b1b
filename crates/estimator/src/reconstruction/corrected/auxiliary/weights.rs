//! The corrections of the acceleration, and the steps after which they are left out.

use super::lanes::{FirstPair, MOTIONS, Nodal};
use crate::smoothing::{Coefficients, Smoothing};
use percute_core::time::TimeGrid;

/// Which part of each correction a motion has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Shares {
    /// That of the mesh: of smoothed strains and of the lumped mass.
    pub(in crate::reconstruction::corrected) space: f64,
    /// That of the central differences.
    pub(in crate::reconstruction::corrected) time: f64,
}

impl Shares {
    /// Both corrections.
    pub(in crate::reconstruction::corrected) const ALL: Self = Self { space: 1.0, time: 1.0 };
    /// None: the scheme of the simulation.
    pub(in crate::reconstruction::corrected) const NONE: Self = Self { space: 0.0, time: 0.0 };
}

/// The corrections that elements and steps, or steps alone, half as long need no more: errors are of second order.
const QUARTERS: f64 = 0.75;

/// Those of the halved-elements solution, the halved-step solution and the contact difference.
const BESIDE: [Shares; 3] =
    [Shares { space: QUARTERS, time: QUARTERS }, Shares { space: 0.0, time: QUARTERS }, Shares::NONE];

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
    /// Those of the lumping difference in each body.
    bodies: Vec<BodyWeights>,
    /// The same without corrections.
    plain: Vec<BodyWeights>,
    /// How often so far a step has been longer than both its neighbours, or shorter.
    reversals: usize,
}

/// Factors of the lumping difference in a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyWeights {
    /// Of M⁻¹(M − M_c)ã once, twice and three times.
    pub(super) mass: [FirstPair; 3],
}

/// Factors of the parts of a correction at one level.
#[derive(Clone, Copy, Debug)]
pub(super) struct LevelWeights<'a> {
    /// Of −M⁻¹Kã (s²) for the acceleration from t_n on, and up to t_n.
    pub(super) time: [Nodal; 2],
    pub(super) bodies: &'a [BodyWeights],
    /// Whether strains are smoothed.
    pub(super) smooths: bool,
}

impl BodyWeights {
    fn new(body: &Coefficients, [first, second]: [f64; 2]) -> Self {
        let pair = |factor: f64| FirstPair([factor * first, factor * second, factor * first, factor * second]);
        Self { mass: body.mass.map(pair) }
    }

    /// Those of all bodies, with these shares of the first pair of motions.
    fn all(smoothing: &Smoothing, shares: [f64; 2]) -> Vec<Self> {
        smoothing.bodies().iter().map(|body| Self::new(body, shares)).collect()
    }

    /// Those of the auxiliary solution.
    pub(super) fn auxiliary(&self) -> [f64; 3] {
        self.mass.map(|pair| pair.0[0])
    }
}

/// The shares of all motions, with these of the auxiliary solution.
pub(super) fn shares(auxiliary: Shares) -> [Shares; MOTIONS] {
    let [halved_elements, halved_step, contact] = BESIDE;
    [auxiliary, halved_elements, halved_step, contact]
}

impl Weights {
    /// Those with these shares of the auxiliary solution.
    pub(super) fn new(smoothing: &Smoothing, auxiliary: Shares) -> Self {
        let shares = shares(auxiliary);
        let of = |pair| BodyWeights::all(smoothing, pair);
        Self { shares, bodies: of([shares[0].space, shares[1].space]), plain: of([0.0; 2]), reversals: 0 }
    }

    /// Takes in the step from t_n on. Levels come in order.
    pub(super) fn begin(&mut self, times: &TimeGrid, n: usize) {
        self.reversals += usize::from(n < times.step_count() && reverses(times, n));
    }

    /// Weakens the corrections of the mass to this part.
    pub(super) fn weaken(&mut self, smoothing: &Smoothing, part: f64) {
        let pair = [self.shares[0].space, self.shares[1].space].map(|share| part * share);
        self.bodies = BodyWeights::all(smoothing, pair);
    }

    /// Whether strains of the auxiliary solution are smoothed at the level that has begun, if the mesh has such.
    pub(super) fn smooths(&self) -> bool {
        self.corrects() && self.shares[0].space > 0.0
    }

    /// Whether corrections are made at the level that has begun.
    pub(super) fn corrects(&self) -> bool {
        self.reversals <= FEW
    }

    /// c₁, c₂ and −c₃ of the auxiliary solution in a body, where corrections are made.
    pub(super) fn auxiliary(&self, body: usize) -> [f64; 3] {
        self.bodies[body].auxiliary()
    }

    /// The same, 0 where corrections are not made.
    pub(super) fn mass(&self, body: usize) -> [f64; 3] {
        if self.corrects() { self.auxiliary(body) } else { [0.0; 3] }
    }

    /// Those at t_n.
    pub(super) fn at(&self, times: &TimeGrid, n: usize) -> LevelWeights<'_> {
        let (next, last) = (times.step(n.min(times.step_count() - 1)), times.step(n.saturating_sub(1)));
        self.of_steps([next * last, last * last])
    }

    /// Those with these products of step lengths (s²), from t_n on and up to t_n.
    pub(super) fn of_steps(&self, squares: [f64; 2]) -> LevelWeights<'_> {
        let corrects = self.corrects();
        let shares = if corrects { self.shares } else { [Shares::NONE; MOTIONS] };
        let time = |square: f64| Nodal::new(shares.map(|share| [share.time * square / 12.0; 2]));
        let bodies = if corrects { &self.bodies } else { &self.plain };
        LevelWeights { time: squares.map(time), bodies, smooths: corrects }
    }
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
