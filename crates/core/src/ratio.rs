//! A part of a whole.

/// `part` over `corrected`, and 0 where there is no whole: no error of nothing, no drift without energy.
#[must_use]
pub fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}
