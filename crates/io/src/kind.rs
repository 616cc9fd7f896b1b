//! The kind of a file.

use percute_system::is_pipe;
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

/// Whether a path is that of a pipe with a name of its own: whoever opens it waits for a writer, perhaps for ever. A
/// pipe that a shell has opened, as for `<(command)`, has a writer.
#[must_use]
pub fn is_named_pipe(path: &Path) -> bool {
    let opened = ["/dev", "/proc"].iter().any(|folder| path.starts_with(folder));
    !opened && path.metadata().is_ok_and(|found| is_pipe(found.file_type()))
}

/// Whether ParaView recognises a file of this name as VTKHDF: by its ending, `.vtkhdf`.
#[must_use]
pub fn is_vtkhdf_name(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("vtkhdf"))
}
