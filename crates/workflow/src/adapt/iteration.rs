//! A run of an adaptation, and how the runs ended.

use crate::effort::{Effort, duration};
use crate::message::short;
use crate::plan::{Basis, Branch};
use crate::report::{Report, Trust};
use serde::Serialize;

/// The relative error that a target is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// `relative_mean` of the error measures.
    #[default]
    Mean,
    /// `relative_sup`.
    Sup,
}

impl Measure {
    /// All, by their names.
    pub const NAMES: [(&str, Self); 2] = [("mean", Self::Mean), ("sup", Self::Sup)];

    /// That of a report.
    pub(super) fn of(self, report: &Report) -> f64 {
        match self {
            Self::Mean => report.error.relative_mean,
            Self::Sup => report.error.relative_sup,
        }
    }
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Iteration {
    /// How its mesh was made; none of the first mesh.
    pub branch: Option<Branch>,
    /// Number of elements.
    pub elements: usize,
    /// Number of steps.
    pub steps: usize,
    /// Elements times steps.
    pub element_steps: f64,
    /// Size of the smallest and of the largest element (m): the root of its area, or its length.
    pub sizes: [f64; 2],
    /// The relative error that the target is about.
    pub error: f64,
    /// That which was expected of its mesh; none of the first.
    pub predicted: Option<f64>,
    /// The value of the quantity that the target is about, if it is about one.
    pub quantity: Option<f64>,
    /// Parts of the sources in the squared mean error: surface, front, dispersion, mesh; none without an error.
    pub sources: Option<[f64; 4]>,
    /// How far the estimate can be trusted.
    pub trust: Trust,
    /// Reasons not to trust it, beside strains and rotations that are not small.
    pub reasons: Vec<String>,
}

impl Iteration {
    /// Of a report on a mesh with these sizes.
    pub(super) fn new(report: &Report, basis: Option<&Basis>, size: &[f64], measure: Measure, made: Made) -> Self {
        let sizes = [f64::min, f64::max].map(|pick| size.iter().copied().reduce(pick).unwrap_or(0.0));
        Self {
            branch: made.branch,
            elements: report.problem.elements,
            steps: report.steps,
            element_steps: report.problem.elements as f64 * report.steps as f64,
            sizes,
            error: measure.of(report),
            predicted: made.predicted,
            quantity: None,
            sources: basis.map(Basis::shares),
            trust: report.verdict.trust,
            reasons: report.verdict.reasons.clone(),
        }
    }
}

/// How a mesh was made, and the error expected on it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Made {
    pub(super) branch: Option<Branch>,
    pub(super) predicted: Option<f64>,
}

/// Why an adaptation ended.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The target is reached.
    Reached,
    /// The next run, or the target, has more elements times steps than the limit.
    Limit,
    /// As many runs as were allowed are done.
    Runs,
    /// The next mesh is that of the last run.
    SameMesh,
    /// The estimate of the last run is not trusted, for reasons that finer meshes do not remove: a run before counts.
    NotTrusted,
    /// The quantity of the target has no limit: a sentence with the reason and the way out.
    NoLimit(String),
    /// There are no sources of the error to plan from.
    NoSources,
    /// The next run failed.
    Failed(String),
    /// Stopped by the user.
    Interrupted,
}

/// The work that a target needs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Needed {
    /// Elements times steps.
    pub element_steps: f64,
    /// About how long that takes (s).
    pub seconds: f64,
}

impl Needed {
    /// The work of a run.
    pub(super) fn of(effort: &Effort) -> Self {
        Self { element_steps: effort.element_steps as f64, seconds: effort.run_seconds }
    }

    /// So many times the work.
    pub(super) fn times(self, factor: f64) -> Self {
        Self { element_steps: factor * self.element_steps, seconds: factor * self.seconds }
    }

    /// In words.
    pub(super) fn told(&self) -> String {
        format!("{} elements times steps ({})", short(self.element_steps, 2), duration(self.seconds))
    }
}
