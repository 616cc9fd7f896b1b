//! The triangle of three nodes.

use super::{Cell, CellKind, Child, Triangle};
use std::f64::consts::PI;

impl Cell<2, 3> for Triangle {
    fn kind(&self) -> CellKind {
        CellKind::Triangle
    }

    fn signed_volume(&self, points: &[[f64; 2]; 3]) -> f64 {
        let edge = |k: usize, c: usize| points[k][c] - points[0][c];
        0.5 * (edge(1, 0) * edge(2, 1) - edge(2, 0) * edge(1, 1))
    }

    /// The opposite edge turned by a quarter, over twice the area.
    fn gradient(&self, points: &[[f64; 2]; 3], volume: f64, k: usize) -> [f64; 2] {
        let (a, b) = (&points[(k + 1) % 3], &points[(k + 2) % 3]);
        [(a[1] - b[1]) / (2.0 * volume), (b[0] - a[0]) / (2.0 * volume)]
    }

    /// The normals of all edges.
    fn separating_directions(&self, a: &[[f64; 2]; 3], b: &[[f64; 2]; 3]) -> Vec<[f64; 2]> {
        let normal = |[p, q]: [&[f64; 2]; 2]| [q[1] - p[1], p[0] - q[0]];
        [a, b].into_iter().flat_map(|t| [[&t[0], &t[1]], [&t[1], &t[2]], [&t[2], &t[0]]]).map(normal).collect()
    }

    fn faces_around(&self) -> [[Option<usize>; 2]; 3] {
        [[Some(2), Some(1)], [Some(0), Some(2)], [Some(1), Some(0)]]
    }

    fn angle_around(&self, points: &[[f64; 2]; 3], nodes: &[usize]) -> f64 {
        match *nodes {
            [k] => {
                let side = |to: usize| [0, 1].map(|c| points[to % 3][c] - points[k][c]);
                let (a, b) = (side(k + 1), side(k + 2));
                (a[0] * b[1] - a[1] * b[0]).abs().atan2(a[0] * b[0] + a[1] * b[1])
            }
            [_, _] => PI,
            _ => 2.0 * PI,
        }
    }

    fn children(&self) -> &'static [Child<3>] {
        &[[[0, 0], [0, 1], [0, 2]], [[0, 1], [1, 1], [1, 2]], [[0, 2], [1, 2], [2, 2]], [[0, 1], [1, 2], [0, 2]]]
    }

    fn face_children(&self) -> &'static [Child<2>] {
        &[[[0, 0], [0, 1]], [[0, 1], [1, 1]]]
    }
}
