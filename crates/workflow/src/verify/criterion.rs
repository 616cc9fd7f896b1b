//! Whether the finest mesh is fine enough to be a reference.

use super::levels::Level;
use serde::Serialize;

/// The most by which the finest mesh may make the effectivity index of the first mesh too large.
const LARGEST_EXCESS: f64 = 0.1;

/// The error of the finest mesh itself, and its effect on the effectivity index of the first mesh.
///
/// If the errors of two meshes were orthogonal in the energy norm, with e_k ~ h^p, the difference E of the two finest meshes would be
/// E² = e_{L−1}² − e_L² = (4^p − 1) e_L², and the true error of the first mesh √(E_0² + e_L²). Errors of wave fronts are more alike
/// than that: in the evidence the excess is a third to a half of this value, which is an upper limit in practice, not a bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Settled {
    /// Expected mean error of the finest mesh (J^½).
    pub finest_error: f64,
    /// By how much the effectivity index of the first mesh may be too large, relative.
    pub excess: f64,
    /// Whether that is at most 0.1.
    pub fine_enough: bool,
}

impl Settled {
    /// None without two meshes, or if the estimate does not fall.
    pub(super) fn new(levels: &[Level], order: Option<f64>) -> Option<Self> {
        let (errors, order) = (levels.iter().filter_map(|level| level.error.map(|e| e.mean)), order?);
        let errors: Vec<f64> = errors.collect();
        let (first, last) = (errors.first()?, errors.last()?);
        let finest_error = last / (4.0_f64.powf(order) - 1.0).sqrt();
        let excess = (1.0 + (finest_error / first).powi(2)).sqrt() - 1.0;
        Some(Self { finest_error, excess, fine_enough: excess <= LARGEST_EXCESS })
    }
}

/// p from values that fall like h^p on meshes of which the second is twice as fine; none if they do not fall.
pub(super) fn order(coarse: f64, fine: f64) -> Option<f64> {
    let order = (coarse / fine).log2();
    (order.is_finite() && order > 0.0).then_some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_fall_have_an_order() {
        assert_eq!(order(4.0, 1.0), Some(2.0));
        // Differences of opposite sign, and values that grow or stand still.
        for (coarse, fine) in [(-4.0, 1.0), (1.0, 2.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)] {
            assert_eq!(order(coarse, fine), None);
        }
    }
}
