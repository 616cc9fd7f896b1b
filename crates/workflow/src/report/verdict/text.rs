//! The sentences of a verdict.

use super::Shares;
use super::facts::{Expected, Facts};
use super::rules::{self, Rule};
use crate::foreign::Contradiction;
use crate::message::{change, percent, short, trimmed, whole_percent};
use crate::plan::Branch;
use crate::report::flat;
use crate::report::margin::ElasticMargin;
use crate::report::poor::PoorElement;
use crate::report::symptoms::{AUXILIARY_CONTACT_ENERGY, CONTACT_ENERGY, DRIFT, IMPULSE_RATIO};
use crate::report::touches::Touches;
use percute_core::contact_results::Nearest;

/// A mean error above this has as much energy as the deformation and the vibration together.
const AS_VIBRATION: f64 = 1.0;
/// A published relative error above this is as large as the solution: it cannot exceed 1/√2 by much.
const AS_LARGE: f64 = 0.5;
/// Less of the squared error is not told.
const LEAST: f64 = 5e-3;
/// An expected change of the mean error below this is not worth a run.
const WORTH: f64 = -0.1;
/// From this factor of the cost on, half the error is out of reach.
const FAR: f64 = 100.0;

/// The reasons not to trust the estimate, beside strains and rotations that are not small.
pub(super) fn reasons(facts: &Facts, rule: &Rule) -> Vec<String> {
    let mut reasons = Vec::new();
    let kept = facts.impulse_ratio.unwrap_or(1.0);
    if !facts.admissible {
        reasons.push("a residual shows that the fields are not admissible".to_string());
    }
    reasons.extend(facts.inconsistent.iter().map(|Contradiction { figure, cause, .. }| {
        let cause = cause.as_ref().map_or(String::new(), |cause| format!(" (likely cause: {cause})"));
        format!("the history is not consistent: {figure}{cause}")
    }));
    // A drift that is no number must not pass.
    if facts.energy_drift.is_nan() || facts.energy_drift > DRIFT {
        reasons.push(format!("the energy balance is off by {}", whole_percent(facts.energy_drift)));
    }
    if facts.contact_energy > CONTACT_ENERGY {
        reasons.push(format!("contact forces give the bodies {} of their energy", whole_percent(facts.contact_energy)));
    }
    let given = facts.auxiliary_contact_energy;
    if given > AUXILIARY_CONTACT_ENERGY {
        let given = whole_percent(given);
        let result = match facts.linearity.yielded {
            Some(_) => "which yields otherwise than the simulation",
            None => "and the estimate is probably too large",
        };
        reasons.push(format!("contact gives the auxiliary solution {given} of the energy, {result}"));
    }
    // Beside a fast common motion, the second is small however large the error is.
    if facts.error.relative_mean > AS_VIBRATION || facts.error.published_relative_mean > AS_LARGE {
        reasons.push("the error is as large as the solution".to_string());
    }
    if !(IMPULSE_RATIO[0]..=IMPULSE_RATIO[1]).contains(&kept) {
        reasons.push(format!("the admissible force has {} of the contact impulse", whole_percent(kept)));
    }
    if facts.slip > 1.0 {
        reasons.push(format!("node pairs are up to {} edges apart along the interface", short(facts.slip, 2)));
    }
    if facts.acts_late() {
        reasons.push(
            "a corner or a curve penetrates the struck edges before their mean gap closes, and its tractions are as \
             wide as these edges; refine that surface"
                .to_string(),
        );
    }
    reasons.extend(rule.reason.map(str::to_string));
    reasons
}

/// The sentences: that nothing touched, situation, place, recommendation, elements to repair, stress, margin to
/// yielding.
pub(super) fn sentences(
    facts: &Facts,
    rule: &Rule,
    outside_tested_range: &[String],
    reasons: &[String],
    shares: Shares,
) -> Vec<String> {
    if facts.is_exact() && reasons.is_empty() {
        let exact = "Nothing deforms: the error is zero to rounding.".to_string();
        return nothing_touched(facts).into_iter().chain([exact]).collect();
    }
    let usual = [situation(facts, rule, outside_tested_range), place(facts, shares), recommendation(facts, reasons)];
    let margin = facts.margin.as_ref().map(ElasticMargin::sentence);
    let beside = [repair(&facts.poor), facts.linearity.stress.clone(), margin];
    nothing_touched(facts).into_iter().chain(usual).chain(beside.into_iter().flatten()).collect()
}

/// That nothing touched although it could, with the gap that is left.
fn nothing_touched(facts: &Facts) -> Option<String> {
    let (Nearest { gap, touch, .. }, end) = facts.nearest?;
    let (gap, end) = (short(gap, 3), trimmed(end, 4));
    let when = match touch {
        Some(touch) => format!("a gap would first close at {} s at the present speed", trimmed(touch, 4)),
        None => "no node approaches".to_string(),
    };
    Some(format!("Nothing touched: at the end, at {end} s, the least gap is {gap} m, and {when}."))
}

/// The elements to repair.
fn repair(poor: &[PoorElement]) -> Option<String> {
    let each = |one: &PoorElement| {
        let angle = match one.largest_angle > flat::ANGLE {
            true => format!("an angle of {}°", trimmed(one.largest_angle, 4)),
            false => format!("an angle of {}°, edges 1 to {}", trimmed(one.smallest_angle, 2), short(one.aspect, 2)),
        };
        let place = one.centroid.iter().map(|&x| short(x, 3)).collect::<Vec<_>>().join(", ");
        format!("{} ({angle}, at ({place}) m, {})", one.element, whole_percent(one.share))
    };
    let named = poor.iter().map(each).collect::<Vec<_>>().join(", ");
    let told = || format!("Repair first, each with its part of the squared mean error: element {named}.");
    (!poor.is_empty()).then(told)
}

fn situation(facts: &Facts, rule: &Rule, outside_tested_range: &[String]) -> String {
    let touches = match facts.contact.touches {
        Touches::Face => "A flat side touches",
        Touches::Edge if facts.dimension == 1 => "An end of the bar touches",
        Touches::Edge => "An edge touches",
        Touches::End if facts.slides => "A part of an edge touches",
        Touches::End => "An edge beside an inclined side touches",
        Touches::Curve => "A curve touches",
        Touches::Corner => "A corner touches",
        Touches::None => "Nothing touches",
    };
    let speed = facts.speed_ratio.filter(|ratio| *ratio > 0.0);
    let speed = speed.map_or_else(String::new, |ratio| format!(" at {} of the wave speed", short(ratio, 2)));
    let outside = rules::outside(facts);
    let range = match (outside, rule.range) {
        (Some(property), _) => format!("no range of estimate over true error is known for {property}"),
        (None, [least, most]) => {
            format!("in tests of {} the estimate was {least} to {most} times the true error", rule.situation)
        }
    };
    let outside_tested_range: Vec<&str> =
        outside_tested_range.iter().map(String::as_str).filter(|one| Some(*one) != outside).collect();
    let missing = if outside_tested_range.is_empty() {
        String::new()
    } else {
        format!("; outside the tested range: {}", outside_tested_range.join(", "))
    };
    let near = facts.linearity.departures().into_iter().filter(|departure| !departure.is_far);
    let not_small = near.map(|departure| departure.named).collect::<Vec<_>>().join(", ");
    let not_small = if not_small.is_empty() { not_small } else { format!("; not small: {not_small}") };
    format!("{touches}{speed}, with steps of {} Δt_c: {range}{missing}{not_small}.", short(facts.courant, 2))
}

fn place(facts: &Facts, shares: Shares) -> String {
    let [contact, kinetic, elastic] = [shares.contact, shares.kinetic, shares.elastic].map(whole_percent);
    let elastic = match shares.dissipation {
        0.0 => format!("{elastic} elastic"),
        dissipation => format!("{elastic} elastic, {} dissipation", whole_percent(dissipation)),
    };
    if facts.contact.touches == Touches::None {
        // Contact forces that only pull.
        let contact = if shares.contact < LEAST { String::new() } else { format!("{contact} contact, ") };
        return format!("The squared largest error is {contact}{kinetic} kinetic, {elastic}.");
    }
    let near = whole_percent(facts.at_contact);
    format!(
        "{near} of the squared mean error lies in elements at the contact; the squared largest error is {contact} \
         contact, {kinetic} kinetic, {elastic}."
    )
}

fn recommendation(facts: &Facts, reasons: &[String]) -> String {
    if !reasons.is_empty() {
        return format!("Do not trust the number: {}.", reasons.join("; "));
    }
    if facts.flat {
        return "Improve the nearly flat elements, or mesh again.".to_string();
    }
    let cut = match facts.contact.single_element {
        true if facts.contact.touches != Touches::None => "Split the element in the corner into two elements. ",
        _ => "",
    };
    let Some(expected) = facts.expected else {
        let round = match facts.flows_at_corner {
            true => ", but round the sharp corner: the plastic strain there grows with each refinement",
            false => "",
        };
        return format!("{cut}Refine the mesh for a smaller error{round}.");
    };
    let steps = if expected.halved_step < WORTH {
        "halving the step alone would change it by about"
    } else {
        "shorter steps alone do not help:"
    };
    let (way, step) = (way(&expected, facts.error.relative_mean), change(expected.halved_step));
    format!("{cut}{way}; {steps} {step}.")
}

/// The refinement for half the mean error.
fn way(expected: &Expected, error: f64) -> String {
    let (half, recommendation) = (percent(0.5 * error), &expected.recommendation);
    let times = |factor: Option<f64>| factor.map_or_else(|| "many".to_string(), |factor| short(factor, 2));
    let (finer, cost) = (times(recommendation.finer), times(recommendation.cost));
    let far = recommendation.cost.is_some_and(|cost| cost > FAR);
    let about = recommendation.cost.map_or_else(String::new, |_| format!(" at about {cost} times the cost"));
    match recommendation.branch {
        Branch::Uniform if far => {
            let cause = match expected.front {
                true => "the front is discontinuous",
                false => "waves of the length of an element have a wrong speed on any mesh",
            };
            format!(
                "A mean of {half} is out of reach: elements {finer} times smaller, {cost} times the cost, because \
                 {cause}"
            )
        }
        Branch::Uniform => {
            format!("Refine the whole mesh: elements {finer} times smaller for a mean of {half},{about}")
        }
        Branch::Graded => {
            format!("Grade the mesh towards the contact: a mean of {half}{about}, by `percute adapt`")
        }
        Branch::Map => format!("Refine the mesh where the error is: a mean of {half}{about}, by `percute adapt`"),
    }
}
