//! The warnings of a result.

use super::symptoms::symptoms;
use super::warnings::{Facts, Warning, last_instant, not_admissible, reoriented, resampled, samples, shifted};

/// What only the results of a run show.
pub(super) fn found(facts: &Facts<'_>) -> Vec<Warning> {
    let accepted = facts.checked.is_some_and(|checked| checked.contradiction.is_some());
    let mut found = [not_admissible(facts), last_instant(facts), samples(facts), shifted(facts)].to_vec();
    found.extend(symptoms(facts).map(|symptom| Some(symptom.warning(accepted))));
    found.extend([resampled(facts), reoriented(facts)]);
    found.into_iter().flatten().collect()
}
