//! The bar of two nodes.

use super::{Bar, Cell, CellKind, Child};

impl Cell<1, 2> for Bar {
    fn kind(&self) -> CellKind {
        CellKind::Bar
    }

    fn signed_volume(&self, [a, b]: &[[f64; 1]; 2]) -> f64 {
        b[0] - a[0]
    }

    fn gradient(&self, _: &[[f64; 1]; 2], volume: f64, _: usize) -> [f64; 1] {
        [1.0 / volume]
    }

    fn separating_directions(&self, _: &[[f64; 1]; 2], _: &[[f64; 1]; 2]) -> Vec<[f64; 1]> {
        vec![[1.0]]
    }

    /// From left to right.
    fn faces_around(&self) -> [[Option<usize>; 2]; 2] {
        [[Some(1), None], [None, Some(0)]]
    }

    fn angle_around(&self, _: &[[f64; 1]; 2], _: &[usize]) -> f64 {
        1.0
    }

    fn children(&self) -> &'static [Child<2>] {
        &[[[0, 0], [0, 1]], [[0, 1], [1, 1]]]
    }

    fn face_children(&self) -> &'static [Child<1>] {
        &[[[0, 0]]]
    }
}
