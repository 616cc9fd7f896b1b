//! What can be wrong with a file, and the way out.

use crate::kind::Kind;
use percute_core::history::StepError;
use percute_core::mesh::MeshError;
use percute_core::time::TimeError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An error about a file.
#[derive(Debug, Error)]
#[error("{}: {cause}", path.display())]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub cause: FileCause,
}

/// What is wrong.
#[derive(Debug, Error)]
pub enum FileCause {
    /// Nothing of that name.
    #[error("there is no such file")]
    Missing,
    /// A file that is not to be lost.
    #[error("the file exists already; give another name, or ask for it to be replaced")]
    Exists,
    /// Something else than a file.
    #[error("it is not a regular file; give another name")]
    NotAFile,
    /// Locked.
    #[error("another program is using the file (it is locked); wait until it is done, or give another name")]
    InUse,
    /// No file can be made there.
    #[error("the file cannot be created: {source}; is the folder there, and may it be written to?")]
    Create {
        /// Why.
        source: io::Error,
    },
    /// Not enough room.
    #[error("the file needs {needed} bytes, but only {free} are free there; make room, or store it elsewhere")]
    NoSpace {
        /// Bytes needed.
        needed: u64,
        /// Bytes free.
        free: u64,
    },
    /// Writing failed while the run went on.
    #[error("step {step} could not be written: {source}; all steps before it are in the file")]
    Write {
        /// The step.
        step: usize,
        /// Why.
        source: io::Error,
    },
    /// The end of the run could not be noted.
    #[error("the file could not be completed: {detail}; it has its {steps} steps, and `percute recover` completes it")]
    Finish {
        /// Why.
        detail: String,
        /// Instants written.
        steps: usize,
    },
    /// The file of a run went away while it was written.
    #[error("the file was moved, removed or replaced during the run")]
    Lost,
    /// The system does not let it be read.
    #[error("the file cannot be read: {source}")]
    Read {
        /// Why.
        source: io::Error,
    },
    /// Another file has taken its place.
    #[error("the file was replaced since it was opened; open it again")]
    Replaced,
    /// No bytes at all.
    #[error("the file is empty, neither a history nor an estimate; create it again")]
    Empty,
    /// No HDF5 file.
    #[error("this is not an HDF5 file, so neither a history nor an estimate; run a case first")]
    NotHdf5,
    /// HDF5 cannot make sense of it.
    #[error("the file is truncated or damaged: {detail}; copy or create it again")]
    Damaged {
        /// What the library says.
        detail: String,
    },
    /// HDF5, but not ours.
    #[error("this HDF5 file is not one of percute's: {holds}; docs/history.md describes the layout")]
    Foreign {
        /// What it holds instead.
        holds: String,
    },
    /// A file of percute, of another kind.
    #[error("this is {found}, but {wanted} is needed here")]
    WrongKind {
        /// What it is.
        found: Kind,
        /// What it should be.
        wanted: Kind,
    },
    /// Written by a later percute.
    #[error("the file has layout {found}, but this version of percute reads {known} only; use a newer percute")]
    NewerLayout {
        /// Layout of the file.
        found: i64,
        /// The latest one known.
        known: i64,
    },
    /// A part that must be there.
    #[error("`{name}` is missing; the layout of the file requires it")]
    MissingPart {
        /// Path inside the file.
        name: String,
    },
    /// A part of the wrong type.
    #[error("`{name}` holds {given}; it must be {needed}")]
    Type {
        /// Path inside the file.
        name: String,
        /// Its type.
        given: String,
        /// The right one.
        needed: &'static str,
    },
    /// A part of the wrong shape.
    #[error("`{name}` has the shape {given:?}; it must be {needed}")]
    Shape {
        /// Path inside the file.
        name: String,
        /// Its shape.
        given: Vec<usize>,
        /// The right one.
        needed: String,
    },
    /// A value that is not allowed.
    #[error("`{name}`: {detail}")]
    Value {
        /// Path inside the file.
        name: String,
        /// What is wrong.
        detail: String,
    },
    /// A shape that the stored bytes cannot fill.
    #[error("`{name}` has the shape {given:?}, but only {stored} bytes are stored in this file for it")]
    Hollow {
        /// Path inside the file.
        name: String,
        /// Its shape.
        given: Vec<usize>,
        /// Bytes stored.
        stored: u64,
    },
    /// More than memory can hold.
    #[error("`{name}` needs {bytes} bytes, which cannot be allocated in memory")]
    TooLarge {
        /// Path inside the file.
        name: String,
        /// Bytes wanted.
        bytes: u64,
    },
    /// NaN or infinity in a field over time.
    #[error("`{name}` is {value} at step {step}, node {node}; all values must be finite")]
    NotFinite {
        /// Path inside the file.
        name: String,
        /// The step.
        step: usize,
        /// Node of the mesh.
        node: usize,
        /// The value.
        value: f64,
    },
    /// Contact at a node that cannot touch.
    #[error(
        "node {node} touches or has a reaction at step {step}, but no obstacle of the problem can touch it; \
         `percute/contact` and the statement of the problem must agree"
    )]
    Contact {
        /// The step.
        step: usize,
        /// Node of the mesh.
        node: usize,
    },
    /// Instants that are no time grid.
    #[error("`{name}`: {cause}")]
    Times {
        /// The data set.
        name: String,
        /// What is wrong.
        cause: TimeError,
    },
    /// A mesh that cannot be used.
    #[error("the mesh: {0}")]
    Mesh(#[from] MeshError),
    /// A step that does not fit the file.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A problem on another mesh.
    #[error("the mesh of the problem has {given} {what}, but {needed} are needed")]
    Problem {
        /// Nodes or elements.
        what: &'static str,
        /// How many the problem has.
        given: usize,
        /// How many the history or the estimate has.
        needed: usize,
    },
}

impl FileCause {
    /// Whether the system does not let it happen: no fault of what was given.
    #[must_use]
    pub fn is_of_the_system(&self) -> bool {
        matches!(
            self,
            Self::InUse
                | Self::Create { .. }
                | Self::NoSpace { .. }
                | Self::Write { .. }
                | Self::Finish { .. }
                | Self::Lost
                | Self::Read { .. }
                | Self::Replaced
                | Self::TooLarge { .. }
        )
    }

    /// Joins the cause to its file.
    #[must_use]
    pub fn at(self, path: &Path) -> FileError {
        FileError { path: path.to_path_buf(), cause: self }
    }
}
