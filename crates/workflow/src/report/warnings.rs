//! What the user should look at before trusting a result.

use super::flat::FlatElements;
use super::linearity::Linearity;
use super::narrow::NarrowContact;
use super::{LargestResidual, ProblemSummary};
use crate::flight::NextTouch;
use crate::foreign::{Checked, Samples};
use crate::message::{counted, percent, short, trimmed};
use percute_core::mesh::{ImportWarning, Mesh};
use percute_core::problem::PlausibilityWarning;
use percute_estimator::{Reconstruction, Sampling};
use serde::Serialize;

/// Resampling of tables below this is rounding.
const RESAMPLED: f64 = 1e-12;

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// Its name, for programs.
    pub name: &'static str,
    /// A few words, for the summary.
    #[serde(skip)]
    pub brief: String,
    /// What is the matter and what to do.
    pub message: String,
}

/// What the warnings look at.
pub(super) struct WarningFacts<'a> {
    pub(super) checked: Option<&'a Checked>,
    pub(super) problem: &'a ProblemSummary,
    pub(super) plausibility_warnings: &'a [PlausibilityWarning],
    pub(super) drift: f64,
    /// Work of contact without friction, over the larger of the first and the last energy.
    pub(super) contact_energy: f64,
    /// The largest relative error and the mean.
    pub(super) published_relative: [f64; 2],
    /// Whether the steps have different lengths.
    pub(super) steps_vary: bool,
    pub(super) interrupted: bool,
    pub(super) reconstruction: Reconstruction,
    pub(super) impulse_ratio: Option<f64>,
    /// Whether a contact force acts at any instant.
    pub(super) touches: bool,
    pub(super) isolated_contact_nodes: usize,
    /// Energy that contact gives to the auxiliary solution, over that of the simulation.
    pub(super) auxiliary_contact_energy: f64,
    /// The first point that would reach a plane again, if the run went on.
    pub(super) touches_again: Option<NextTouch>,
    /// A contact that is narrower than the elements there.
    pub(super) narrow: Option<NarrowContact>,
    /// The farthest that pairs of nodes slip, over their shortest edge.
    pub(super) slip: f64,
    /// The deepest that a node of non-matching interfaces was inside the other body, over its shortest edge.
    pub(super) penetration: f64,
    /// The largest angle of surfaces in contact to their common normal (degrees).
    pub(super) inclination: f64,
    pub(super) linearity: &'a Linearity,
    pub(super) residual: &'a LargestResidual,
    pub(super) flat: Option<&'a FlatElements>,
    /// Δt_c (s).
    pub(super) critical_step: f64,
}

impl Warning {
    /// Whether it concerns the result, rather than the input or how it was taken.
    #[must_use]
    pub fn doubts_result(&self) -> bool {
        [
            "not_admissible",
            "shifted_forces",
            "energy_drift",
            "contact_energy",
            "auxiliary_contact_energy",
            "relative_error",
            "flat_elements",
            "impulse_ratio",
            "no_contact",
            "slip",
            "penetration",
            "inclined_surfaces",
            "large_strain",
            "rotation",
        ]
        .contains(&self.name)
    }
}

impl From<&PlausibilityWarning> for Warning {
    fn from(plausibility_warning: &PlausibilityWarning) -> Self {
        Self {
            name: plausibility_warning.name,
            brief: plausibility_warning.brief.clone(),
            message: plausibility_warning.to_string(),
        }
    }
}

fn warning(name: &'static str, brief: impl Into<String>, message: impl Into<String>) -> Option<Warning> {
    Some(Warning { name, brief: brief.into(), message: message.into() })
}

pub(super) fn not_admissible(facts: &WarningFacts<'_>) -> Option<Warning> {
    let LargestResidual { name, value, admissible } = facts.residual;
    if *admissible {
        return None;
    }
    let message = format!(
        "the residual `{name}` is {}: above {:.0e} a field is not admissible, and the error measure is not valid",
        short(*value, 2),
        super::ADMISSIBLE
    );
    warning("not_admissible", format!("residual {name} too large: do not trust the error"), message)
}

pub(super) fn narrow_contact(facts: &WarningFacts<'_>) -> Option<Warning> {
    let NarrowContact { half_width, edge, needed } = facts.narrow?;
    let [half_width, edge, needed] = [half_width, edge, needed].map(|x| short(x, 2));
    let message = format!(
        "the contact is narrower than an element: its half-width is about {half_width} m by Hertz at the averaged peak \
         force, and the edges there are {edge} m long. Pressure and stress there are those of a single node; edges of \
         {needed} m would resolve them"
    );
    warning(
        "narrow_contact",
        format!("contact narrower than an element: edges of {needed} m would resolve it"),
        message,
    )
}

pub(super) fn touches_again(facts: &WarningFacts<'_>) -> Option<Warning> {
    let NextTouch { node, plane, time } = facts.touches_again?;
    let time = trimmed(time, 4);
    let brief = format!("node {node} would reach plane_{plane} at {time} s");
    let remedy = match (facts.linearity.finite, facts.linearity.plastic) {
        (true, _) => "a later end shows it",
        (false, true) => "a run in small strains moves points along straight lines: for what follows, begin a new run",
        (false, false) => {
            "a run in small strains moves points along straight lines: for what follows, begin a new run there, or \
             take kinematics = \"finite\" and a later end"
        }
    };
    let message = format!(
        "the body turns after its last contact, and as a rigid body its {brief}: velocities and restitution are those \
         of the impact until the end of the run, not of all of it; {remedy}"
    );
    warning("touches_again", brief, message)
}

pub(super) fn last_instant(facts: &WarningFacts<'_>) -> Option<Warning> {
    let message = left_out(facts.checked?.left_out?);
    warning("last_instant", "the last instant of the history is left out", message)
}

pub(super) fn samples(facts: &WarningFacts<'_>) -> Option<Warning> {
    let samples = facts.checked?.samples?;
    warning(
        "samples",
        format!("samples {} critical steps apart", trimmed(samples.critical_steps, 4)),
        sampled(&samples),
    )
}

pub(super) fn shifted(facts: &WarningFacts<'_>) -> Option<Warning> {
    let cause = facts.checked?.shifted.as_ref()?;
    let message = format!(
        "the balance of the history is within its limit, but {cause}; the estimate counts this shift as an error of \
         the simulation"
    );
    warning("shifted_forces", "contact forces of another step fit better", message)
}

/// The limits of an estimate from samples.
fn sampled(samples: &Samples) -> String {
    let Samples { count, distance, critical_steps } = *samples;
    let (samples, distance, critical_steps) =
        (counted(count, "sample"), trimmed(distance, 4), trimmed(critical_steps, 4));
    format!(
        "the history has {samples}, {critical_steps} critical steps apart; the motion between them is interpolated, \
         and contact forces are derived from it: changes within {distance} s are not seen, and beyond some 4 critical \
         steps the estimate is too large"
    )
}

/// The reason why the last instant (s) of a history is left out.
pub fn left_out(time: f64) -> String {
    let time = trimmed(time, 5);
    format!(
        "the last instant, {time} s, is left out: the contact forces there are not known, since they determine the \
         displacement one step later; give one instant more, or the accelerations"
    )
}

pub(super) fn resampled(facts: &WarningFacts<'_>) -> Option<Warning> {
    let error = facts.problem.resampling_error;
    if error <= RESAMPLED {
        return None;
    }
    let error = percent(error);
    let message = format!(
        "tables in time are interpolated linearly between the steps: they differ from the given tables by up to {error}"
    );
    warning("resampled", format!("tables in time differ by up to {error} between steps"), message)
}

pub(super) fn reoriented(facts: &WarningFacts<'_>) -> Option<Warning> {
    let count = facts.problem.reoriented_elements;
    let elements = counted(count, "element");
    let were = if count == 1 { "was" } else { "were" };
    let message = format!("{elements} {were} given clockwise (a bar: backwards) and reoriented");
    if count == 0 { None } else { warning("reoriented_elements", format!("{elements} reoriented"), message) }
}

/// An error that is sampled at the start and at the end only; told before the run, too.
pub(crate) fn few_samples(every: Sampling, steps: usize) -> Option<Warning> {
    let Sampling::Every(every) = every else { return None };
    if every <= 1 || every < steps {
        return None;
    }
    let message = format!(
        "is {every}, but the run has {}: the error is sampled at its start and its end only; give a smaller number",
        counted(steps, "step")
    );
    Some(Warning { name: "few_samples", brief: "the error is sampled twice".to_string(), message })
}

/// What was reported when the mesh was read.
pub fn reported(mesh: &Mesh) -> impl Iterator<Item = Warning> {
    mesh.import_warnings().iter().map(|ImportWarning { name, brief, message, .. }| {
        let (brief, message) = (brief.clone(), message.clone());
        Warning { name, brief, message }
    })
}
