//! Figures of a motion that are outside of their range: reasons not to trust the result.

use super::flat::FlatElements;
use super::linearity::{Linearity, STRAIN, Turned, growth};
use super::warnings::{Warning, WarningFacts};
use crate::deformation::Extreme;
use crate::foreign::{Checked, by_a_penalty};
use crate::message::{percent, short, signed_percent, trimmed};
use percute_estimator::{Estimate, Reconstruction};

/// Energy that appears or goes by more than this, relatively, is a warning.
pub(crate) const DRIFT: f64 = 0.1;
/// Contact that gives more than this part of the energy is a warning. In the examples, from bars to blocks that slide,
/// contact takes 0.07 to 13 % of the energy, friction apart.
pub(crate) const CONTACT_ENERGY: f64 = 0.01;
/// Contact that gives the auxiliary solution more than this part of the energy is a warning.
pub(crate) const AUXILIARY_CONTACT_ENERGY: f64 = 0.1;
/// A relative error above this is a warning. η is half the squared norm of the difference of two fields, and d the sum
/// of their squared norms: e/D is 1/√2 where they are orthogonal.
const NEAR_CEILING: f64 = 0.6;
/// So is a contact impulse of which less than the one or more than the other is kept.
pub(crate) const IMPULSE_RATIO: [f64; 2] = [0.9, 1.1];
/// Pairs of nodes that slip by more edges leave the range of the method.
pub(crate) const SLIP: f64 = 0.1;
/// Nodes of non-matching interfaces that are deeper in the other body, over their edge, are outside of the evidence:
/// there, up to 200 m/s, corners and curves are at most 0.021 of it inside.
pub(crate) const PENETRATION: f64 = 0.05;
/// Surfaces in contact with a larger common inclination (degrees) face each other along another direction than their
/// normal. Between chevrons of aluminium of 5, 15 and 30°, without friction, the motion differs by 2, 9 and 24 % from
/// that with a contact for each slope.
pub(crate) const INCLINATION: f64 = 10.0;
/// The remedy for all figures of a history that contradicts itself or its problem.
const INCONSISTENT: &str = "the history is not consistent: correct it first";
/// A gain of the time step by more than this is told.
const LONGER: f64 = 1.1;

/// A figure of the motion that is outside of its range.
#[derive(Debug, PartialEq)]
pub(super) struct Symptom {
    name: &'static str,
    brief: String,
    figure: String,
    /// The remedy for a simulation.
    remedy: String,
}

impl Symptom {
    /// A history that is `accepted` although it is not consistent needs another remedy than a simulation.
    pub(super) fn warning(self, accepted: bool) -> Warning {
        let Self { name, brief, figure, remedy } = self;
        let remedy = if accepted { INCONSISTENT } else { &remedy };
        Warning { name, brief, message: format!("{figure}; {remedy}") }
    }
}

fn symptom(
    name: &'static str,
    brief: impl Into<String>,
    figure: impl Into<String>,
    remedy: impl Into<String>,
) -> Option<Symptom> {
    Some(Symptom { name, brief: brief.into(), figure: figure.into(), remedy: remedy.into() })
}

/// Those of a result.
pub(super) fn symptoms(facts: &WarningFacts<'_>) -> impl Iterator<Item = Symptom> {
    let all = [
        drift(facts.drift, facts.steps_vary),
        given(facts.contact_energy),
        given_to_auxiliary(facts.auxiliary_contact_energy, facts.linearity.yielded.is_some()),
        relative_error(facts.published_relative),
        flat_elements(facts),
        impulse_ratio(facts),
        no_contact(facts),
        slipped(facts.slip),
        penetrating(facts.penetration),
        inclined(facts.inclination),
        strained(facts.linearity),
        turned(facts.linearity),
    ];
    all.into_iter().flatten()
}

/// A warning of the energy balance of a simulation that is off.
#[must_use]
pub fn drifted(energy_drift: f64, steps_vary: bool) -> Option<Warning> {
    drift(energy_drift, steps_vary).map(|symptom| symptom.warning(false))
}

fn drift(drift: f64, steps_vary: bool) -> Option<Symptom> {
    // A drift that is no number must not pass.
    if drift <= DRIFT {
        return None;
    }
    let drift = percent(drift);
    let remedy = match steps_vary {
        true => "take equal time steps, since changes of the step amplify vibrations, or refine the mesh",
        false => "reduce the time step or refine the mesh",
    };
    let figure = format!("the energy balance is off by {drift} of the largest energy");
    symptom("energy_drift", format!("energy balance off by {drift}"), figure, remedy)
}

/// Contact forces that give energy.
fn given(part: f64) -> Option<Symptom> {
    if part <= CONTACT_ENERGY {
        return None;
    }
    let shown = percent(part);
    let figure = format!("contact forces give the bodies {shown} of their energy, which no contact can do");
    let remedy = "refine the surfaces where they touch, where they are curved and where one ends on the other, or name \
                  groups of edges that face each other, each in a contact of its own";
    symptom("contact_energy", format!("contact gives {shown} of the energy"), figure, remedy)
}

/// The part of the energy that contact gives the auxiliary solution. The springs of a penalty give back energy: 0.
pub(super) fn auxiliary_contact_energy(estimate: &Estimate, checked: Option<&Checked>) -> f64 {
    let springs = checked.is_some_and(|checked| by_a_penalty(&checked.consistency));
    if springs { 0.0 } else { estimate.auxiliary_contact_energy }
}

/// Contact forces that give energy to the auxiliary solution alone. Where a body yields, a force of the simulation acts
/// on an auxiliary solution with other plastic strains: on discs, halving the step changes the part by 0.01 at most,
/// and half as large elements have a half to all of it (docs/plasticity.md).
fn given_to_auxiliary(part: f64, yields: bool) -> Option<Symptom> {
    if part <= AUXILIARY_CONTACT_ENERGY {
        return None;
    }
    let shown = percent(part);
    let [result, remedy] = match yields {
        true => [
            "the auxiliary solution yields otherwise than the simulation",
            "compare with smaller elements at the contact; shorter steps do not help",
        ],
        false => [
            "the estimate is probably too large",
            "halve the time step, or make elements at the contact more alike in size",
        ],
    };
    let figure =
        format!("contact gives the auxiliary solution {shown} of the energy, which no contact can do: {result}");
    symptom(
        "auxiliary_contact_energy",
        format!("contact gives the auxiliary solution {shown} of the energy"),
        figure,
        remedy,
    )
}

/// A relative error that says no more than that it is large.
fn relative_error(relative: [f64; 2]) -> Option<Symptom> {
    let largest = relative[0].max(relative[1]);
    if largest <= NEAR_CEILING {
        return None;
    }
    let shown = percent(largest);
    let figure = format!("the relative error [22] is {shown}: unrelated fields have 70.7 % (1/√2), for any true error");
    let remedy = "refine the mesh, and look for elements that are nearly flat";
    symptom("relative_error", format!("relative error [22] {shown}, near its ceiling of 71 %"), figure, remedy)
}

fn flat_elements(facts: &WarningFacts<'_>) -> Option<Symptom> {
    let FlatElements { count, flattest, share, step_without } = facts.flat?;
    let each = |&(element, angle, own): &(usize, f64, f64)| {
        format!("element {element} ({}°, {})", trimmed(angle, 4), percent(own))
    };
    let named = flattest.iter().map(each).collect::<Vec<_>>().join(", ");
    let more = if *count > flattest.len() { format!(" and {} more", count - flattest.len()) } else { String::new() };
    let (share, longer) = (percent(*share), step_without / facts.critical_step);
    let step = match longer > LONGER {
        true => format!("; without them, steps could be {} times as long", short(longer, 2)),
        false => String::new(),
    };
    let figure = format!(
        "the mesh has elements that are nearly flat, with an angle above 150°: {named}{more}. They and the elements \
         around them have {share} of the squared mean error, and in tests the estimate was then up to 5.6 times the \
         true error{step}"
    );
    let remedy = "move their nodes, or mesh again";
    symptom("flat_elements", format!("nearly flat elements have {share} of the estimate"), figure, remedy)
}

fn impulse_ratio(facts: &WarningFacts<'_>) -> Option<Symptom> {
    let [least, most] = IMPULSE_RATIO;
    // An isolated contact node touches at other instants in the admissible fields than in the simulation.
    let kept =
        facts.impulse_ratio.filter(|kept| facts.isolated_contact_nodes == 0 && !(least..=most).contains(kept))?;
    let shown = percent(kept);
    let advice = match facts.reconstruction {
        // It drops nothing, but what stops a node goes on for a few steps, and what no contact force can be is cut off.
        Reconstruction::Corrected if kept < 1.0 => "the run ends during the onset of contact: use a later end",
        Reconstruction::Corrected => {
            "reactions of the history are tensile or outside Coulomb's cone: is `friction` that of the simulation?"
        }
        Reconstruction::Consistent | Reconstruction::Published => {
            "refine the mesh or the steps where contact begins, or take `reconstruction = \"corrected\"`"
        }
    };
    if kept > most {
        let figure = format!(
            "the admissible contact force has {shown} of the simulated impulse, and above 110 % it is not the force of \
             the simulation"
        );
        let brief = format!("{shown} of the contact impulse in the admissible force");
        return symptom("impulse_ratio", brief, figure, advice);
    }
    let figure = format!(
        "the admissible contact force keeps {shown} of the simulated impulse, and below 90 % the estimate is \
         pessimistic"
    );
    symptom("impulse_ratio", format!("only {shown} of the contact impulse in the admissible force"), figure, advice)
}

fn no_contact(facts: &WarningFacts<'_>) -> Option<Symptom> {
    let foreseen =
        facts.plausibility_warnings.iter().any(|plausibility_warning| plausibility_warning.name == "never_touches");
    if facts.problem.obstacles.is_empty() || facts.touches || foreseen {
        return None;
    }
    let when = if facts.interrupted { "before it was interrupted" } else { "before `end`" };
    let figure = format!("no contact force acted {when}");
    let end = if facts.checked.is_some() { "the end of the history" } else { "`[time] end`" };
    let remedy = format!("check the gap, the velocity and {end}");
    symptom("no_contact", format!("no contact {when}"), figure, remedy)
}

/// Pairs of nodes that are no longer opposite each other.
fn slipped(slip: f64) -> Option<Symptom> {
    if slip <= SLIP {
        return None;
    }
    let edges = short(slip, 2);
    let figure = format!(
        "node pairs of two bodies slip by up to {edges} edges, but remain pairs; above {SLIP} the forces act at \
         displaced points, and at one edge the true error is 5 % larger"
    );
    let remedy = "use longer edges there, or an earlier end";
    symptom("slip", format!("node pairs slip by {edges} edges"), figure, remedy)
}

/// Nodes inside the other body, of which only mean gaps are known.
fn penetrating(penetration: f64) -> Option<Symptom> {
    if penetration <= PENETRATION {
        return None;
    }
    let edges = short(penetration, 2);
    let figure = format!(
        "a node of a non-matching interface was up to {edges} of its edge inside the other body: its gap is a mean \
         over edges, and its contact force is missing or acts too late"
    );
    let brief = format!("a node was {edges} of its edge inside the other body");
    symptom("penetration", brief, figure, "use shorter edges on both surfaces")
}

/// Surfaces whose common normal is that of neither.
fn inclined(inclination: f64) -> Option<Symptom> {
    if inclination <= INCLINATION {
        return None;
    }
    let angle = short(inclination, 2);
    let figure = format!(
        "surfaces in contact are inclined by up to {angle}° to their common normal, along which all contact forces act"
    );
    let remedy = "define a contact by `groups` of the edges around the point of contact, or one contact for each slope \
                  of a ridge, without the edges at the ridge";
    symptom("inclined_surfaces", format!("surfaces inclined by {angle}° to their common normal"), figure, remedy)
}

/// Strains that are not small.
fn strained(linearity: &Linearity) -> Option<Symptom> {
    let Extreme { value, element, time, .. } = linearity.strain;
    if !linearity.is_strained(0) {
        return None;
    }
    let (signed, shown, time) = (signed_percent(value), percent(value.abs()), trimmed(time, 4));
    let figure = format!(
        "element {element} has a principal strain of {signed} at {time} s, but strains are small by assumption, \
         up to {}: the error measure does not contain what the linear theory neglects",
        percent(STRAIN[0])
    );
    let remedy = match linearity.plastic {
        true => "take a lower speed or load, or a material that yields later: plasticity is for small strains",
        false => "take kinematics = \"finite\", a lower speed or load, or a stiffer material",
    };
    symptom("large_strain", format!("strains of up to {shown}: not small"), figure, remedy)
}

/// A body that turns farther than small rotations.
fn turned(linearity: &Linearity) -> Option<Symptom> {
    let Turned { subject, angle, time, strain } = linearity.turned.as_ref()?;
    let (shown, time, grown) = (short(*angle, 2), trimmed(*time, 4), short(growth(*angle), 2));
    // More is the strain of rounding.
    let beside = match growth(*angle) < 1e3 * strain {
        true => format!("{} times its largest strain", short(growth(*angle) / strain, 2)),
        false => "and it is hardly strained".to_string(),
    };
    let figure = format!(
        "{subject} turns by {shown} rad by {time} s, but rotations are small by assumption: its nodes move along \
         straight lines, which makes it larger by a part of {grown} ({beside}), and no part of the error measure \
         contains this"
    );
    let brief = format!("{subject} turns by {shown} rad: too far for small rotations");
    let remedy = match linearity.plastic {
        true => "take an earlier end, or a start closer to contact: plasticity is for small rotations",
        false => "take kinematics = \"finite\", an earlier end, or a start closer to contact",
    };
    symptom("rotation", brief, figure, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_near_the_ceiling_and_drifts_are_told() {
        assert_eq!(relative_error([0.6, 0.5]), None);
        let error = || relative_error([0.1, 0.61]).expect("near its ceiling");
        let told = error().warning(false);
        assert!(told.message.contains("61") && told.message.contains("refine the mesh") && told.doubts_result());
        let told = error().warning(true);
        assert!(told.message.contains("61") && !told.message.contains("refine"));
        assert!(told.message.ends_with("correct it first"));
        let remedies = [false, true].map(|yields| given_to_auxiliary(0.2, yields).expect("above a tenth").remedy);
        assert!(remedies[0].contains("halve the time step") && remedies[1].contains("shorter steps do not help"));
        assert_eq!(drifted(0.1, false), None);
        assert!(drifted(f64::NAN, false).is_some_and(|told| told.message.contains("reduce the time step")));
        assert!(drifted(0.86, true).is_some_and(|told| told.message.contains("take equal time steps")));
    }
}
