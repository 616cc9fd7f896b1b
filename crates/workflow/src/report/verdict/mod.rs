//! The verdict on an estimate: the situation of the run, the effectivity indices of such cases in the evidence, and one
//! recommendation, a sentence each.

mod facts;
mod onset;
mod rules;
mod tested_range;
mod text;
mod uneven;

pub(super) use facts::{Facts, FurtherFacts};

use super::{ElasticMargin, PoorElement, Touches};
use crate::plan::Recommendation;
use percute_estimator::Parts;
use rules::Rule;
use serde::Serialize;

/// How far the estimate can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Trust {
    /// The evidence has such cases, and the estimate is between 0.8 and 1.6 times the true error in all of them.
    High,
    /// The range is wider, a property of the run is not in the evidence, or strains or rotations are not small.
    Limited,
    /// There is a reason not to trust the number.
    Low,
}

impl std::fmt::Display for Trust {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::High => "high",
            Self::Limited => "limited",
            Self::Low => "low",
        })
    }
}

/// A range of effectivity indices outside which trust is limited.
const GOOD: [f64; 2] = [0.8, 1.6];

/// The verdict on an estimate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// How far the estimate can be trusted.
    pub trust: Trust,
    /// Sentences: first that nothing touched, if that is so; situation and effectivity index; place and parts of the
    /// error; recommendation; elements to repair; stress beyond the linear law; margin to yielding.
    pub text: Vec<String>,
    /// Smallest and largest effectivity index (estimate over true error, sup and mean) of such cases in the evidence;
    /// none where such cases are outside the range of all others.
    pub effectivity: Option<[f64; 2]>,
    /// How the body touches first.
    pub touches: Touches,
    /// Normal velocity of the centre of mass before contact over the wave speed; none without contact.
    pub speed_ratio: Option<f64>,
    /// The longest step over the critical one.
    pub courant: f64,
    /// Edges of elements on the plane at one instant, at most; 1 for a single node.
    pub elements_in_contact: usize,
    /// Number of contact phases.
    pub phases: usize,
    /// Number of separate parts of the surface that touch.
    pub zones: usize,
    /// Mean thickness of the body over its diagonal; 1 for a bar.
    pub slenderness: f64,
    /// Parts of η at its largest value, over η.
    pub shares: Shares,
    /// Part of the squared mean error in elements with a node that touches.
    pub at_contact: f64,
    /// Properties of the run that no case of the evidence has.
    pub outside_tested_range: Vec<String>,
    /// Reasons not to trust the estimate, beside strains and rotations that are not small.
    pub reasons: Vec<String>,
    /// Strains and rotations that are not small.
    pub not_small: Vec<String>,
    /// The refinement for half the error; none without sources, or where they do not separate.
    pub recommendation: Option<Recommendation>,
    /// How near the material is to yielding that has not yielded and is nearest; none without a yield stress.
    pub elastic_margin: Option<ElasticMargin>,
    /// The elements of bad shape with the largest parts of the squared mean error, if such elements matter.
    pub poor_elements: Vec<PoorElement>,
}

/// Parts of η at its largest value, over η, eq. \[14\].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shares {
    /// The contact part: misfit of the contact law.
    pub contact: f64,
    /// The kinetic part: misfit of the law of inertia.
    pub kinetic: f64,
    /// The elastic part: misfit of Hooke's law.
    pub elastic: f64,
    /// The plastic part: misfit of hardening and of dissipation; 0 where no material yields.
    pub dissipation: f64,
}

impl Verdict {
    /// The verdict that follows from facts and from the parts of η at its largest value.
    #[must_use]
    pub(super) fn new(facts: &Facts, parts: &Parts) -> Self {
        let rule = &rules::rule(facts);
        let (outside_tested_range, shares) = (tested_range::outside(facts), shares(parts));
        let (reasons, departures) = (text::reasons(facts, rule), facts.linearity.departures());
        let far = departures.iter().filter(|departure| departure.is_far).map(|departure| departure.reason.clone());
        let all: Vec<String> = reasons.iter().cloned().chain(far).collect();
        let not_small: Vec<String> = departures.into_iter().map(|departure| departure.named).collect();
        let trust = match () {
            () if !all.is_empty() => Trust::Low,
            () if !outside_tested_range.is_empty() || !not_small.is_empty() || !within(rule) => Trust::Limited,
            () => Trust::High,
        };
        Self {
            trust,
            text: text::sentences(facts, rule, &outside_tested_range, &all, shares),
            effectivity: rules::outside(facts).is_none().then_some(rule.range),
            touches: facts.contact.touches,
            speed_ratio: facts.speed_ratio,
            courant: facts.courant,
            elements_in_contact: facts.elements_in_contact,
            phases: facts.phases,
            zones: facts.contact.zones,
            slenderness: facts.slenderness,
            shares,
            at_contact: facts.at_contact,
            outside_tested_range,
            reasons,
            not_small,
            recommendation: facts.expected.map(|expected| expected.recommendation),
            elastic_margin: facts.margin.clone(),
            poor_elements: facts.poor.clone(),
        }
    }
}

fn within(rule: &Rule) -> bool {
    rule.range[0] >= GOOD[0] && rule.range[1] <= GOOD[1]
}

fn shares(parts: &Parts) -> Shares {
    let total = parts.total();
    let share = |part: f64| if total > 0.0 { part / total } else { 0.0 };
    Shares {
        contact: share(parts.contact),
        kinetic: share(parts.kinetic),
        elastic: share(parts.elastic),
        dissipation: share(parts.dissipation),
    }
}
