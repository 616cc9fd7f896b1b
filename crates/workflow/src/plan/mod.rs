//! Sizes of elements for a smaller error, from one estimate.
//!
//! The source of the error decides on the branch. Fronts and dispersion need small elements everywhere: smaller ones
//! in places would only shorten all steps, and the larger ones would lose the cancellation of the errors of mass and
//! step. Slow contacts need a mesh graded towards the nodes that touch. Other errors, as at re-entrant corners, need
//! sizes by the error of each element. Error and cost of other sizes follow from exponents q of e_E ~ h^q, which the
//! sources give ([`Exponents`]).

mod basis;
mod cheapest;
mod exponents;
mod next_mesh;
mod recommendation;
mod size_field;
mod wanted;

pub use basis::Basis;
pub(crate) use basis::{shares_told, sizes};
pub use exponents::Exponents;
pub use next_mesh::NextMesh;
pub use recommendation::Recommendation;
pub use size_field::SizeField;
pub(crate) use wanted::PlannedSizes;

use cheapest::{Sizing, smallest};
use percute_core::problem::AnyProblem;
use serde::Serialize;

/// The part of the target that is aimed at.
const AIM: f64 = 0.97;
/// An element becomes smaller by this factor at most from a run to the next one: exponents hold near the sizes of a
/// run.
const SMALLEST: f64 = 0.25;
/// An element becomes larger by this factor at most.
pub(crate) const LARGEST: f64 = 1.5;
/// If a target is out of reach in one step, the part of the possible reduction (of logarithms) that is aimed at.
const PART: f64 = 0.8;
/// A source of more than this part of the squared mean error decides on the branch.
const MOST: f64 = 0.5;

/// Whether the error of a problem has sources to plan from.
///
/// # Errors
/// Finite kinematics, and materials that yield, in words.
pub fn can_be_planned(problem: &AnyProblem) -> Result<(), String> {
    let [need, with] = if problem.is_finite() {
        ["kinematics = \"small\"", "with finite kinematics"]
    } else if problem.yields() {
        ["elastic materials", "where a material yields,"]
    } else {
        return Ok(());
    };
    Err(format!(
        "plans of meshes need {need}: {with} the error has no sources to plan from; refine the mesh, and compare by \
         `percute verify`"
    ))
}

/// How elements are made smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Branch {
    /// All alike.
    Uniform,
    /// Towards the nodes that touch.
    Graded,
    /// By the error of each element.
    Map,
}

impl std::fmt::Display for Branch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Uniform => "uniform",
            Self::Graded => "graded",
            Self::Map => "map",
        })
    }
}

/// New sizes of the elements of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// How elements are made smaller.
    pub branch: Branch,
    /// The exponents.
    pub exponents: Exponents,
    /// The new size over that of the run, for each element.
    pub ratio: Vec<f64>,
    /// The mean error that the sizes make over that of the run.
    pub predicted: f64,
    /// Elements times steps over those of the run.
    pub cost: f64,
}

impl Plan {
    /// The plan for a mean error that is `wanted` times that of the run, or the next step towards it. No element
    /// becomes larger than `largest` times its size.
    #[must_use]
    pub fn new(basis: &Basis, wanted: f64, largest: &[f64]) -> Self {
        let (branch, exponents) = (basis.branch(), Exponents::of(&basis.sources));
        let q = exponents.each(basis);
        let sizing = Sizing::new(basis, &q, exponents.step);
        let ratio = match branch {
            Branch::Uniform => {
                vec![(AIM * wanted).powf(1.0 / exponents.far).max(SMALLEST); basis.size.len()]
            }
            Branch::Map => {
                let aim = sizing.within_reach(AIM * wanted, SMALLEST);
                let found = sizing.cheapest(aim, (SMALLEST, largest), Sizing::cost);
                found.unwrap_or_else(|| sizing.floor(SMALLEST))
            }
            Branch::Graded => sizing.graded(AIM * wanted, largest),
        };
        Self::of(branch, exponents, &sizing, ratio)
    }

    /// The exponents of an estimated run.
    #[must_use]
    pub fn exponents(basis: &Basis) -> Exponents {
        Exponents::of(&basis.sources)
    }

    /// The plan for a mean error that is `wanted` times that of the run in one step, however far, for its cost. None of
    /// a mesh to be graded: as it becomes finer, the error falls faster than exponents of coarse meshes tell.
    #[must_use]
    pub fn whole(basis: &Basis, wanted: f64) -> Option<Self> {
        let (branch, exponents) = (basis.branch(), Exponents::of(&basis.sources));
        let q = exponents.each(basis);
        let sizing = Sizing::new(basis, &q, exponents.step);
        let uniform = || vec![wanted.powf(1.0 / exponents.far); basis.size.len()];
        let ratio = match branch {
            Branch::Graded => return None,
            Branch::Uniform => uniform(),
            Branch::Map => {
                let range = (smallest(wanted, &q), &vec![1.0; q.len()][..]);
                sizing.cheapest(wanted, range, Sizing::cost).unwrap_or_else(uniform)
            }
        };
        Some(Self::of(branch, exponents, &sizing, ratio))
    }

    /// The mean error over that of the run on a mesh with these ratios of size, of which the smallest element has this
    /// size (m).
    pub(crate) fn predicted_on(&self, basis: &Basis, ratio: &[f64], smallest: f64) -> f64 {
        let q = self.exponents.each(basis);
        // With all elements as much smaller, the steps are as short as before for each.
        let step = if self.branch == Branch::Uniform { 0.0 } else { self.exponents.step };
        Sizing::new(basis, &q, step).predicted_beside(ratio, smallest)
    }

    fn of(branch: Branch, exponents: Exponents, sizing: &Sizing<'_>, ratio: Vec<f64>) -> Self {
        let (predicted, cost) = match branch {
            // Shorter steps go with all elements: there is nothing to lose.
            Branch::Uniform => (ratio[0].powf(exponents.far), sizing.cost(&ratio)),
            Branch::Map => (sizing.predicted(&ratio), sizing.cost(&ratio)),
            Branch::Graded => (sizing.predicted(&ratio), sizing.graded_cost(&ratio)),
        };
        Self { branch, exponents, ratio, predicted, cost }
    }
}
