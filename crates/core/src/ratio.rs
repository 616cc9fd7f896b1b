//! A ratio with a safe zero.

/// `part` over `whole`; 0 if `whole` is not positive: a body without energy has neither a relative error nor a drift.
#[must_use]
pub fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}
