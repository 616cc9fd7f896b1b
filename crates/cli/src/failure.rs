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
