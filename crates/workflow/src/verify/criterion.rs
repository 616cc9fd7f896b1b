//! Whether the finest mesh is fine enough to be a reference, and orders of convergence.

use serde::Serialize;

/// The largest move of the true error of the first mesh from the last reference but one to the last, relative.
const LARGEST_MOVE: f64 = 0.1;

/// The effect of the finest mesh on the true error of the first.
///
/// The finest mesh has an error of its own. With fewer than half of it each time, the true error of the first mesh
/// moves by less and less from reference to reference, and the last reference is off by about the last move at most: in
/// the evidence 5.53 %, then 2.42 % (docs/verification.md, the cases and their references).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Settled {
    /// By how much the mean true error of the first mesh moves from the finest mesh but one to the finest, relative.
    pub moved: f64,
    /// Whether that is at most 0.1.
    pub fine_enough: bool,
}

impl Settled {
    /// From the mean true errors (J^½) of the first mesh against finer and finer ones; none with fewer than two, or
    /// without an error.
    pub(super) fn last(errors: &[f64]) -> Option<Self> {
        let [.., before, now] = errors else { return None };
        let moved = (now / before - 1.0).abs();
        (*before > 0.0 && *now > 0.0).then_some(Self { moved, fine_enough: moved <= LARGEST_MOVE })
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
        let fine_enough = |errors: &[f64]| Settled::last(errors).map(|settled| settled.fine_enough);
        assert_eq!([[9.0, 1.0, 1.09], [9.0, 1.0, 0.91]].map(|errors| fine_enough(&errors)), [Some(true); 2]);
        assert_eq!(fine_enough(&[9.0, 1.0, 1.11]), Some(false));
        for none in [&[][..], &[1.0], &[0.0, 1.0], &[0.0, 0.0]] {
            assert_eq!(fine_enough(none), None);
        }
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
