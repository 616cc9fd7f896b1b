//! The mesh for a wanted accuracy: runs on meshes that follow from the estimate of the run before, until the target is
//! reached.
//!
//! All meshes have the body, the Courant number and the end of the first one. By default they are bisections of the
//! first mesh; a mesh of a generator is made anew where all elements become smaller alike.

mod adapting;
mod bisect;
mod gmsh;
mod iteration;
mod meshing;
mod polygon;
mod table;
mod toward;

pub use adapting::Adapting;
pub use gmsh::Geometry;
pub use iteration::{Iteration, Measure, Needed, Reason};
pub use meshing::Mesher;
pub use table::{announced, conclusion, table};

use crate::failure::Failure;
use crate::plan::Branch;
use crate::quantity::Quantity;
use crate::report::Report;
use crate::run::Results;
use percute_core::observer::Observer;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use std::sync::Arc;

/// The most elements times steps of a run, unless another limit is given: less than a minute.
pub const LIMIT: f64 = 1e8;
/// The most runs, unless another number is given.
pub const RUNS: usize = 8;
/// Targets from this relative error on are no accuracy.
const LARGEST_TARGET: f64 = 0.5;

/// What is wanted of an adaptation.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// The relative error to reach; of a quantity, its relative distance from the limit.
    pub target: f64,
    /// Which error, of the fields.
    pub measure: Measure,
    /// The quantity that the target is about, if it is not the error of the fields.
    pub on: Option<Quantity>,
    /// The Courant number of all runs; by default that of the steps of the first, which divide its end.
    pub courant: Option<f64>,
    /// The most elements times steps of a run.
    pub limit: f64,
    /// The most runs.
    pub runs: usize,
}

impl Wish {
    /// For a target, with the other values as they are by default.
    #[must_use]
    pub fn new(target: f64) -> Self {
        Self { target, measure: Measure::default(), on: None, courant: None, limit: LIMIT, runs: RUNS }
    }

    /// # Errors
    /// A value out of its range.
    pub fn check(&self) -> Result<(), Failure> {
        let Self { target, limit, runs, .. } = self;
        let told = if !(*target > 0.0 && *target < LARGEST_TARGET) {
            format!(
                "`target` is {target}; give a relative error above 0 and below {LARGEST_TARGET}, such as 0.05 or 5%"
            )
        } else if !(*limit >= 1.0 && limit.is_finite()) {
            format!("`limit` is {limit}; give a number of elements times steps, such as 1e9")
        } else if *runs == 0 {
            "`runs` is 0; give a number of runs, 1 or more".to_string()
        } else {
            return Ok(());
        };
        Err(Failure::Argument(told))
    }
}

/// An adaptation: its runs, and the best mesh.
#[derive(Clone, Debug)]
pub struct Adaptation {
    /// What was wanted.
    pub wish: Wish,
    /// The runs, in order.
    pub iterations: Vec<Iteration>,
    /// Why they ended; none if they go on.
    pub reason: Option<Reason>,
    /// The work that the target needs, if it is not reached and can be told.
    pub needed: Option<Needed>,
    /// The work of the next run, if that is above the limit.
    pub refused: Option<Needed>,
    /// The relative error of a uniform mesh with as much work as the limit allows, if that ended the runs.
    pub reachable: Option<f64>,
    /// Warnings about the meshes.
    pub warnings: Vec<String>,
    /// The best run; none if the first was interrupted.
    pub best: Option<Arc<Best>>,
}

/// The best run of an adaptation.
#[derive(Clone, Debug)]
pub struct Best {
    /// Its number, from 0.
    pub run: usize,
    /// The problem on its mesh.
    pub problem: AnyProblem,
    /// Its steps.
    pub times: TimeGrid,
    /// Its critical step (s).
    pub critical_step: f64,
    /// Its results.
    pub results: Results,
    /// Its report.
    pub report: Report,
}

/// The next run, before it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Next {
    /// Its number, from 0.
    pub run: usize,
    /// How its mesh was made; none of the first mesh.
    pub branch: Option<Branch>,
    /// Elements.
    pub elements: usize,
    /// Steps.
    pub steps: usize,
    /// The relative error expected of it; none of the first.
    pub predicted: Option<f64>,
    /// Its work.
    pub work: Needed,
    /// The work of a run that reaches the target, as far as it can be told.
    pub needed: Option<Needed>,
}

/// Adapts the mesh of a problem; `tell` gets each run before it starts. If the observer breaks, the best run so far
/// remains.
///
/// # Errors
/// A wish out of range, a problem that cannot be written down, a first run that fails.
pub fn adapt(
    problem: &AnyProblem,
    times: &TimeGrid,
    options: Options,
    wish: (Wish, Mesher),
    observer: &mut dyn Observer,
    tell: &mut dyn FnMut(&Next),
) -> Result<Adaptation, Failure> {
    let mut adapting = Adapting::new(problem, times, options, wish)?;
    while let Some(next) = adapting.upcoming()? {
        tell(&next);
        adapting.run(observer)?;
    }
    Ok(adapting.so_far())
}
