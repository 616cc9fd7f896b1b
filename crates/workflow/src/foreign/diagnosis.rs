//! A history with its figures, and changes of it that are measured.

use super::attempt::Attempt;
use super::complete::Derived;
use super::figures::Consistency;
use super::measure::{Evidence, measure};
use crate::step_filter::{StepFilter, Take};
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::problem::AnyProblem;

/// A history with its figures.
pub(super) struct Diagnosis<'s> {
    pub(super) problem: &'s AnyProblem,
    pub(super) source: &'s dyn StepSource,
    pub(super) derived: &'s [Derived],
    pub(super) found: &'s Consistency,
    pub(super) evidence: &'s Evidence<'s>,
}

impl Diagnosis<'_> {
    /// The norm of the residual, relative.
    pub(super) fn residual(&self) -> f64 {
        self.evidence.residual.norm([1.0; 4])
    }

    /// Whether contact forces are given.
    pub(super) fn has_forces(&self) -> bool {
        !self.derived.contains(&Derived::Reaction) && self.evidence.contact.forced.contains(&true)
    }

    /// What a history leaves of the residual, with the contact forces of so many steps later.
    pub(super) fn attempt(&self, source: &dyn StepSource, shift: isize, text: String) -> Result<Attempt, SinkError> {
        let (_, evidence) = measure(self.problem, source, self.derived, shift)?;
        Ok(Attempt { text, before: self.residual(), left: evidence.residual.norm([1.0; 4]) })
    }

    /// What other displacements and accelerations leave of the residual inside the body.
    pub(super) fn attempt_inside(
        &self,
        text: String,
        change: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Result<Attempt, SinkError> {
        let changed = self.with(change);
        let (_, evidence) = measure(self.problem, &changed, self.derived, 0)?;
        Ok(Attempt { text, before: self.evidence.residual.inside(), left: evidence.residual.inside() })
    }

    /// The history with other displacements and accelerations.
    fn with<'c>(
        &'c self,
        change: impl Fn(&[f64]) -> Vec<f64> + 'c,
    ) -> StepFilter<'c, impl Fn(&Step<'_>, &mut Take<'_>) -> Result<(), SinkError>> {
        StepFilter::new(self.source, move |step: &Step<'_>, take: &mut Take<'_>| {
            let (displacement, acceleration) = (change(step.displacement), step.acceleration.map(&change));
            take(&Step { displacement: &displacement, acceleration: acceleration.as_deref(), ..*step })
        })
    }
}
