//! A history with its figures, and changes of it that are measured.

use super::complete::Derived;
use super::figures::Consistency;
use super::measure::{Evidence, measure};
use super::tried::Tried;
use crate::through::{Take, Through};
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::problem::Problem;

/// A history with its figures.
pub(super) struct Suspect<'s, const D: usize, const N: usize> {
    pub(super) problem: &'s Problem<D, N>,
    pub(super) source: &'s dyn StepSource<D>,
    pub(super) derived: &'s [Derived],
    pub(super) found: &'s Consistency,
    pub(super) evidence: &'s Evidence<'s, D, N>,
}

impl<const D: usize, const N: usize> Suspect<'_, D, N> {
    /// The norm of the residual, relative.
    pub(super) fn residual(&self) -> f64 {
        self.evidence.residual.norm([1.0; 4])
    }

    /// Whether contact forces are given.
    pub(super) fn has_forces(&self) -> bool {
        !self.derived.contains(&Derived::Reaction) && self.evidence.contact.forced.contains(&true)
    }

    /// What a history leaves of the residual, with the contact forces of so many steps later.
    pub(super) fn tried(&self, source: &dyn StepSource<D>, shift: isize, text: String) -> Result<Tried, SinkError> {
        let (_, evidence) = measure(self.problem, source, self.derived, shift)?;
        Ok(Tried { text, before: self.residual(), left: evidence.residual.norm([1.0; 4]) })
    }

    /// What other displacements and accelerations leave of the residual inside the body.
    pub(super) fn tried_inside(
        &self,
        text: String,
        change: impl Fn(&[[f64; D]]) -> Vec<[f64; D]>,
    ) -> Result<Tried, SinkError> {
        let changed = self.with(change);
        let (_, evidence) = measure(self.problem, &changed, self.derived, 0)?;
        Ok(Tried { text, before: self.evidence.residual.inside(), left: evidence.residual.inside() })
    }

    /// The history with other displacements and accelerations.
    fn with<'c>(
        &'c self,
        change: impl Fn(&[[f64; D]]) -> Vec<[f64; D]> + 'c,
    ) -> Through<'c, impl Fn(&Step<'_, D>, &mut Take<'_, D>) -> Result<(), SinkError>, D> {
        Through::new(self.source, move |step: &Step<'_, D>, take: &mut Take<'_, D>| {
            let (displacement, acceleration) = (change(step.displacement), step.acceleration.map(&change));
            take(&Step { displacement: &displacement, acceleration: acceleration.as_deref(), ..*step })
        })
    }
}
