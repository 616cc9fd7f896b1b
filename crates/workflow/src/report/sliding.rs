//! Contact and estimate at surfaces that slide along each other.

use percute_core::contact::{ContactResults, Frame, Interface, Obstacle, Resultant};
use percute_core::problem::Problem;
use percute_core::ratio;
use percute_estimator::SurfaceEstimate;
use serde::Serialize;

/// Two surfaces that slide along each other, by the groups of their interface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlidingReport {
    /// The groups of edges of both bodies.
    pub groups: [String; 2],
    /// The largest couple of the normal forces on both bodies, over the largest of these forces (m).
    pub couple: f64,
    /// What the estimate says of them.
    #[serde(flatten)]
    pub estimate: SurfaceEstimate,
}

/// One side of an interface, and the resultants of its forces at all instants.
type SideResults<'a, const D: usize> = (&'a Obstacle<D>, &'a Vec<Resultant<D>>);

impl SlidingReport {
    /// All of a run, in the order of the interfaces.
    #[must_use]
    pub fn all<const D: usize, const N: usize>(
        problem: &Problem<D, N>,
        contact: &ContactResults<D>,
        estimates: &[SurfaceEstimate],
    ) -> Vec<Self> {
        // Each interface has two obstacles, one for each side.
        let sides = problem.obstacles().iter().zip(&contact.obstacles).filter(|(side, _)| side.as_plane().is_none());
        let sides: Vec<SideResults<'_, D>> = sides.collect();
        let interfaces = problem.statement().interfaces.iter().zip(sides.chunks_exact(2));
        let of = |(interface, sides): (&Interface, &[SideResults<'_, D>])| {
            let estimate = *estimates.get(sides[0].0.sliding()?)?;
            let couple = couple(&sides[0].0.flat_frame(), [sides[0].1, sides[1].1]);
            Some(Self { groups: interface.groups().map(str::to_string), couple, estimate })
        };
        interfaces.filter_map(of).collect()
    }
}

/// The largest couple of the normal forces of two sides, over the largest force (m).
fn couple<const D: usize>(frame: &Frame<D>, [own, other]: [&[Resultant<D>]; 2]) -> f64 {
    let (mut couple, mut force) = (0.0_f64, 0.0_f64);
    for (own, other) in own.iter().zip(other) {
        let (Some(here), Some(there)) = (own.centre, other.centre) else { continue };
        let (_, apart) = frame.split(&std::array::from_fn(|c| here[c] - there[c]));
        couple = couple.max(own.normal_force * apart.iter().map(|x| x * x).sum::<f64>().sqrt());
        force = force.max(own.normal_force);
    }
    ratio(couple, force)
}
