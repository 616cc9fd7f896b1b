//! How much work a reproduction does.

use percute_estimator::{Acceleration, Options, Reconstruction};

/// How much of a part is computed, and on how many threads. The small effort computes some of the rows of the full one:
/// those rows are the same, digit by digit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Whether a few seconds must do.
    pub small: bool,
    /// Threads of each estimate; by default one for each core. No number depends on it.
    pub threads: Option<usize>,
}

impl Effort {
    /// All of it.
    pub const FULL: Self = Self { small: false, threads: None };
    /// What continuous integration computes again.
    pub const SMALL: Self = Self { small: true, threads: None };

    /// The first `few` of a list for the small effort, else all of it.
    #[must_use]
    pub fn first<'a, T>(&self, few: usize, all: &'a [T]) -> &'a [T] {
        if self.small { &all[..few.min(all.len())] } else { all }
    }

    /// One of two settings.
    #[must_use]
    pub fn either<T>(&self, small: T, full: T) -> T {
        if self.small { small } else { full }
    }

    /// Options of an estimate with these choices.
    #[must_use]
    pub fn options(&self, reconstruction: Reconstruction, acceleration: Acceleration) -> Options {
        Options { reconstruction, acceleration, threads: self.threads, ..Options::default() }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.either("small", "full")
    }
}
