//! What can keep a part from being made.

use crate::exit::{BAD_INPUT, FAILED, INTERRUPTED};
use crate::picture::DrawError;
use percute_core::dynamics::SimulationError;
use percute_core::material::MaterialError;
use percute_core::mesh::MeshError;
use percute_core::obstacle::PlaneError;
use percute_core::problem::InputError;
use percute_core::time::TimeError;
use percute_estimator::reference::ReferenceError;
use percute_estimator::{EstimateError, RunError};
use percute_workflow::Failure;
use percute_workflow::case::CaseError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a reproduction could not be made.
#[derive(Debug, Error)]
pub enum ReproduceError {
    /// The observer broke.
    #[error("interrupted")]
    Interrupted,
    /// A part that does not exist.
    #[error("there is no part \"{given}\"; the parts are {known}{hint}")]
    UnknownPart {
        /// The name given.
        given: String,
        /// What was likely meant, as the end of a sentence.
        hint: String,
        /// The names that exist.
        known: String,
    },
    /// A folder that is not to be lost.
    #[error("the folder {folder} is not empty; name another, or let its files be replaced", folder = .folder.display())]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
    },
    /// A file or folder that cannot be written.
    #[error("cannot write {file}: {cause}", file = .file.display())]
    Unwritable {
        /// The file or folder.
        file: PathBuf,
        /// Why.
        cause: String,
    },
    /// A part that failed.
    #[error("part {part}: {cause}")]
    Part {
        /// Its name.
        part: &'static str,
        /// Why.
        cause: Box<ReproduceError>,
    },
    /// A case that is not what the part takes it for, or a result that it cannot use.
    #[error("{0}")]
    Unexpected(String),
    /// A case file.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A command's own work.
    #[error(transparent)]
    Failure(#[from] Box<Failure>),
    /// A mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A material.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// A plane.
    #[error(transparent)]
    Plane(#[from] PlaneError),
    /// A problem.
    #[error(transparent)]
    Problem(#[from] InputError),
    /// Instants.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// A simulation.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// An estimate.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// Both.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A true error.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// A figure that cannot be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
}

impl From<Failure> for ReproduceError {
    fn from(failure: Failure) -> Self {
        Self::Failure(Box::new(failure))
    }
}

impl ReproduceError {
    /// The exit code of a command that ends with this.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted => INTERRUPTED,
            Self::UnknownPart { .. } | Self::NotEmpty { .. } => BAD_INPUT,
            // Parts bring their own input: what they are refused is no fault of the user.
            _ => FAILED,
        }
    }
}
