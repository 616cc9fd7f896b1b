//! The sources of the error in a report.

use super::columns::{Columns, SOURCES};
use percute_estimator::{Separation, Sources};
use serde::Serialize;

/// The sources of η (J), and the mean errors (J^½) that a finer mesh and shorter steps would have.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct SourceReport {
    pub at_sup: Sources,
    pub mean: Sources,
    pub halved_elements: Sources,
    pub halved_step: f64,
    pub mean_with_halved_elements: Option<f64>,
    pub mean_with_halved_step: Option<f64>,
    pub over_time: Columns<Sources, 4>,
}

impl SourceReport {
    pub(super) fn new(separation: &Separation) -> Self {
        Self {
            at_sup: separation.at_sup,
            mean: separation.mean,
            halved_elements: separation.halved_elements,
            halved_step: separation.halved_step,
            mean_with_halved_elements: separation.mean_with_halved_elements(),
            mean_with_halved_step: separation.mean_with_halved_step(),
            over_time: Columns::new(separation.over_time.clone(), SOURCES),
        }
    }
}
