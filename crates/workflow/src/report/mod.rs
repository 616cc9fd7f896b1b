//! What a run has to say, ready to print. The fields are the keys of the JSON document, described
//! in `docs/json.md`.

pub(crate) mod build;
mod columns;
mod contact;
mod flat;
mod found;
mod impacts;
mod linearity;
mod margin;
mod meaning;
mod narrow;
mod non_matching;
mod poor;
mod rebound;
mod simulated;
mod sources;
pub(crate) mod summary;
mod symptoms;
mod touches;
mod varying_steps;
mod verdict;
mod warnings;

pub use build::warnings_of;
pub use columns::{Columns, ENERGIES, EnergiesOverTime, Named, PARTS, SOURCES};
pub use contact::{ContactNodes, ContactReport, ContactResultants, NearestNode, PeakForce};
pub use impacts::{BodyMotion, Impacts, InterfaceRebound};
pub use margin::ElasticMargin;
pub use meaning::meaning;
pub use non_matching::NonMatchingReport;
pub use poor::PoorElement;
pub use rebound::{Rebound, rebound_to_json};
pub use simulated::simulated;
pub use sources::SourceReport;
pub use summary::summary;
pub use symptoms::drifted;
pub use touches::Touches;
pub use varying_steps::{unstable_steps, varying_steps};
pub use verdict::{Shares, Trust, Verdict};
pub(crate) use warnings::few_samples;
pub use warnings::reported;
pub use warnings::{Warning, left_out};

use crate::deformation::Deformation;
use crate::foreign::{Checked, Consistency, Derived, Samples};
use crate::outline::Outline;
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::{Balance, Simulation};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_core::units::Units;
use percute_estimator::{ErrorMeasures, Estimate, Options, Parts, Residuals, Sample, Supplied};
use serde::Serialize;

/// Number of the layout of the JSON document; it grows when a key changes its meaning or goes.
pub const FORMAT: u32 = 3;
/// Residuals above this mean that a field is not admissible.
pub(crate) const ADMISSIBLE: f64 = 1e-10;

/// What a report is about.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// Name of the case or of the history, as it was given.
    pub name: &'a str,
    /// The problem.
    pub problem: &'a AnyProblem,
    /// The instants, those that were not reached too.
    pub times: &'a TimeGrid,
    /// Δt_c (s), eq. \[34\].
    pub critical_step: f64,
    /// Number of instants that a stored history holds; `None` beside a run.
    pub held: Option<usize>,
    /// What was found about a history of another program.
    pub checked: Option<&'a Checked>,
    /// The warning of a run that was to end with the rebound, if contact did not end.
    pub unended: Option<&'a Warning>,
}

/// What a report is made of: the results of a run, or of the estimate of a history.
#[derive(Clone, Copy, Debug)]
pub struct Findings<'a> {
    /// Balance and number of the steps.
    pub simulation: &'a Simulation,
    /// The estimate of the error.
    pub estimate: &'a Estimate,
    /// The contact results.
    pub contact: &'a ContactResults,
    /// The deformation and the stress.
    pub deformation: &'a Deformation,
    /// The outline of a plane body at the last step.
    pub outline: Option<&'a Outline>,
}

/// The report of a run. SI units; energies, errors and forces of a plane body are those of its
/// thickness.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Report {
    pub format: u32,
    pub versions: Versions,
    pub case: String,
    pub simulated_by: Option<String>,
    pub problem: ProblemSummary,
    pub options: Options,
    pub time_step: f64,
    pub critical_time_step: f64,
    pub steps: usize,
    pub steps_planned: usize,
    pub end: f64,
    pub interrupted: bool,
    pub supplied: Supplied,
    pub derived: Vec<Derived>,
    pub consistency: Option<Consistency>,
    pub samples: Option<Samples>,
    pub accepted_inconsistent: bool,
    #[serde(skip)]
    pub held: Option<usize>,
    pub error: ErrorMeasures,
    pub meaning: &'static str,
    pub verdict: Verdict,
    pub parts: Parts,
    pub sources: Option<SourceReport>,
    pub time_of_sup: f64,
    pub worst_elements: Vec<WorstElement>,
    pub residuals: Residuals,
    pub largest_residual: LargestResidual,
    pub balance: Balance,
    pub balance_over_time: EnergiesOverTime,
    pub impulse_ratio: Option<f64>,
    pub isolated_contact_nodes: usize,
    pub auxiliary_contact_energy: f64,
    pub contact: Option<ContactReport>,
    pub rebound: Option<Rebound>,
    pub impacts: Option<Impacts>,
    pub non_matching: Vec<NonMatchingReport>,
    pub deformation: Deformation,
    pub over_time: Columns<Sample, 7>,
    pub by_element: Vec<f64>,
    pub outline: Option<Outline>,
    pub warnings: Vec<Warning>,
    pub seconds: Option<f64>,
}

/// Versions of the programs that made a report.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Versions {
    pub percute: &'static str,
    pub architecture: &'static str,
    pub system: &'static str,
}

/// What was run.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct ProblemSummary {
    pub dimension: usize,
    pub nodes: usize,
    pub elements: usize,
    pub reoriented_elements: usize,
    pub lower_corner: Vec<f64>,
    pub upper_corner: Vec<f64>,
    pub per_metre: bool,
    pub mass: f64,
    pub wave_speed: f64,
    pub materials: usize,
    pub obstacles: Vec<ObstacleSummary>,
    pub contact_nodes: usize,
    pub prescribed_components: usize,
    pub loaded_edges: usize,
    pub body_forces: usize,
    pub resampling_error: f64,
}

/// A plane, or the surface of another body, which has no point.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct ObstacleSummary {
    pub point: Option<Vec<f64>>,
    pub normal: Vec<f64>,
    pub friction: f64,
    pub group: Option<String>,
}

/// An element with its contribution.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct WorstElement {
    pub element: usize,
    pub error: f64,
    pub centroid: Vec<f64>,
}

/// The largest residual and its name.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct LargestResidual {
    pub name: &'static str,
    pub value: f64,
    pub admissible: bool,
}

/// Units of forces and energies in a document; those of the body in documents of earlier versions.
#[must_use]
pub fn units_of(document: &serde_json::Value) -> Units {
    Units { per_metre: document["problem"]["per_metre"].as_bool().unwrap_or_default() }
}

/// The same of the text of a document; those of the body in one of another program.
#[must_use]
pub fn units_in(text: &str) -> Units {
    units_of(&serde_json::from_str(text).unwrap_or_default())
}

impl ProblemSummary {
    /// Units of forces, energies and masses.
    pub(crate) fn units(&self) -> Units {
        Units { per_metre: self.per_metre }
    }
}

impl Versions {
    pub(crate) fn of_this_program() -> Self {
        let (architecture, system) = (std::env::consts::ARCH, std::env::consts::OS);
        Self { percute: env!("CARGO_PKG_VERSION"), architecture, system }
    }
}

impl Report {
    /// Verdict, warnings, rebound, the contact of several bodies and the deformation as a JSON document.
    ///
    /// # Errors
    /// As [`Report::to_json`].
    pub fn verdict_to_json(&self) -> Result<String, std::io::Error> {
        let Self { verdict, rebound, impacts, non_matching, deformation, warnings, .. } = self;
        let contact = self.contact.as_ref();
        let (nearest, peak) = (contact.and_then(|c| c.nearest), contact.and_then(|c| c.averaged_peak));
        let document = serde_json::json!({
            "verdict": verdict, "rebound": rebound, "impacts": impacts, "non_matching": non_matching,
            "problem": { "per_metre": self.problem.per_metre },
            "contact": { "nearest": nearest, "averaged_peak": peak },
            "deformation": deformation, "warnings": warnings,
        });
        serde_json::to_string(&document).map_err(std::io::Error::from)
    }

    /// The document for files: without the duration of the work, so that identical runs make identical files.
    ///
    /// # Errors
    /// As [`Report::to_json`].
    pub fn to_stored_json(&self) -> Result<String, std::io::Error> {
        Self { seconds: None, ..self.clone() }.to_json()
    }

    /// The report as a JSON document. Numbers that are not finite become `null`.
    ///
    /// # Errors
    /// None that is known; whatever the serialiser reports.
    pub fn to_json(&self) -> Result<String, std::io::Error> {
        serde_json::to_string(self).map_err(std::io::Error::from)
    }
}
