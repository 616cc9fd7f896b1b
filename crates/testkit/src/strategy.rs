//! Proptest strategies.

use crate::random_rectangle;
use percute_core::mesh::Mesh;
use proptest::prelude::*;

/// Unstructured rectangles with sides between 0.5 m and 2 m and 2 to `most` elements along the
/// width. Shrinking leads to few elements and the seed 0.
pub fn rectangle(most: usize) -> impl Strategy<Value = Mesh> {
    (2..=most.max(2), 0..1_000_u64, 0.5..2.0, 0.5..2.0)
        .prop_filter_map("no mesh without small angles", |(n, seed, width, height)| {
            random_rectangle(width, height, n, seed).ok()
        })
}

/// Angles (rad) of a whole turn.
pub fn angle() -> impl Strategy<Value = f64> {
    -std::f64::consts::PI..std::f64::consts::PI
}

#[cfg(test)]
mod tests {
    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..ProptestConfig::default() })]

        /// The diagonal of a box with sides from 0.5 to 2 lies between 0.5√2 and 2√2.
        #[test]
        fn rectangles_are_as_large_as_said(mesh in rectangle(6)) {
            let (low, high) = (0.5 * 2.0_f64.sqrt(), 2.0 * 2.0_f64.sqrt());
            prop_assert!(mesh.size() >= low && mesh.size() <= high);
            prop_assert!(mesh.element_count() >= 4);
        }
    }
}
