//! Changes of a history that are tried.

/// A change must leave less than this share of the residual to be named.
pub(super) const FALL: f64 = 0.2;

/// A change with what it leaves of the residual.
pub(super) struct Tried {
    pub(super) text: String,
    pub(super) left: f64,
}
