//! The instants t_0 … t_N of a simulation.

use crate::message::trimmed;
use thiserror::Error;

/// Runs longer than this many steps are taken for a mistake of unit.
const MOST_STEPS: f64 = if cfg!(fuzzing) { 1e5 } else { 1e8 };

/// A step may exceed the critical one by this much, so that a ratio of 1 and a step copied from a summary
/// with seven digits are not refused.
const SLACK: f64 = 1e-6;
/// An end agrees with the sum of steps if they differ by no more than this, relatively.
const AGREES: f64 = 1e-9;

/// Steps that differ by less than this, relatively, are equal but for rounding. Differences of 1e-6 at each of 5 000
/// steps still amplify vibrations by less than 1 %.
const EQUAL: f64 = 1e-9;
/// So are steps that differ by less than this part of the end: two instants, each rounded twice.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Whether a step (s) is at most the critical one (s), but for the digits that a printed one lacks.
#[must_use]
pub fn is_stable(step: f64, critical: f64) -> bool {
    step <= critical * (1.0 + SLACK)
}

/// Why a time grid was refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum TimeError {
    /// A length of time that must be positive.
    #[error("`{name}` is {} s; it must be positive and finite", trimmed(*.value, 12))]
    NotPositive {
        /// `end`, `step` or `steps[i]`.
        name: String,
        value: f64,
    },
    /// No steps at all.
    #[error("`steps` is empty; give at least one time step in seconds")]
    Empty,
    /// Instants that make no step.
    #[error("{} given; at least 2 make a step", match *.count {
        1 => "a single instant is".to_string(),
        count => format!("{count} instants are"),
    })]
    TooFew { count: usize },
    /// A first instant that is not 0.
    #[error("the first instant is {} s; it must be 0", trimmed(*.time, 5))]
    Start { time: f64 },
    /// Instants that do not increase.
    #[error("instant {index} is {} s, not after the {} s before it", trimmed(*.time, 12), trimmed(*.before, 12))]
    Order {
        /// Which instant, from 0.
        index: usize,
        time: f64,
        before: f64,
    },
    /// Instants that go down.
    #[error(
        "the instants go down from {} s to {} s: the order in time is reversed; turn all rows round",
        trimmed(*.first, 5), trimmed(*.last, 5)
    )]
    Reversed { first: f64, last: f64 },
    /// A step that is lost in the sum, or a sum that is infinite.
    #[error(
        "`steps[{index}]` is {} s, which cannot be added to the {} s before it",
        trimmed(*.step, 5), trimmed(*.time, 12)
    )]
    Lost { index: usize, step: f64, time: f64 },
    /// More steps than any run can have.
    #[error(
        "an end at {} s with steps of {} s makes {} steps, but at most 1e8 are possible; are both in seconds?",
        trimmed(*.end, 5), trimmed(*.step, 5), trimmed(*.count, 4)
    )]
    TooMany { end: f64, step: f64, count: f64 },
}

/// Increasing instants from 0 to T.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeGrid {
    instants: Vec<f64>,
}

impl TimeGrid {
    /// `count` equal steps from 0 to `end` (s).
    ///
    /// # Errors
    /// An end that is not positive, or no steps.
    pub fn uniform(end: f64, count: usize) -> Result<Self, TimeError> {
        positive("end", end)?;
        if count == 0 {
            return Err(TimeError::Empty);
        }
        if count as f64 > MOST_STEPS {
            return Err(TimeError::TooMany { end, step: end / count as f64, count: count as f64 });
        }
        Ok(Self { instants: (0..=count).map(|n| end * (n as f64 / count as f64)).collect() })
    }

    /// Equal steps of at most about `step` (s) that end at `end` (s) exactly:
    /// N = ceil(T/Δt − 10⁻⁶) steps of T/N.
    ///
    /// # Errors
    /// Lengths that are not positive, or more steps than a run can have.
    pub fn with_step(end: f64, step: f64) -> Result<Self, TimeError> {
        positive("end", end)?;
        positive("step", step)?;
        let count = (end / step - 1e-6).ceil().max(1.0);
        if count > MOST_STEPS {
            return Err(TimeError::TooMany { end, step, count });
        }
        Self::uniform(end, count as usize)
    }

    /// Steps of the lengths given (s).
    ///
    /// # Errors
    /// No steps, or one that is not positive.
    pub fn from_steps(steps: &[f64]) -> Result<Self, TimeError> {
        if steps.is_empty() {
            return Err(TimeError::Empty);
        }
        let mut instants = vec![0.0];
        let mut time = 0.0;
        for (i, &step) in steps.iter().enumerate() {
            positive(&format!("steps[{i}]"), step)?;
            let later = time + step;
            if later <= time || !later.is_finite() {
                return Err(TimeError::Lost { index: i, step, time });
            }
            time = later;
            instants.push(time);
        }
        Ok(Self { instants })
    }

    /// The instants given (s), from 0 on.
    ///
    /// # Errors
    /// Fewer than two instants, all in descending order, a first that is not 0, one that is not after that before it.
    pub fn from_instants(instants: Vec<f64>) -> Result<Self, TimeError> {
        if instants.len() < 2 {
            return Err(TimeError::TooFew { count: instants.len() });
        }
        if instants.is_sorted_by(|a, b| a > b) {
            return Err(TimeError::Reversed { first: instants[0], last: instants[instants.len() - 1] });
        }
        if instants[0] != 0.0 {
            return Err(TimeError::Start { time: instants[0] });
        }
        for (before, pair) in instants.windows(2).enumerate() {
            if !pair[1].is_finite() || pair[1] <= pair[0] {
                return Err(TimeError::Order { index: before + 1, time: pair[1], before: pair[0] });
            }
        }
        Ok(Self { instants })
    }

    /// The instants t_0 = 0 … t_N = T (s).
    #[must_use]
    pub fn instants(&self) -> &[f64] {
        &self.instants
    }

    /// Number of steps N.
    #[must_use]
    pub fn step_count(&self) -> usize {
        self.instants.len() - 1
    }

    /// T (s).
    #[must_use]
    pub fn end(&self) -> f64 {
        self.instants[self.step_count()]
    }

    /// Δt_n = t_{n+1} − t_n (s). Beyond the last step its length is kept, for the predictor that
    /// gives the last reaction.
    #[must_use]
    pub fn step(&self, n: usize) -> f64 {
        let n = n.min(self.step_count() - 1);
        self.instants[n + 1] - self.instants[n]
    }

    /// Whether the grid ends at `end` (s), but for rounding of what was added up; not at NaN.
    #[must_use]
    pub fn ends_at(&self, end: f64) -> bool {
        (end - self.end()).abs() <= AGREES * self.end()
    }

    /// Whether the steps have different lengths. Sums of equal steps differ by rounding, 1e-16 of the time.
    #[must_use]
    pub fn varies(&self) -> bool {
        let first = self.step(0);
        let equal = (EQUAL * first).max(ROUNDING * self.end());
        (1..self.step_count()).any(|n| (self.step(n) - first).abs() > equal)
    }

    /// Longest step (s).
    #[must_use]
    pub fn longest_step(&self) -> f64 {
        (0..self.step_count()).map(|n| self.step(n)).fold(0.0, f64::max)
    }

    /// The factor h_n of a_n in v_{n+½} = v_{n−½} + h_n a_n: ½(Δt_{n−1} + Δt_n), at the start ½Δt_0
    /// (eq. \[29\], \[31\]).
    #[must_use]
    pub fn velocity_step(&self, n: usize) -> f64 {
        if n == 0 { 0.5 * self.step(0) } else { 0.5 * (self.step(n - 1) + self.step(n)) }
    }
}

fn positive(name: &str, value: f64) -> Result<(), TimeError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(TimeError::NotPositive { name: name.to_string(), value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wanted_step_ends_at_the_end() {
        let grid = TimeGrid::with_step(1.0, 0.3).unwrap();
        assert_eq!((grid.step_count(), grid.end()), (4, 1.0));
        // A step that divides the time to rounding is not shortened.
        assert_eq!(TimeGrid::with_step(0.3, 0.1).unwrap().step_count(), 3);
    }

    #[test]
    fn variable_steps_and_the_last_predictor() {
        let grid = TimeGrid::from_steps(&[1.0, 2.0]).unwrap();
        assert_eq!(grid.instants(), [0.0, 1.0, 3.0]);
        assert_eq!([0, 1, 2].map(|n| grid.velocity_step(n)), [0.5, 1.5, 2.0]);
    }

    #[test]
    fn equal_steps_do_not_vary_however_many() {
        // The last instants are rounded to 1e-9 of a step.
        let end = 1.3 / 7.0;
        assert!(!TimeGrid::uniform(end, 20_000_003).unwrap().varies());
        let step = end / 1e4;
        for difference in [1e-8, -1e-8] {
            let mut steps = vec![step; 10_000];
            steps[9_000] += difference * step;
            assert!(TimeGrid::from_steps(&steps).unwrap().varies());
        }
    }

    #[test]
    fn impossible_times_are_refused() {
        assert!(TimeGrid::with_step(f64::NAN, 0.1).is_err());
        assert!(TimeGrid::with_step(1.0, -0.1).is_err());
        assert!(matches!(TimeGrid::with_step(1.0, 1e-12), Err(TimeError::TooMany { .. })));
        assert_eq!(TimeGrid::from_steps(&[]), Err(TimeError::Empty));
    }

    #[test]
    fn instants_come_back_bit_by_bit_or_are_refused() {
        let grid = TimeGrid::with_step(1.3e-5, 2.9e-7).unwrap();
        assert_eq!(TimeGrid::from_instants(grid.instants().to_vec()), Ok(grid));
        assert_eq!(TimeGrid::from_instants(vec![0.0]), Err(TimeError::TooFew { count: 1 }));
        assert_eq!(TimeGrid::from_instants(vec![1.0, 2.0]), Err(TimeError::Start { time: 1.0 }));
        assert_eq!(TimeGrid::from_instants(vec![2.0, 1.0, 0.0]), Err(TimeError::Reversed { first: 2.0, last: 0.0 }));
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = TimeGrid::from_instants(vec![0.0, 1.0, wrong]);
            assert!(matches!(error, Err(TimeError::Order { index: 2, before: 1.0, .. })), "{error:?}");
        }
    }
}
