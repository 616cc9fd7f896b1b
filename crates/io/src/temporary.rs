//! Files under a temporary name. Each is locked by its process, so that one without a lock is known to be left behind.

use crate::unfinished::Unfinished;
use percute_system::{is_at, permissions, try_lock, try_lock_shared};
use std::fs::File;
use std::io;
use std::path::Path;
use tempfile::NamedTempFile;

/// How their names begin.
const PREFIX: &str = ".percute-";

/// Creates a file under a temporary name, which is removed unless it is renamed, and removes those that killed
/// processes left in its folder.
///
/// # Errors
/// Whatever the system reports.
pub(crate) fn temporary(folder: &Path) -> io::Result<(NamedTempFile, Unfinished)> {
    remove_left_behind(folder);
    loop {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        permissions().into_iter().for_each(|permissions| _ = builder.permissions(permissions));
        let made = builder.tempfile_in(folder)?;
        // Another process may have taken it for one that was left behind, until it was locked.
        let locked = try_lock_shared(made.as_file());
        if matches!(locked, Err(std::fs::TryLockError::WouldBlock)) || !is_at(made.as_file(), made.path()) {
            continue;
        }
        let unfinished = Unfinished::new(made.path());
        return Ok((made, unfinished));
    }
}

/// Makes sure that files can be created in a folder.
///
/// # Errors
/// Whatever the system reports.
pub(crate) fn probe(folder: &Path) -> io::Result<()> {
    tempfile::Builder::new().prefix(PREFIX).tempfile_in(folder).map(drop)
}

/// What cannot be removed stays, and does no harm.
fn remove_left_behind(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let ours = entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX));
        if !ours || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let path = entry.path();
        // File systems without locks refuse one: nothing is known of the file then.
        let Ok(file) = File::open(&path) else { continue };
        if try_lock(&file).is_ok() {
            // Locked until it is gone: its process may be about to lock it.
            let _ = std::fs::remove_file(&path);
        }
    }
}
