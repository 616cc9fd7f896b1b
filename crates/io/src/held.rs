//! Files under a lock.

use crate::error::FileCause;
use std::fs::{File, TryLockError};
use std::os::fd::AsRawFd;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// A file that is locked. The lock is given back in so many words: closing alone leaves it with any child
/// process that was forked meanwhile, and this one might then find its own file in use. For the same
/// reason HDF5 takes no locks of its own here.
#[derive(Debug)]
pub(crate) struct Held(File);

impl Held {
    /// Others may read.
    pub(crate) fn shared(file: File) -> Result<Self, FileCause> {
        taken(file.try_lock_shared()).map(|()| Self(file))
    }

    /// It is held here alone.
    pub(crate) fn alone(file: File) -> Result<Self, FileCause> {
        taken(file.try_lock()).map(|()| Self(file))
    }

    /// Lets others read.
    pub(crate) fn share(self) -> Result<Self, FileCause> {
        taken(self.0.try_lock_shared()).map(|()| self)
    }

    pub(crate) fn file(&self) -> &File {
        &self.0
    }

    /// Whether this file is the one at a path.
    pub(crate) fn is_at(&self, path: &Path) -> bool {
        Self::same(&self.0, path)
    }

    /// Whether an open file is the one at a path.
    pub(crate) fn same(file: &File, path: &Path) -> bool {
        let (Ok(mine), Ok(there)) = (file.metadata(), path.metadata()) else { return false };
        (mine.dev(), mine.ino()) == (there.dev(), there.ino())
    }

    /// The path of the file: `path`, or where it has been moved to. None if it was removed or replaced, or if the
    /// system does not tell.
    pub(crate) fn place(&self, path: &Path) -> Option<PathBuf> {
        let moved = || std::fs::read_link(format!("/proc/self/fd/{}", self.0.as_raw_fd())).ok();
        if self.is_at(path) { Some(path.to_path_buf()) } else { moved().filter(|now| self.is_at(now)) }
    }
}

/// File systems without locks go without.
fn taken(lock: Result<(), TryLockError>) -> Result<(), FileCause> {
    match lock {
        Err(TryLockError::WouldBlock) => Err(FileCause::InUse),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        let _ = self.0.unlock();
    }
}
