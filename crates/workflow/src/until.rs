//! The end of a run that goes on until all contact has ended.

use crate::leaving::GoingOn;
use crate::message::{short, trimmed};
use crate::report::Warning;
use percute_core::material::Law;
use percute_core::observer::{Observer, Progress};
use percute_core::problem::AnyProblem;
use percute_core::time::{TimeError, TimeGrid};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// How long a run goes on after the last contact, over the time of a wave along the diagonal of the mesh, unless it is
/// stated.
const AFTER: f64 = 2.0;

/// The name of the warning.
const NAME: &str = "no_rebound";

/// A run that ends with the rebound: of a body from its planes, or of bodies from each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// The latest end (s).
    pub longest: f64,
    /// Whether bodies may touch each other.
    pub between_bodies: bool,
    /// How long the run goes on after the last contact (s).
    pub after: f64,
    /// The step that was stated, before it is fitted to an end (s).
    pub step: f64,
}

/// The instants of such a run.
#[derive(Clone, Debug)]
pub struct FoundEnd {
    /// The instants, to an end of four digits, which as a number gives the same run.
    pub times: TimeGrid,
    /// The warning, if contact did not end before `longest`.
    pub warning: Option<Warning>,
}

impl Until {
    /// A run with these steps (s); `after` has a default.
    #[must_use]
    pub fn new(problem: &AnyProblem, longest: f64, after: Option<f64>, step: f64) -> Self {
        let wave_speed = problem.materials().iter().map(|m| m.wave_speed()).fold(0.0, f64::max);
        let between_bodies = !problem.conditions().interfaces.is_empty();
        Self { longest, between_bodies, after: after.unwrap_or(AFTER * problem.mesh().size() / wave_speed), step }
    }

    /// The instants to the latest end.
    ///
    /// # Errors
    /// As [`TimeGrid::with_step`].
    pub fn times(&self) -> Result<TimeGrid, TimeError> {
        TimeGrid::with_step(self.longest, self.step)
    }

    /// The instants of the run, from the time (s) at which all contact had ended in the first pass, or from what went
    /// on at its end.
    pub(crate) fn found(&self, ended: Result<f64, &GoingOn>) -> Result<FoundEnd, TimeError> {
        let end = ended.map_or(self.longest, |time| rounded_up(time).min(self.longest));
        let warning = ended.err().map(|going_on| self.not_ended(going_on));
        Ok(FoundEnd { times: TimeGrid::with_step(end, self.step)?, warning })
    }

    fn not_ended(&self, going_on: &GoingOn) -> Warning {
        let (longest, larger) = (trimmed(self.longest, 4), "give a larger `longest`");
        let (brief, advice) = match (going_on, self.between_bodies) {
            (GoingOn::NoContact, false) => (
                format!("the body has not touched a plane by {longest} s"),
                format!("does it move towards its plane? If it does, {larger}"),
            ),
            (GoingOn::NoContact, true) => (
                format!("nothing has touched by {longest} s"),
                format!("do the bodies move towards each other? If they do, {larger}"),
            ),
            (GoingOn::Contact, false) => {
                (format!("the body has not left its plane by {longest} s"), larger.to_string())
            }
            (GoingOn::Contact, true) => (format!("contact has not ended by {longest} s"), larger.to_string()),
            (GoingOn::Waiting { last }, _) => {
                let (last, after) = (trimmed(*last, 4), trimmed(self.after, 4));
                (
                    format!("contact forces act until {last} s, less than {after} s before {longest} s"),
                    larger.to_string(),
                )
            }
            (GoingOn::Nearing { last, body, other, speed }, _) => {
                let (last, speed) = (trimmed(*last, 4), short(*speed, 3));
                let nearing = match other {
                    Some(other) => format!("\"{body}\" and \"{other}\" approach each other at {speed} m/s"),
                    None if self.between_bodies => format!("\"{body}\" moves towards its plane at {speed} m/s"),
                    None => format!("the body moves towards its plane at {speed} m/s"),
                };
                let advice = format!("if they are to touch once more, {larger}; else contact has ended");
                let advice = if other.is_some() { advice } else { advice.replace("they are", "it is") };
                (format!("no contact force acts after {last} s, but {nearing} at {longest} s"), advice)
            }
        };
        let message = format!("{brief}, the latest end: the run ends there; {advice}");
        Warning { name: NAME, brief, message }
    }

    /// The warning of a run that was taken up again and goes to the latest end.
    #[must_use]
    pub fn not_found(&self) -> Warning {
        let longest = trimmed(self.longest, 4);
        let brief = format!("contact has not ended for good by {longest} s");
        let message = format!("{brief}, the latest end: the run ends there; give a larger `longest`");
        Warning { name: NAME, brief, message }
    }
}

/// Why a problem cannot end with a rebound, if it cannot.
#[must_use]
pub fn no_rebound(problem: &AnyProblem) -> Option<&'static str> {
    let nothing = problem.obstacle_count() == 0;
    nothing.then_some("\"rebound\" needs a plane or another body that is struck: give one, or an end in s")
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

/// Stops a run when all contact has ended, or when another observer wishes.
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
