//! The estimate at surfaces that slide along each other.

use percute_core::contact::Interface;
use percute_core::problem::Problem;
use percute_estimator::SurfaceEstimate;
use serde::Serialize;

/// Two surfaces that slide along each other, by the groups of their interface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlidingReport {
    /// The groups of edges of both bodies.
    pub groups: [String; 2],
    /// What the estimate says of them.
    #[serde(flatten)]
    pub estimate: SurfaceEstimate,
}

impl SlidingReport {
    /// All of a run, in the order of the interfaces.
    #[must_use]
    pub fn all<const D: usize, const N: usize>(problem: &Problem<D, N>, estimates: &[SurfaceEstimate]) -> Vec<Self> {
        let sides = problem.obstacles().iter().filter(|obstacle| obstacle.as_plane().is_none());
        let indices = sides.step_by(2).map(|side| side.sliding());
        let interfaces = problem.statement().interfaces.iter().zip(indices);
        let of = |(interface, index): (&Interface, Option<usize>)| {
            let groups = interface.groups().map(str::to_string);
            Some(Self { groups, estimate: *estimates.get(index?)? })
        };
        interfaces.filter_map(of).collect()
    }
}
