//! What steps of different lengths do to vibrations: below the critical step, too, their changes can amplify them
//! without bound, by parametric resonance (Skeel, *Variable step size destabilizes the Störmer/leapfrog/Verlet method*,
//! BIT 33, 1993).
//!
//! Each mode of frequency ω obeys the scheme by itself. In the coordinates P = c^½ v_{n+½} and Q = c^{−½} ω ū, where ū
//! is the displacement in the middle of step n and c = (1 − (ωΔt_n/2)²)^½, a step of the length of the one before is a
//! rotation. Slow changes of the step keep P² + Q² (the adiabatic invariant), and the map of any steps has the
//! determinant 1. Its largest singular value is the amplification.

use crate::time::TimeGrid;

/// Amplification of which a run is warned. In flat impacts of a bar on random, alternating and swinging steps, up to 40
/// did not change the drift of the energy (0.5 %); vibrations that are in the body from the start gain more than half
/// of its energy.
const NOTABLE: f64 = 10.0;
/// Amplification that is refused. From 300 on, the energy of such impacts drifted by 10 % and more, from 9 000 on by 99
/// %.
const REFUSED: f64 = 1000.0;
/// Frequencies for each step. A resonance that grows by g in a step is as wide as g in the angle θ of a step,
/// ω = 2/Δt_c sin(θ/2); it is notable after N steps if gN > ln 10. N frequencies are π/N apart, those of twice as many
/// miss its peak by π/4N at most, which leaves 8.7 of 10.
const FOR_EACH_STEP: usize = 2;
/// Fewest frequencies up to the critical one.
const FEWEST: usize = 256;
/// The products of steps and frequencies that take about half a second. Beyond 5 800 steps the frequencies are further
/// apart, so that weak resonances of many steps can be missed.
const MOST_WORK: usize = 1 << 26;
/// The largest of the frequencies over the critical one; beyond it c vanishes where a step is the critical one.
const HIGHEST: f64 = 0.999;

/// How far changes of the step amplify a vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplification {
    /// Largest ratio of amplitudes.
    pub factor: f64,
    /// The step at which it was reached.
    pub step: usize,
}

impl Amplification {
    /// Of steps that do not change.
    const NONE: Self = Self { factor: 1.0, step: 0 };

    /// Of all modes up to the critical frequency 2/Δt_c on these steps; `critical` is Δt_c (s). Beyond the factor that
    /// is refused the steps are not looked at any more.
    #[must_use]
    pub fn of(times: &TimeGrid, critical: f64) -> Self {
        let count = times.step_count();
        let first = times.step(0);
        if !times.varies() {
            return Self::NONE;
        }
        let mut modes = modes(critical, count, first);
        let mut largest = Self::NONE;
        for n in 1..count {
            let (before, step) = (times.step(n - 1), times.step(n));
            for mode in &mut modes {
                let factor = mode.advance(before, step);
                if factor > largest.factor {
                    largest = Self { factor, step: n };
                }
            }
            if largest.is_refused() {
                break;
            }
        }
        largest
    }

    /// Whether a run should be warned of it.
    #[must_use]
    pub fn is_notable(&self) -> bool {
        self.factor > NOTABLE
    }

    /// Whether the run would be unstable.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        self.factor > REFUSED
    }
}

/// Modes up to the critical frequency, closer to each other near it.
fn modes(critical: f64, steps: usize, first: f64) -> Vec<Mode> {
    let count = (MOST_WORK / steps).min(FOR_EACH_STEP * steps).max(FEWEST);
    let ratio = |k: usize| HIGHEST * (std::f64::consts::FRAC_PI_2 * (k + 1) as f64 / count as f64).sin();
    (0..count).map(|k| Mode::new(2.0 * ratio(k) / critical, first)).collect()
}

/// A mode on its way: the displacements and velocities that two unit starts have become.
struct Mode {
    frequency: f64,
    scale: f64,
    displacement: [f64; 2],
    velocity: [f64; 2],
}

/// c of a mode; steps above the critical one by a rounding must not make it vanish.
fn scale(frequency: f64, step: f64) -> f64 {
    (1.0 - (0.5 * frequency * step).powi(2)).max(1.0 - HIGHEST).sqrt()
}

impl Mode {
    fn new(frequency: f64, step: f64) -> Self {
        let scale = scale(frequency, step);
        let (displacement, velocity) = ([scale.sqrt() / frequency, 0.0], [0.0, 1.0 / scale.sqrt()]);
        Self { frequency, scale, displacement, velocity }
    }

    /// From the middle of one step to that of the next; gives the amplification so far.
    fn advance(&mut self, before: f64, step: f64) -> f64 {
        let kick = 0.5 * (before + step) * self.frequency * self.frequency;
        if step != before {
            self.scale = scale(self.frequency, step);
        }
        let mut sum = 0.0;
        for (u, v) in self.displacement.iter_mut().zip(&mut self.velocity) {
            *u += 0.5 * before * *v;
            *v -= kick * *u;
            *u += 0.5 * step * *v;
            sum += (self.frequency * *u).powi(2) / self.scale + v.powi(2) * self.scale;
        }
        // The singular values are s and 1/s; their squares add up to the sum.
        let half = (0.5 * sum).max(1.0);
        (half + (half * half - 1.0).sqrt()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(steps: &[f64]) -> Amplification {
        Amplification::of(&TimeGrid::from_steps(steps).unwrap(), 1.0)
    }

    fn alternating(a: f64, b: f64, count: usize) -> Vec<f64> {
        (0..count).map(|n| if n % 2 == 0 { a } else { b }).collect()
    }

    /// The largest growth of any mode in a pair of steps a, b: a drift of a, a kick, a drift of b and a kick make a
    /// matrix of the determinant 1 with the trace 2 − 2(a + b)p + ab p², p = ω²(a + b)/2, and this is its eigenvalue.
    fn growth_of_pairs(a: f64, b: f64) -> f64 {
        let growth = |frequency: f64| {
            let p = 0.5 * (a + b) * frequency * frequency;
            let half = 0.5 * (2.0 - 2.0 * (a + b) * p + a * b * p * p).abs();
            if half > 1.0 { half + (half * half - 1.0).sqrt() } else { 1.0 }
        };
        (1..2_000_000).map(|k| growth(1e-6 * f64::from(k))).fold(1.0, f64::max)
    }

    /// Small changes have narrow resonances, which need many steps.
    #[test]
    fn narrow_resonances_are_found() {
        for (change, count) in [(2e-3, 6000), (1e-3, 12_000), (0.01, 800)] {
            let (a, b) = (0.85 * (1.0 + change), 0.85 * (1.0 - change));
            let expected = growth_of_pairs(a, b).powi(count / 2);
            let found = of(&alternating(a, b, count as usize));
            assert!(expected > 100.0 && found.is_refused() == (expected > REFUSED), "{found:?}, not {expected}");
            assert!(found.is_refused() || (0.5..2.0).contains(&(found.factor / expected)), "{found:?}, not {expected}");
        }
    }

    #[test]
    fn alternating_steps_grow_as_their_eigenvalue() {
        let (a, b) = (0.8, 0.9);
        let [early, late] = [20, 50].map(|count| of(&alternating(a, b, count)).factor);
        let expected = growth_of_pairs(a, b).powi(15);
        // The nearest of 256 frequencies is within 1 % of the peak, which is flat.
        assert!(expected > 4.0 && (late / early / expected - 1.0).abs() < 0.1, "{late} over {early}, not {expected}");
    }

    #[test]
    fn equal_steps_and_slow_changes_do_not_amplify() {
        assert_eq!(of(&[0.9; 50]).factor, 1.0);
        let slow: Vec<f64> = (0..2000).map(|n| 0.7 + 0.2 * (0.05 * f64::from(n)).sin()).collect();
        // The invariant is adiabatic: it keeps a trace of the changes, of their rate near the highest frequency.
        assert!(of(&slow).factor < 1.1, "{:?}", of(&slow));
        let once: Vec<f64> = (0..200).map(|n| if n < 100 { 0.9 } else { 0.3 }).collect();
        // A single change turns a circle into an ellipse: its axes are the roots of the ratio of the two scales.
        let (short, long) = (scale(2.0 * HIGHEST, 0.3), scale(2.0 * HIGHEST, 0.9));
        let (found, expected) = (of(&once).factor, (short / long).sqrt());
        assert!((found / expected - 1.0).abs() < 0.02, "{found}, not {expected}");
    }

    #[test]
    fn resonance_is_notable_and_then_refused() {
        let few = of(&alternating(0.8, 0.9, 80));
        assert!(few.is_notable() && !few.is_refused(), "{few:?}");
        let many = of(&alternating(0.8, 0.9, 400));
        assert!(many.is_refused() && many.step < 400 && many.factor.is_finite(), "{many:?}");
        // Far below the critical step the same changes do no harm.
        assert!(!of(&alternating(0.08, 0.09, 400)).is_notable());
    }
}
