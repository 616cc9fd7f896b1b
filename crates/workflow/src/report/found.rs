//! The warnings of a result.

use super::symptoms::symptoms;
use super::warnings::{
    Warning, WarningFacts, last_instant, narrow_contact, not_admissible, reoriented, resampled, samples, shifted,
    touches_again,
};

/// What only the results of a run show.
pub(super) fn found(facts: &WarningFacts<'_>) -> Vec<Warning> {
    let accepted = facts.checked.is_some_and(|checked| checked.contradiction.is_some());
    let first = [not_admissible(facts), last_instant(facts), samples(facts), shifted(facts)];
    let of_motion = symptoms(facts).map(|symptom| symptom.warning(accepted));
    let last = [narrow_contact(facts), touches_again(facts), resampled(facts), reoriented(facts)];
    first.into_iter().flatten().chain(of_motion).chain(last.into_iter().flatten()).collect()
}
