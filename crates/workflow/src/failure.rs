//! Why something could not be done.

use crate::case::{CaseError, NotRepresentable};
use crate::foreign::Contradiction;
use percute_core::contact_results::ContactMemoryError;
use percute_core::dynamics::SimulationError;
use percute_core::history::SinkError;
use percute_estimator::reference::ReferenceError;
use percute_estimator::{EstimateError, RunError};
use percute_io::FileError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why something could not be done.
#[derive(Debug, Error)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum Failure {
    /// The case file is wrong.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The case file cannot be read.
    #[error("{file}: cannot read the case file: {cause}", file = .file.display())]
    Unreadable { file: PathBuf, cause: std::io::Error },
    /// An argument that cannot be met.
    #[error("{0}")]
    Argument(String),
    /// A file that is not to be lost.
    #[error(
        "{what} {file}: the file exists already; give another name, or --force to replace it",
        file = .file.display()
    )]
    Exists {
        /// The argument or key that names it.
        what: &'static str,
        file: PathBuf,
    },
    /// Results of a sweep that are not to be lost.
    #[error("{}", kept_results(.folder, .cases, "--force"))]
    Results {
        folder: PathBuf,
        /// The names of their cases.
        cases: Vec<String>,
    },
    /// Simulation or estimate failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A history or estimate file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A history that does not fit its own problem.
    #[error("{file}: {cause}", file = .file.display())]
    History { file: PathBuf, cause: EstimateError },
    /// A history of another program that contradicts itself or its problem.
    #[error("{}", inconsistency(file.as_deref(), contradiction, "--accept-inconsistent"))]
    Inconsistent {
        /// Its file, if it is in one.
        file: Option<PathBuf>,
        contradiction: Contradiction,
    },
    /// A reference that does not fit.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// A problem that cannot be written down.
    #[error(transparent)]
    NotRepresentable(#[from] NotRepresentable),
    /// No room for the contact results.
    #[error(transparent)]
    Contact(#[from] ContactMemoryError),
    /// Not enough memory for the work.
    #[error("{0}")]
    Memory(String),
    /// A file that cannot be written.
    #[error("{what}: cannot write {file}: {cause}", file = .file.display())]
    Unwritable {
        /// The argument or key that names it.
        what: &'static str,
        file: PathBuf,
        cause: String,
    },
    /// A file in a folder that is not there.
    #[error("{what}: cannot write {file}: {cause}", file = .file.display())]
    NoFolder { what: &'static str, file: PathBuf, cause: String },
    /// Standard output or standard error cannot be written.
    #[error("cannot write the result: {0}")]
    Output(#[from] std::io::Error),
}

/// An inconsistency of a history, in a file or not, its likely cause, and the option that accepts it.
#[must_use]
pub fn inconsistency(file: Option<&Path>, contradiction: &Contradiction, option: &str) -> String {
    let Contradiction { figure, cause, can_be_accepted } = contradiction;
    let file = file.map_or(String::new(), |file| format!("{}: ", file.display()));
    let cause = match cause {
        Some(cause) => format!("Likely cause: {cause}"),
        None => "No single cause was found; compare mesh, materials, units, times and loads".to_string(),
    };
    let accept = match can_be_accepted {
        true => format!("; to estimate it as it is, give {option}"),
        false => String::new(),
    };
    format!("{file}the history is not consistent: {figure}. {cause}{accept}")
}

/// Results that a sweep would replace, and the option that lets it do so.
#[must_use]
pub fn kept_results(folder: &Path, cases: &[String], option: &str) -> String {
    let (first, folder) = (cases.first().map_or("", String::as_str), folder.display());
    let more = match cases.len().saturating_sub(1) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!(
        "{folder}: {first}{more}: the results there are those of another case file or of another version of percute; \
         name another folder, or give {option} to replace them"
    )
}

impl Failure {
    /// Whether the case file, the history or the arguments are wrong, or ask for more memory than there is.
    #[must_use]
    pub fn is_bad_input(&self) -> bool {
        match self {
            Self::Case(_)
            | Self::Unreadable { .. }
            | Self::Argument(_)
            | Self::Exists { .. }
            | Self::Results { .. }
            | Self::NoFolder { .. }
            | Self::History { .. }
            | Self::Inconsistent { .. }
            | Self::Reference(_)
            | Self::Contact(_)
            | Self::Memory(_)
            | Self::NotRepresentable(_) => true,
            Self::File(error) => !error.cause.is_of_the_system(),
            Self::Run(_) | Self::Unwritable { .. } | Self::Output(_) => false,
        }
    }

    /// A file that the argument or key `what` names and that cannot be made.
    #[must_use]
    pub fn unwritable(what: &'static str, file: &Path, cause: &std::io::Error) -> Self {
        let (file, missing, cause) = (file.to_path_buf(), cause.kind() == ErrorKind::NotFound, cause.to_string());
        if missing { Self::NoFolder { what, file, cause } } else { Self::Unwritable { what, file, cause } }
    }

    /// Whether the simulation refused the start: its history file is removed then.
    #[must_use]
    pub fn is_refused_start(&self) -> bool {
        matches!(self, Self::Run(RunError::Simulation(SimulationError::StartsTooNear { .. })))
    }

    /// What became of a sink that did not take a step: it stands for itself.
    pub(crate) fn from_sink(error: SinkError, otherwise: impl FnOnce(SinkError) -> RunError) -> Self {
        let error = match error.downcast::<FileError>() {
            Ok(error) => return Self::File(*error),
            Err(error) => error,
        };
        let error = match error.downcast::<SimulationError>() {
            Ok(error) => return Self::Run(RunError::Simulation(*error)),
            Err(error) => error,
        };
        match error.downcast::<EstimateError>() {
            Ok(error) => Self::Run(RunError::Estimate(*error)),
            Err(error) => Self::Run(otherwise(error)),
        }
    }
}

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        match error {
            SimulationError::Sink { step, cause } => {
                Self::from_sink(cause, |cause| SimulationError::Sink { step, cause }.into())
            }
            error => Self::Run(error.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_io::FileCause;

    #[test]
    fn a_run_that_fails_is_not_bad_input() {
        let unstable = SimulationError::Unstable {
            step: 3,
            time: 1e-6,
            node: 7,
            speed: 1e9,
            longest_step: 2e-7,
            critical_step: 1e-7,
            by_contact: false,
        };
        let failure = Failure::from(unstable);
        assert!(!failure.is_bad_input());
        assert!(failure.to_string().contains("unstable at step 3"), "{failure}");
        assert!(Failure::Argument("--threads".into()).is_bad_input());
    }

    #[test]
    fn a_step_that_could_not_be_stored_names_its_file() {
        let full = FileCause::Write { step: 4, source: std::io::Error::from_raw_os_error(28) };
        let failure = Failure::from(SimulationError::Sink { step: 4, cause: full.at("a.vtkhdf".as_ref()).into() });
        assert!(!failure.is_bad_input());
        let said = failure.to_string();
        assert!(said.starts_with("a.vtkhdf: step 4 could not be written") && !said.contains("passed on"), "{said}");
    }
}
