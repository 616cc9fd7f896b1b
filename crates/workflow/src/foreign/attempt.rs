//! Changes of a history that are tried.

use crate::message::percent;

/// A change must leave less than this share of the residual to be named.
pub(super) const FALL: f64 = 0.2;
/// Changes that leave this share of what the best one leaves are as good: the simplest is named.
const AS_GOOD: f64 = 2.0;
/// So is one that leaves no more than this share of the residual.
const ALL: f64 = 1e-3;
/// Norms below this are rounding of sums of squares.
pub(super) const ROUNDING: f64 = 1e-6;

/// A change with the norm of the residual before and after it.
#[derive(Clone, Debug)]
pub(super) struct Attempt {
    pub(super) text: String,
    pub(super) before: f64,
    pub(super) left: f64,
}

impl Attempt {
    /// Whether it leaves little of the residual.
    pub(super) fn explains(&self) -> bool {
        self.left <= FALL * self.before
    }

    /// The share that it leaves.
    fn share(&self) -> f64 {
        self.left / self.before
    }

    /// What it is, and what it does.
    pub(super) fn told(&self) -> String {
        format!(
            "{}; with that the norm of the residual over all nodes and instants falls {}",
            self.text,
            falls(self.before, self.left)
        )
    }
}

/// From a figure to another.
pub(super) fn falls(before: f64, left: f64) -> String {
    let left = if left < ROUNDING { "less than 1e-4 %".to_string() } else { percent(left) };
    format!("from {} to {left}", percent(before))
}

/// The change that explains the residual; of equally good ones the first.
pub(super) fn best(attempts: Vec<Attempt>) -> Option<Attempt> {
    let least = attempts.iter().map(Attempt::share).fold(f64::INFINITY, f64::min);
    attempts.into_iter().find(|one| one.explains() && one.share() <= (AS_GOOD * least).max(ALL))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attempt(text: &str, left: f64) -> Attempt {
        Attempt { text: text.to_string(), before: 1.0, left }
    }

    #[test]
    fn the_simplest_of_equally_good_changes_is_named() {
        let named = |all: Vec<Attempt>| best(all).map(|one| one.text);
        assert_eq!(named(vec![attempt("one", 0.15), attempt("two", 0.1)]), Some("one".to_string()));
        assert_eq!(named(vec![attempt("one", 0.15), attempt("two", 0.01)]), Some("two".to_string()));
        assert_eq!(named(vec![attempt("one", 5e-4), attempt("two", 0.0)]), Some("one".to_string()));
        assert_eq!(named(vec![attempt("one", 0.5), attempt("two", 0.3)]), None);
        assert!(attempt("one", 1e-9).told().ends_with("from 100 % to less than 1e-4 %"));
    }
}
