//! The kind of a file.

use std::fmt;

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

/// Whether ParaView recognises a file of this name as VTKHDF: by its ending, `.vtkhdf`.
#[must_use]
pub fn is_vtkhdf_name(path: &std::path::Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("vtkhdf"))
}
