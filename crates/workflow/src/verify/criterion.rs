//! Whether the finest mesh is fine enough to be a reference, and orders of convergence.

use serde::Serialize;

/// The largest move of the true error of the first mesh from the last reference but one to the last, relative.
const LARGEST_MOVE: f64 = 0.1;

/// The effect of the finest mesh on the true error of the first.
///
/// The finest mesh has an error of its own. With fewer than half of it each time, the true error of the first mesh moves by less and less from
/// reference to reference, and the last reference is off by about the last move at most: in the evidence 5.53 %, then 2.42 %
/// (docs/verification.md, the cases and their references).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Settled {
    /// By how much the mean true error of the first mesh moves from the finest mesh but one to the finest, relative.
    pub moved: f64,
    /// Whether that is at most 0.1.
    pub fine_enough: bool,
}

impl Settled {
    /// From the mean true errors (J^½) of the first mesh against the finest mesh but one, and the finest.
    pub(super) fn new(before: f64, now: f64) -> Self {
        let moved = (now / before - 1.0).abs();
        Self { moved, fine_enough: moved <= LARGEST_MOVE }
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
    fn a_reference_settles_within_a_tenth() {
        assert!(Settled::new(1.0, 1.09).fine_enough && Settled::new(1.0, 0.91).fine_enough);
        assert!(!Settled::new(1.0, 1.11).fine_enough && !Settled::new(0.0, 1.0).fine_enough);
    }

    #[test]
    fn values_that_fall_have_an_order() {
        assert_eq!(order(4.0, 1.0), Some(2.0));
        // Differences of opposite sign, and values that grow or stand still.
        for (coarse, fine) in [(-4.0, 1.0), (1.0, 2.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)] {
            assert_eq!(order(coarse, fine), None);
        }
    }
}
