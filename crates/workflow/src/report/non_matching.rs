//! Contact and estimate at non-matching interfaces.

use percute_core::contact::{Frame, Interface};
use percute_core::contact_results::{ContactResults, Resultant};
use percute_core::problem::AnyProblem;
use percute_core::ratio;
use percute_estimator::SurfaceEstimate;
use serde::Serialize;

/// A non-matching interface, by the groups of its edges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NonMatchingReport {
    /// The groups of edges of both bodies.
    pub groups: [String; 2],
    /// The largest couple of the normal forces on both bodies, over the largest of these forces (m).
    pub couple: f64,
    /// What the estimate says of them.
    #[serde(flatten)]
    pub estimate: SurfaceEstimate,
}

impl NonMatchingReport {
    /// All of a run, in the order of the interfaces.
    #[must_use]
    pub fn all(problem: &AnyProblem, contact: &ContactResults, estimates: &[SurfaceEstimate]) -> Vec<Self> {
        let interfaces = problem.conditions().interfaces.iter().zip(problem.sides_of_interfaces());
        let of = |(interface, sides): (&Interface, [usize; 2])| {
            let first = problem.obstacle(sides[0]);
            let estimate = *estimates.get(first.non_matching()?)?;
            let couple = couple(&first.frame(), sides.map(|side| &contact.obstacles[side][..]));
            Some(Self { groups: interface.groups().map(str::to_string), couple, estimate })
        };
        interfaces.filter_map(of).collect()
    }
}

/// The largest couple of the normal forces of two sides, over the largest force (m).
fn couple(frame: &Frame<3>, [own, other]: [&[Resultant]; 2]) -> f64 {
    let (mut couple, mut force) = (0.0_f64, 0.0_f64);
    for (own, other) in own.iter().zip(other) {
        let (Some(here), Some(there)) = (own.centre, other.centre) else { continue };
        let (_, apart) = frame.split(&std::array::from_fn(|c| here[c] - there[c]));
        couple = couple.max(own.normal_force * apart.iter().map(|x| x * x).sum::<f64>().sqrt());
        force = force.max(own.normal_force);
    }
    ratio(couple, force)
}
