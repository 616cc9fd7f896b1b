//! What a run has to say, ready to print. The fields are the keys of the JSON document, described
//! in `docs/json.md`.

pub(crate) mod build;
mod contact;
mod meaning;
mod simulated;
pub(crate) mod summary;
mod warnings;

pub use contact::{ContactNodes, ContactReport, ContactResultants};
pub use meaning::meaning;
pub use simulated::simulated;
pub use summary::summary;
pub use warnings::Warning;
pub(crate) use warnings::few_samples;
pub use warnings::reported;

use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use serde::{Serialize, Serializer};

/// Number of the layout of the JSON document; it grows when a key changes its meaning or goes.
pub(crate) const FORMAT: u32 = 1;
/// Residuals above this mean that a field is not admissible.
pub(crate) const ADMISSIBLE: f64 = 1e-10;

/// What a report is about.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a, const D: usize, const N: usize> {
    /// Name of the case or of the history, as it was given.
    pub name: &'a str,
    /// The problem.
    pub problem: &'a Problem<D, N>,
    /// The instants, those that were not reached too.
    pub times: &'a TimeGrid,
    /// Δt_c (s), eq. \[34\].
    pub critical_step: f64,
    /// Number of instants that a stored history holds; `None` beside a run.
    pub held: Option<usize>,
}

/// The report of a run. SI units; energies, errors and forces of a plane body are those of its
/// thickness.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Report {
    pub format: u32,
    pub versions: Versions,
    pub case: String,
    pub problem: ProblemSummary,
    pub options: OptionsUsed,
    pub time_step: f64,
    pub critical_time_step: f64,
    pub steps: usize,
    pub steps_planned: usize,
    pub end: f64,
    pub interrupted: bool,
    pub given: Given,
    #[serde(skip)]
    pub held: Option<usize>,
    pub error: Measures,
    pub meaning: String,
    pub parts: Parts,
    pub time_of_sup: f64,
    pub worst_elements: Vec<WorstElement>,
    #[serde(serialize_with = "as_map")]
    pub residuals: Vec<(&'static str, f64)>,
    pub largest_residual: LargestResidual,
    pub balance: BalanceSummary,
    pub balance_over_time: BalanceOverTime,
    pub kept_impulse: Option<f64>,
    pub contact: Option<ContactReport>,
    pub over_time: OverTime,
    pub by_element: Vec<f64>,
    pub warnings: Vec<Warning>,
    pub seconds: f64,
}

/// Which fields a history brought of its own; the others follow by the scheme.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Given {
    pub velocity: bool,
    pub acceleration: bool,
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
    pub mass: f64,
    pub wave_speed: f64,
    pub materials: usize,
    pub obstacles: Vec<ObstacleSummary>,
    pub contact_nodes: usize,
    pub prescribed_components: usize,
    pub loaded_facets: usize,
    pub body_forces: usize,
    pub resampling_error: f64,
}

/// A plane.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct ObstacleSummary {
    pub point: Vec<f64>,
    pub normal: Vec<f64>,
    pub friction: f64,
    pub group: Option<String>,
}

/// Options of the estimate.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct OptionsUsed {
    pub reconstruction: String,
    pub acceleration: String,
    pub every: usize,
    pub threads: Option<usize>,
    pub window: Option<usize>,
}

/// The error measures, eq. \[15\], \[16\], \[22\], \[23\].
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Measures {
    pub sup: f64,
    pub mean: f64,
    pub relative_sup: f64,
    pub relative_mean: f64,
    pub reference_sup: f64,
    pub reference_mean: f64,
}

/// The parts of η at one instant, eq. \[14\].
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs)]
pub struct Parts {
    pub kinetic: f64,
    pub elastic: f64,
    pub contact: f64,
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

/// Energies and works at the last step, and drifts over the run.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct BalanceSummary {
    pub kinetic: f64,
    pub strain: f64,
    pub initial: f64,
    pub work_of_loads: f64,
    pub work_of_supports: f64,
    pub work_of_contact: f64,
    pub friction: f64,
    pub energy_drift: f64,
    pub impulse_drift: f64,
}

/// Energies and works at every step.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct BalanceOverTime {
    pub time: Vec<f64>,
    pub kinetic: Vec<f64>,
    pub strain: Vec<f64>,
    pub work_of_loads: Vec<f64>,
    pub work_of_supports: Vec<f64>,
    pub work_of_contact: Vec<f64>,
    pub friction: Vec<f64>,
}

/// η, its parts and d at all samples.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct OverTime {
    pub time: Vec<f64>,
    pub kinetic: Vec<f64>,
    pub elastic: Vec<f64>,
    pub contact: Vec<f64>,
    pub total: Vec<f64>,
    pub reference: Vec<f64>,
}

impl Versions {
    pub(crate) fn of_this_program() -> Self {
        let (architecture, system) = (std::env::consts::ARCH, std::env::consts::OS);
        Self { percute: env!("CARGO_PKG_VERSION"), architecture, system }
    }
}

impl Report {
    /// The report as a JSON document. Numbers that are not finite become `null`.
    ///
    /// # Errors
    /// None that is known; whatever the serialiser reports.
    pub fn to_json(&self) -> Result<String, std::io::Error> {
        serde_json::to_string(self).map_err(std::io::Error::from)
    }
}

/// Named values in their own order.
fn as_map<S: Serializer>(entries: &[(&'static str, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().copied())
}
