//! The kind of a file.

use crate::error::{FileCause, FileError};
use crate::read::Opened;
use std::fmt;
use std::path::Path;

/// The kind of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A history.
    History,
    /// An estimate.
    Estimate,
    /// HDF5 of another program.
    OtherHdf5,
    /// Not HDF5 at all.
    Other,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::History => "a history",
            Self::Estimate => "an estimate",
            Self::OtherHdf5 => "an HDF5 file of another program",
            Self::Other => "not an HDF5 file",
        })
    }
}

/// Determines the kind of a file by its first bytes and its attribute `kind`.
///
/// # Errors
/// A file that is missing, locked, damaged or cannot be read.
pub fn kind(path: impl AsRef<Path>) -> Result<Kind, FileError> {
    let path = path.as_ref();
    let found = Opened::new(path).and_then(|opened| opened.kind());
    match found {
        Err(FileCause::NotHdf5 | FileCause::Empty) => Ok(Kind::Other),
        Err(FileCause::Foreign { .. }) => Ok(Kind::OtherHdf5),
        found => found.map_err(|cause| cause.at(path)),
    }
}
