//! Why a command failed, and with which exit code.

use crate::case::CaseError;
use percute_estimator::RunError;
use std::path::PathBuf;
use thiserror::Error;

/// Exit code of a command that did all it should.
pub const DONE: u8 = 0;
/// Exit code of a command that failed though its input was good.
pub const FAILED: u8 = 1;
/// Exit code of bad input: the case file or the arguments.
pub const BAD_INPUT: u8 = 2;
/// Exit code after Ctrl-C.
pub const INTERRUPTED: u8 = 130;

/// Why a command failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// The case file is wrong.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The case file cannot be read.
    #[error("{file}: cannot read the case file: {cause}", file = .file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// An argument that cannot be met.
    #[error("{0}")]
    Argument(String),
    /// Simulation or estimate failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The picture cannot be written.
    #[error("--picture: cannot write {file}: {cause}", file = .file.display())]
    Picture {
        /// The file.
        file: PathBuf,
        /// Why.
        cause: String,
    },
    /// Standard output or standard error cannot be written.
    #[error("cannot write the result: {0}")]
    Output(#[from] std::io::Error),
}

impl Failure {
    /// The exit code.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Case(_) | Self::Unreadable { .. } | Self::Argument(_) => BAD_INPUT,
            Self::Run(_) | Self::Picture { .. } | Self::Output(_) => FAILED,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::dynamics::SimulationError;

    #[test]
    fn a_run_that_fails_is_not_bad_input() {
        let unstable = SimulationError::Unstable {
            step: 3,
            time: 1e-6,
            node: 7,
            speed: 1e9,
            longest_step: 2e-7,
            critical_step: 1e-7,
        };
        let failure = Failure::Run(RunError::Simulation(unstable));
        assert_eq!(failure.exit_code(), FAILED);
        assert!(failure.to_string().contains("unstable at step 3"), "{failure}");
        assert_eq!(Failure::Argument("--threads".into()).exit_code(), BAD_INPUT);
    }
}
