//! The end of a run that goes on until the body has left its planes.

use crate::message::trimmed;
use crate::report::Warning;
use percute_core::history::{SinkError, State, StateSink};
use percute_core::material::Law;
use percute_core::observer::{Observer, Progress};
use percute_core::problem::Problem;
use percute_core::time::{TimeError, TimeGrid};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// How long a run goes on after the last contact, over the time of a wave along the diagonal of the body, unless it is
/// stated.
const AFTER: f64 = 2.0;

/// A run that ends with the rebound of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// The latest end (s).
    pub longest: f64,
    /// How long the run goes on after the last contact (s).
    pub after: f64,
    /// The step that was stated, before it is fitted to an end (s).
    pub step: f64,
}

/// The instants of such a run.
#[derive(Clone, Debug)]
pub struct Found {
    /// The instants, to an end of four digits, which as a number gives the same run.
    pub times: TimeGrid,
    /// The warning, if contact did not end before `longest`.
    pub warning: Option<Warning>,
}

impl Until {
    /// A run with these steps (s); `after` has a default.
    #[must_use]
    pub fn new<const D: usize, const N: usize>(
        problem: &Problem<D, N>,
        longest: f64,
        after: Option<f64>,
        step: f64,
    ) -> Self {
        let wave_speed = problem.materials().iter().map(|m| m.wave_speed()).fold(0.0, f64::max);
        Self { longest, after: after.unwrap_or(AFTER * problem.mesh().size() / wave_speed), step }
    }

    /// The instants to the latest end.
    ///
    /// # Errors
    /// As [`TimeGrid::with_step`].
    pub fn times(&self) -> Result<TimeGrid, TimeError> {
        TimeGrid::with_step(self.longest, self.step)
    }

    /// The instants of the run, from the time (s) at which the first pass ended, if it did, and whether a plane was
    /// touched.
    pub(crate) fn found(&self, left: Option<f64>, touched: bool) -> Result<Found, TimeError> {
        let end = left.map_or(self.longest, |time| rounded_up(time).min(self.longest));
        let warning = left.is_none().then(|| self.not_ended(touched));
        Ok(Found { times: TimeGrid::with_step(end, self.step)?, warning })
    }

    fn not_ended(&self, touched: bool) -> Warning {
        let brief = match touched {
            true => format!("the body has not left its plane by {} s", trimmed(self.longest, 4)),
            false => format!("the body has not touched a plane by {} s", trimmed(self.longest, 4)),
        };
        let advice = if touched { "give" } else { "does it move towards its plane? If it does, give" };
        let message = format!("{brief}, the latest end: the run ends there; {advice} a larger `longest`");
        Warning { name: "no_rebound", brief, message }
    }
}

/// Why a problem cannot end with a rebound, if it cannot.
#[must_use]
pub fn no_rebound<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Option<&'static str> {
    let interfaces = &problem.statement().interfaces;
    if problem.obstacles().is_empty() {
        return Some("\"rebound\" needs a plane that the body strikes: give one, or an end in s");
    }
    (!interfaces.is_empty())
        .then_some("\"rebound\" is that of one body from a plane: for several bodies give an end in s")
}

/// A positive number, rounded up to four digits, so that a summary shows all of it.
fn rounded_up(time: f64) -> f64 {
    let digits = 3 - time.log10().floor() as i32;
    // A power with a whole exponent, so that the text of the number has four digits.
    let shown = format!("{:e}", (time * 10.0_f64.powi(digits)).ceil());
    let (mantissa, exponent) = shown.split_once('e').unwrap_or((&shown, "0"));
    let exponent = exponent.parse::<i32>().unwrap_or(0) - digits;
    format!("{mantissa}e{exponent}").parse().unwrap_or(time)
}

/// Sees when the body has left its planes.
pub(crate) struct Leaving<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D, N>,
    after: f64,
    /// Last instant with a contact force (s).
    pub(crate) last: Option<f64>,
    /// When the body had left (s).
    pub(crate) left: Option<f64>,
    seen: &'a AtomicBool,
}

impl<'a, const D: usize, const N: usize> Leaving<'a, D, N> {
    pub(crate) fn new(problem: &'a Problem<D, N>, after: f64, seen: &'a AtomicBool) -> Self {
        Self { problem, after, last: None, left: None, seen }
    }
}

impl<const D: usize, const N: usize> StateSink<D> for Leaving<'_, D, N> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        let step = state.step();
        if step.reaction.iter().any(|force| *force != [0.0; D]) {
            self.last = Some(step.time);
        } else if let Some(last) = self.last
            && self.left.is_none()
            && step.time - last >= self.after
        {
            let (_, momentum) = state.energies(self.problem.mass());
            let away = |obstacle: &percute_core::contact::Obstacle<D>| obstacle.flat_frame().split(&momentum).0 > 0.0;
            if self.problem.obstacles().iter().all(away) {
                self.left = Some(step.time);
                self.seen.store(true, Relaxed);
            }
        }
        Ok(())
    }
}

/// Stops a run when the body has left, or when another observer wishes.
pub(crate) struct Stop<'a> {
    pub(crate) inner: &'a mut dyn Observer,
    pub(crate) left: &'a AtomicBool,
    /// Whether the other observer wished it.
    pub(crate) asked: bool,
}

impl Observer for Stop<'_> {
    fn observe(&mut self, progress: Progress) -> ControlFlow<()> {
        let asked = self.inner.observe(Progress { stage: "looking for the rebound", ..progress });
        self.asked |= asked == ControlFlow::Break(());
        if self.left.load(Relaxed) { ControlFlow::Break(()) } else { asked }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_have_four_digits() {
        for (time, end) in [(4.29447e-3, 4.295e-3), (5e-5, 5e-5), (1.0001, 1.001), (99.999, 100.0), (3.2e-9, 3.2e-9)] {
            assert_eq!(rounded_up(time), end);
        }
    }
}
