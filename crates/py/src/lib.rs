//! The extension module `percute._percute`; the package around it, which has the names that users see, is
//! `python/percute`.

mod adapt;
mod balance;
mod bar_row;
mod bridge;
mod built;
mod case;
mod contact;
mod element_fields;
mod errors;
mod estimate;
mod exact;
mod export;
mod history;
mod history_arrays;
mod mesh;
mod options;
mod present;
mod problem;
mod reference;
mod run;
mod simulate;
mod statement;
mod stored;
mod stored_fields;
mod sweep;
mod time;
mod verify;
mod view;

/// What the Python package `percute` is made of; use the package.
#[pyo3::pymodule]
mod _percute {
    use pyo3::prelude::*;
    use std::ffi::OsString;

    #[pymodule_export]
    use super::adapt::AdaptingData;
    #[pymodule_export]
    use super::bar_row::BarRowData;
    #[pymodule_export]
    use super::bridge::{ProgressNow, close_files};
    #[pymodule_export]
    use super::case::{CaseData, stranger};
    #[pymodule_export]
    use super::element_fields::element_field;
    #[pymodule_export]
    use super::estimate::{EstimateData, estimate, meaning, unit};
    #[pymodule_export]
    use super::exact::{ExactData, true_error_of_bar_impact};
    #[pymodule_export]
    use super::export::export;
    #[pymodule_export]
    use super::history::HistoryData;
    #[pymodule_export]
    use super::mesh::MeshData;
    #[pymodule_export]
    use super::present::{colour_scale, deformed_outline, present, present_file};
    #[pymodule_export]
    use super::problem::ProblemData;
    #[pymodule_export]
    use super::reference::{errors_against_history, errors_against_simulation};
    #[pymodule_export]
    use super::simulate::{check_run, open_history, plausibility_warnings, rebound_end, resume, run_case, simulate};
    #[pymodule_export]
    use super::stored::{EstimateFileData, is_estimate};
    #[pymodule_export]
    use super::sweep::{SweepPlan, sweep_case};
    #[pymodule_export]
    use super::verify::{check_probes, verification};

    /// Adds the constants.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("MOST_THREADS", percute_estimator::MOST_THREADS)?;
        module.add("SERIES", percute_presentation::SERIES)?;
        module.add("LIMIT", percute_workflow::adapt::LIMIT)?;
        module.add("RUNS", percute_workflow::adapt::RUNS)?;
        module.add("MOST_LEVELS", percute_workflow::verify::MOST_LEVELS)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// `; did you mean …?` about the name of an argument, or nothing.
    #[pyfunction]
    fn hint(given: &str, known: Vec<String>) -> String {
        percute_workflow::message::hint(given, known.iter().map(String::as_str))
    }

    /// The name of the interface of two groups of edges.
    #[pyfunction]
    fn contact_name(first: &str, second: &str) -> String {
        percute_core::contact::contact_name([first, second])
    }

    /// Runs the command `percute` with these arguments, the program's name first, as the process's own: it prints to
    /// standard output and error and takes Ctrl-C over. Returns the exit code. `itself` is the command with which
    /// processes of its own are started.
    #[pyfunction]
    fn command(py: Python<'_>, arguments: Vec<OsString>, itself: Vec<OsString>) -> u8 {
        py.detach(|| percute::process(arguments, &itself))
    }
}
