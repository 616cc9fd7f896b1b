//! Room to work that is used again.

use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Room that is not in use: as much as was in use at a time.
pub(crate) struct Pool<T>(Mutex<Vec<T>>);

impl<T> Pool<T> {
    pub(crate) fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// Gives a task room, with any content.
    pub(crate) fn lend<R>(&self, new: impl FnOnce() -> T, task: impl FnOnce(&mut T) -> R) -> R {
        let free = self.lock().pop();
        let mut room = free.unwrap_or_else(new);
        let result = task(&mut room);
        self.lock().push(room);
        result
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<T>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> fmt::Debug for Pool<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pool").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Room inside room is another one; afterwards both are used again.
    #[test]
    fn room_is_used_again() {
        let pool = Pool::new();
        let new = || vec![0; 3];
        let places = pool.lend(new, |a| pool.lend(new, |b| [a.as_ptr(), b.as_ptr()]));
        assert_ne!(places[0], places[1]);
        let again = pool.lend(new, |a| pool.lend(new, |b| [a.as_ptr(), b.as_ptr()]));
        assert_eq!(places, again);
    }
}
