//! Files under a lock.

use crate::error::FileCause;
use std::fs::{File, TryLockError};

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

    /// Nobody else has it.
    pub(crate) fn alone(file: File) -> Result<Self, FileCause> {
        taken(file.try_lock()).map(|()| Self(file))
    }

    pub(crate) fn file(&self) -> &File {
        &self.0
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
