//! The initial state of the problem in the place of the first instant, where the two differ by less than the limits.

use super::limits::{BALANCE, PLACE};
use super::widest;
use crate::step_filter::{StepFilter, Take};
use percute_core::history::{Step, StepSource};
use percute_core::problem::AnyProblem;

/// A history that starts exactly as its problem states: what the limits of consistency let pass is within them.
pub(crate) fn started<'s>(problem: &'s AnyProblem, source: &'s dyn StepSource) -> impl StepSource + 's {
    StepFilter::new(source, move |step: &Step<'_>, take: &mut Take<'_>| {
        if step.index > 0 {
            return take(step);
        }
        let (displacement, velocity) = (problem.initial_displacement(), problem.initial_velocity());
        let moved = widest(step.displacement, displacement)[0];
        let near = moved <= PLACE * problem.mesh().size();
        let fastest = velocity.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let same = |given: &&[f64]| {
            let [difference, largest] = widest(given, velocity);
            difference <= BALANCE * largest.max(fastest)
        };
        let given = step.velocity.map(|given| if same(&given) { velocity } else { given });
        take(&Step { displacement: if near { displacement } else { step.displacement }, velocity: given, ..*step })
    })
}
