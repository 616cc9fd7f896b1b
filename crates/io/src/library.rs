//! The HDF5 library.

use crate::error::FileCause;
use std::io;
use std::sync::{Mutex, MutexGuard, PoisonError};

static USED: Mutex<()> = Mutex::new(());

/// Waits until no other thread of this process has a file open: the library refuses to open a file for
/// writing that it has open for reading. No handle outlives the guard, so a run can end during a read
/// of its file in another thread.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    USED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Version of the built-in HDF5 library, recorded in files.
pub fn hdf5_version() -> String {
    let (major, minor, release) = hdf5::library_version();
    format!("{major}.{minor}.{release}")
}

/// The innermost frame of the library's error stack: the cause without the call chain.
pub(crate) fn detail(error: &hdf5::Error) -> String {
    match error.stack() {
        Some(stack) => stack.last().map_or_else(|| "unknown".to_string(), |frame| frame.desc().to_string()),
        None => error.to_string(),
    }
}

/// A library error while reading.
pub(crate) fn damaged(error: hdf5::Error) -> FileCause {
    FileCause::Damaged { detail: detail(&error) }
}

/// A library error during the creation of the file.
pub(crate) fn refused(error: &hdf5::Error) -> FileCause {
    FileCause::Create { source: io::Error::other(detail(error)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The built-in library has the version of the bindings, not that of an older system library.
    #[test]
    fn the_library_is_the_bundled_one() {
        assert!(hdf5_version().starts_with("2."), "HDF5 {}", hdf5_version());
    }
}
