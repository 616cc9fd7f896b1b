//! The HDF5 library.

use crate::error::FileCause;
use std::sync::{Mutex, MutexGuard, PoisonError};

static USED: Mutex<()> = Mutex::new(());

/// Waits until nobody else in this process has a file open: the library refuses to open a file for
/// writing that it has open for reading. No handle outlives the guard, so that a run can end while
/// another thread looks at its file.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    USED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Version of the HDF5 library that is built in: files name it, so that what they hold can be explained.
pub fn hdf5_version() -> String {
    let (major, minor, release) = hdf5::library_version();
    format!("{major}.{minor}.{release}")
}

/// The innermost frame of the library's error stack: what went wrong, without the way there.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The library built in is the one that the bindings were made for; a system's older one is not taken in silence.
    #[test]
    fn the_library_is_the_bundled_one() {
        assert!(hdf5_version().starts_with("2."), "HDF5 {}", hdf5_version());
    }
}
