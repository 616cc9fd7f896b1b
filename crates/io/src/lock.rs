//! Files under a lock.

use crate::error::FileCause;
use percute_system::{is_at, name_of, try_lock, try_lock_shared, unlock};
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How often a reader asks for its lock, and how long it waits before it asks again: a file that another process is
/// about to replace is locked for a moment.
const ASKED: usize = 40;
const PAUSE: Duration = Duration::from_millis(5);

/// A file that is locked. The lock is given back in so many words: closing alone leaves it with any child
/// process that was forked meanwhile, and this one might then find its own file in use. For the same
/// reason HDF5 takes no locks of its own here.
#[derive(Debug)]
pub(crate) struct LockedFile(File);

impl LockedFile {
    /// Others may read.
    pub(crate) fn shared(file: File) -> Result<Self, FileCause> {
        for _ in 1..ASKED {
            match try_lock_shared(&file) {
                Err(TryLockError::WouldBlock) => std::thread::sleep(PAUSE),
                lock => return taken(lock).map(|()| Self(file)),
            }
        }
        taken(try_lock_shared(&file)).map(|()| Self(file))
    }

    /// It is held here alone.
    pub(crate) fn alone(file: File) -> Result<Self, FileCause> {
        taken(try_lock(&file)).map(|()| Self(file))
    }

    /// Lets others read.
    pub(crate) fn share(self) -> Result<Self, FileCause> {
        taken(try_lock_shared(&self.0)).map(|()| self)
    }

    pub(crate) fn file(&self) -> &File {
        &self.0
    }

    /// Whether this file is the one at a path.
    pub(crate) fn is_at(&self, path: &Path) -> bool {
        is_at(&self.0, path)
    }

    /// The path of the file: `path`, or where it has been moved to. None if it was removed or replaced, or if the
    /// system does not tell.
    pub(crate) fn place(&self, path: &Path) -> Option<PathBuf> {
        if self.is_at(path) { Some(path.to_path_buf()) } else { name_of(&self.0).filter(|now| self.is_at(now)) }
    }
}

/// File systems without locks go without.
fn taken(lock: Result<(), TryLockError>) -> Result<(), FileCause> {
    match lock {
        Err(TryLockError::WouldBlock) => Err(FileCause::InUse),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
    }
}

impl Drop for LockedFile {
    fn drop(&mut self) {
        unlock(&self.0);
    }
}
