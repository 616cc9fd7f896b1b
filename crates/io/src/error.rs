//! Errors about files, with their remedies.

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
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum FileCause {
    /// No such file.
    #[error("there is no such file")]
    Missing,
    /// An existing file.
    #[error("the file exists already; give another name, or ask for it to be replaced")]
    Exists,
    /// Not a regular file.
    #[error("it is a folder, a pipe or a device, not a regular file; give another name")]
    NotAFile,
    /// Locked.
    #[error("another program is using the file (it is locked); wait until it is done, or give another name")]
    InUse,
    /// The file cannot be created.
    #[error("the file cannot be created: {source}; check that the folder exists and is writable")]
    Create { source: io::Error },
    /// Not enough space.
    #[error("the file needs {needed} bytes of room, but only {free} are free there; make room, or store it elsewhere")]
    NoSpace { needed: u64, free: u64 },
    /// More than a file may have here.
    #[error(
        "the file needs {needed} bytes, more than a file may have here (File too large); raise the limit of the shell \
         (`ulimit -f`), or store it on another file system"
    )]
    Limit { needed: u64 },
    /// Writing failed during the run.
    #[error("step {step} could not be written: {source}; all steps before it are in the file")]
    Write { step: usize, source: io::Error },
    /// The file could not be completed.
    #[error(
        "the file could not be completed: {detail}; {steps} instants were written to it: if it is whole, `percute \
         recover` completes it"
    )]
    Finish { detail: String, steps: usize },
    /// A run of another program or machine.
    #[error(
        "its run cannot be resumed: it was written by {written}, and this is {here}, whose numbers may differ; \
         run again"
    )]
    Other { written: String, here: String },
    /// A file without checksums.
    #[error("its run cannot be resumed: the file has no checksums, so that its steps may have been changed; run again")]
    Unsummed,
    /// A stored history of another program.
    #[error("its run cannot be resumed: another program has simulated it, and percute has only stored it")]
    Elsewhere,
    /// Steps with their own velocities or accelerations.
    #[error("its run cannot be resumed: it has velocities or accelerations of its own, which the scheme does not give")]
    GivenMotion,
    /// The file of a run that was killed before its first step.
    #[error("the run was killed before it wrote its first step: the file holds nothing; delete it, and run again")]
    NoStep,
    /// The file of a run disappeared during the run; `now` is its place and name, if it still has one.
    #[error("the file was moved, removed or replaced during the run{}", match now {
        Some(now) => format!("; all steps done are in it, as {}", now.display()),
        None => ": its steps are lost".to_string(),
    })]
    Lost { now: Option<PathBuf> },
    /// The file cannot be read.
    #[error("the file cannot be read: {source}")]
    Read { source: io::Error },
    /// The file was replaced by another one.
    #[error("the file was replaced since it was opened; open it again")]
    Replaced,
    /// An empty file.
    #[error("the file is empty, neither a history nor an estimate; create it again")]
    Empty,
    /// Not an HDF5 file.
    #[error(
        "this is not an HDF5 file, so neither a history nor an estimate; run a case first, or give the arrays of \
         another program to `pc.History.from_arrays` (docs/foreign.md)"
    )]
    NotHdf5,
    /// HDF5 cannot read the file.
    #[error("the file is truncated or damaged: {detail}; copy or create it again")]
    Damaged { detail: String },
    /// An HDF5 file of another program.
    #[error("this HDF5 file is not one of percute's: {holds}; docs/history.md describes the layout")]
    Foreign { holds: String },
    /// A file of percute, of another kind.
    #[error("this is {found}, but {wanted} is needed here")]
    WrongKind { found: Kind, wanted: Kind },
    /// Written by a later percute.
    #[error("the file has layout {found}, but this version of percute reads {known} only; use a newer percute")]
    NewerLayout { found: i64, known: i64 },
    /// Written by an earlier percute.
    #[error("the file has layout {found}, but this version of percute reads {known} only; simulate or estimate again")]
    OlderLayout { found: i64, known: i64 },
    /// Numbers that are not those written.
    #[error(
        "`{name}` does not have its checksum{}: the file was damaged or changed after its run; simulate again, or \
         delete `percute/checksum` and `percute/checksums` from a file that was changed on purpose",
        step.map_or(String::new(), |step| format!(" at instant {step}"))
    )]
    Checksum { name: String, step: Option<usize> },
    /// A data set or group that does not hold what was written.
    #[error(
        "`{name}` does not have its checksum: the file was damaged or changed after it was written; make it again, or \
         delete the attribute `checksum` of this data set or group if it was changed on purpose"
    )]
    Seal { name: String },
    /// A missing part.
    #[error("`{name}` is missing; the layout of the file requires it")]
    MissingPart { name: String },
    /// A part of the wrong type.
    #[error("`{name}` holds {given}; it must be {needed}")]
    Type { name: String, given: String, needed: &'static str },
    /// A part of the wrong shape.
    #[error("`{name}` has the shape {given:?}; it must be {needed}")]
    Shape { name: String, given: Vec<usize>, needed: String },
    /// A value that is not allowed.
    #[error("`{name}`: {detail}")]
    Value { name: String, detail: String },
    /// A history that keeps a part of its run only.
    #[error(
        "the file keeps {held} of {of} instants{reactions}; the estimate, the energies (`balance`), the contact \
         results, the true error and motion by the scheme need all steps: run again without `every`, `times` and \
         `fields` of the history, or take the estimate that `percute run` makes during the run, which uses all steps"
    )]
    Thinned { held: usize, of: usize, reactions: &'static str },
    /// A shape that the stored bytes cannot fill.
    #[error("`{name}` has the shape {given:?}, but only {stored} bytes are stored in this file for it")]
    Hollow { name: String, given: Vec<usize>, stored: u64 },
    /// More than memory can hold.
    #[error("`{name}` needs {bytes} bytes, which cannot be allocated in memory")]
    TooLarge { name: String, bytes: u64 },
    /// NaN or infinity in a field over time.
    #[error("`{name}` is {value} at step {step}, node {node}; all values must be finite")]
    NotFinite { name: String, step: usize, node: usize, value: f64 },
    /// Contact at a node that cannot touch.
    #[error(
        "node {node} touches or has a reaction at step {step}, but no obstacle of the problem can touch it; \
         `percute/contact` and the statement of the problem must agree"
    )]
    Contact { step: usize, node: usize },
    /// Invalid instants.
    #[error("`{name}`: {cause}")]
    Times { name: String, cause: TimeError },
    /// An invalid mesh.
    #[error("the mesh: {0}")]
    Mesh(#[from] MeshError),
    /// A step that does not fit the file.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A problem on another mesh.
    #[error("the mesh of the problem has {given} {what}, but {needed} are needed")]
    Problem { what: &'static str, given: usize, needed: usize },
}

impl FileCause {
    /// Whether the cause is the system, not the input.
    #[must_use]
    pub fn is_of_the_system(&self) -> bool {
        matches!(
            self,
            Self::InUse
                | Self::Create { .. }
                | Self::NoSpace { .. }
                | Self::Limit { .. }
                | Self::Write { .. }
                | Self::Finish { .. }
                | Self::Lost { .. }
                | Self::Read { .. }
                | Self::Replaced
                | Self::TooLarge { .. }
        )
    }

    /// Adds the file to the cause.
    #[must_use]
    pub fn at(self, path: &Path) -> FileError {
        FileError { path: path.to_path_buf(), cause: self }
    }
}
