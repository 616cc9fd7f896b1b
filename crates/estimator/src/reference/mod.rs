//! The true error of a simulation: against a finer simulation, or against an exact solution.
//!
//! It is the yardstick of the estimate: the effectivity is the estimated error over the true one
//! (§7.1.3). Both are measured in the same norm, kinetic plus elastic energy of a difference of
//! fields, at the instants t_n of the simulation:
//!
//! e²(t) = ½∫ρ|Δv|² + ½∫Δε : K : Δε.
//!
//! [`Motion`] keeps the fields of the simulation whose error is wanted. [`Comparison`] takes
//! the steps of a finer simulation as they come and compares; [`bar_impact_error`] evaluates
//! eq. \[60\] for the exact impact of a bar.

mod bar;
mod compare;
mod error;
mod locate;
mod motion;

pub use bar::bar_impact_error;
pub use compare::Comparison;
pub use error::ReferenceError;
pub use motion::Motion;

/// The true error at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrueErrorSample {
    /// t_n (s).
    pub time: f64,
    /// ½∫ρ|Δv|² (J).
    pub kinetic: f64,
    /// ½∫Δε : K : Δε (J), of materials that yield ½∫Δσ : K⁻¹ : Δσ.
    pub elastic: f64,
    /// Of materials that yield (J): the distance ∫⅓C|Δε_p|² + ½H_i Δp² of the hardening, and the misfit of either flow
    /// under the forces of the other, ∫∫φ(Ė_p) − Σ'·Ė_p dt, so far.
    pub dissipation: f64,
}

impl TrueErrorSample {
    /// e² (J).
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.dissipation
    }
}

/// The true error of a simulation (J^½).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrueError {
    /// √max e² over the t_n, as \[15\] for the estimate.
    pub sup: f64,
    /// √((1/T)∫e² dt) by the trapezoidal rule over the t_n, as \[16\].
    pub mean: f64,
    /// e² at the t_n.
    pub over_time: Vec<TrueErrorSample>,
}

impl TrueError {
    /// Measures from the samples of a run that starts at t = 0.
    fn new(over_time: Vec<TrueErrorSample>) -> Self {
        let largest = over_time.iter().fold(0.0_f64, |m, s| m.max(s.total()));
        let strip =
            |pair: &[TrueErrorSample]| 0.5 * (pair[1].time - pair[0].time) * (pair[0].total() + pair[1].total());
        let integral: f64 = over_time.windows(2).map(strip).sum();
        let end = over_time.last().map_or(0.0, |s| s.time);
        let mean = if end > 0.0 { (integral / end).sqrt() } else { 0.0 };
        Self { sup: largest.sqrt(), mean, over_time }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// e² = 1, 4, 0 at 0, 1, 3: the largest is 4, the integral 2.5 + 4 over 3.
    #[test]
    fn sup_and_mean() {
        let sample = |time, kinetic, elastic| TrueErrorSample { time, kinetic, elastic, dissipation: 0.0 };
        let error = TrueError::new(vec![sample(0.0, 0.5, 0.5), sample(1.0, 3.0, 1.0), sample(3.0, 0.0, 0.0)]);
        assert_eq!(error.sup, 2.0);
        // Rounding of one division and one root.
        assert!((error.mean - (6.5_f64 / 3.0).sqrt()).abs() < 1e-15);
    }
}
