//! A body in the corner of two planes: the estimate against a finer run.

use crate::common::corner::{Corner, open_corner};
use crate::common::finer::indices;
use percute_core::problem::Problem;

/// A body on a mesh of so many cells, thrown into a corner.
struct Row {
    name: &'static str,
    problem: fn([usize; 2]) -> Problem<2>,
    /// Some 12 µs after the arrival at the second plane (s).
    end: f64,
    /// e_sup/e_ref and e_mean/e_ref on 10×8 and 20×16 cells that an independent prototype of the method gave, with a
    /// reference on 160×128 cells.
    expected: [[f64; 2]; 2],
}

const ROWS: [Row; 10] = [
    Row {
        name: "90°, (-400, -400) m/s",
        problem: |cells| Corner::of(90.0, [-400.0, -400.0], [0.2, 0.2], cells).problem(),
        end: 12.75e-6,
        expected: [[1.05, 1.15], [1.05, 1.08]],
    },
    Row {
        name: "90°, (-100, -60) m/s",
        problem: |cells| Corner::of(90.0, [-100.0, -60.0], [0.2, 0.2], cells).problem(),
        end: 15e-6,
        expected: [[1.04, 1.13], [1.05, 1.09]],
    },
    Row {
        name: "90°, (-100, -60) m/s, μ = 0.1, 0.4",
        problem: |cells| Corner::of(90.0, [-100.0, -60.0], [0.1, 0.4], cells).problem(),
        end: 15e-6,
        expected: [[1.01, 1.09], [1.02, 1.05]],
    },
    Row {
        name: "60°, (-400, -400) m/s",
        problem: |cells| Corner::of(60.0, [-400.0, -400.0], [0.2, 0.2], cells).problem(),
        end: 14e-6,
        expected: [[1.30, 1.25], [1.26, 1.25]],
    },
    Row {
        name: "60°, (-150, -60) m/s",
        problem: |cells| Corner::of(60.0, [-150.0, -60.0], [0.2, 0.2], cells).problem(),
        end: 15e-6,
        expected: [[1.45, 1.37], [1.30, 1.30]],
    },
    Row {
        name: "120°, (-400, -400) m/s",
        problem: |cells| Corner::of(120.0, [-400.0, -400.0], [0.2, 0.2], cells).problem(),
        end: 12.5e-6,
        expected: [[1.10, 1.16], [1.20, 1.22]],
    },
    Row {
        name: "120°, (-100, -40) m/s",
        problem: |cells| Corner::of(120.0, [-100.0, -40.0], [0.2, 0.2], cells).problem(),
        end: 14.8e-6,
        expected: [[1.13, 1.22], [1.20, 1.23]],
    },
    Row {
        name: "rectangle at 120°, (-400, -400) m/s",
        problem: |cells| open_corner(0.0, 400.0, cells),
        end: 12.5e-6,
        expected: [[1.09, 1.15], [1.14, 1.13]],
    },
    Row {
        name: "rectangle at 120°, (-40, -40) m/s",
        problem: |cells| open_corner(0.0, 40.0, cells),
        end: 12.5e-6,
        expected: [[1.13, 1.14], [1.21, 1.19]],
    },
    Row {
        name: "rectangle turned by 15°, (-40, -40) m/s",
        problem: |cells| open_corner(15.0_f64.to_radians(), 40.0, cells),
        end: 12.5e-6,
        expected: [[1.16, 1.14], [1.32, 1.23]],
    },
];

/// Percute has hats at the edges that leave a plane first, which lower the index. At 60 degrees it has other
/// diagonals, whose triangles of 120 degrees raise it. Against the same reference the index was 0.18 below to 0.1 above
/// that of the prototype. A reference of 80×64 cells raises it by up to 0.05 more.
const BELOW: f64 = 0.2;
const ABOVE: f64 = 0.15;

#[test]
fn effectivity_indices_in_a_corner() {
    for row in &ROWS {
        let fine = (row.problem)([80, 64]);
        row.check(&indices(&[(row.problem)([10, 8])], &fine, row.end));
    }
}

/// The same on two meshes with the reference of the prototype.
#[test]
#[ignore = "takes half a minute"]
fn effectivity_indices_against_a_finer_reference() {
    for row in &ROWS {
        let fine = (row.problem)([160, 128]);
        row.check(&indices(&[[10, 8], [20, 16]].map(row.problem), &fine, row.end));
    }
}

impl Row {
    fn check(&self, found: &[[f64; 2]]) {
        for (found, expected) in found.iter().zip(&self.expected) {
            println!("{}: {found:.3?} ({expected:?})", self.name);
            for (found, expected) in found.iter().zip(expected) {
                assert!((expected - BELOW..=expected + ABOVE).contains(found), "{}: {found} {expected}", self.name);
                assert!(*found >= 0.98, "{}: {found}", self.name);
            }
        }
    }
}
