//! The refinement for half the error.

use super::{Basis, Branch, Plan};
use serde::Serialize;

/// On meshes of more elements, sizes by the error of each element are not looked for, which would take seconds.
const MOST: usize = 20_000;
/// A part of the mean error.
const HALF: f64 = 0.5;

/// How the mean error becomes half of that of a run, and the cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Recommendation {
    /// How elements are made smaller.
    pub branch: Branch,
    /// By which factor all become smaller, of a uniform mesh; none of others.
    pub finer: Option<f64>,
    /// Elements times steps over those of the run; none of a mesh to be graded, and of a large one that is not uniform.
    pub cost: Option<f64>,
}

impl Recommendation {
    /// From an estimated run.
    #[must_use]
    pub fn new(basis: &Basis) -> Self {
        let branch = basis.branch();
        let is_quick = branch == Branch::Uniform || basis.size.len() <= MOST;
        let plan = if is_quick { Plan::whole(basis, HALF) } else { None };
        let finer = plan.as_ref().filter(|_| branch == Branch::Uniform).and_then(|plan| plan.ratio.first().copied());
        Self { branch, finer: finer.map(|ratio| 1.0 / ratio), cost: plan.map(|plan| plan.cost) }
    }
}
