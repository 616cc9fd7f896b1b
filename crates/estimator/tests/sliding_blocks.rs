//! Two blocks whose meshes do not match: the estimate against a finer run.

use crate::common::finer::indices;
use percute_core::contact::Interface;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_testkit::{rotated, translated};

/// Blocks of 40 × 25 mm, plane stress, a gap of 50 µm and T = 14 µs; steps of 0.9 Δt_c.
const GAP: f64 = 50e-6;
const END: f64 = 14e-6;
const HEIGHT: f64 = 0.025;

/// Cells of the lower and of the upper block.
type Cells = [[usize; 2]; 2];

/// Meshes, and the one of the reference, which has all their edges.
const MESHES: [(Cells, Cells); 4] = [
    ([[7, 6], [10, 8]], [[112, 96], [120, 96]]),
    ([[14, 11], [20, 16]], [[112, 88], [120, 96]]),
    ([[20, 16], [20, 16]], [[120, 96], [120, 96]]),
    ([[28, 22], [40, 32]], [[112, 88], [120, 96]]),
];

/// e_sup/e_ref and e_mean/e_ref that an independent prototype of the method gave on these meshes. It has no body that
/// enters on the last one: there it is that of the mesh before.
struct Row {
    name: &'static str,
    /// Of the upper and the lower block (m/s).
    velocities: [[f64; 2]; 2],
    friction: f64,
    steel: bool,
    /// Width of the upper block, and how far it is to the right (m).
    width: f64,
    aside: f64,
    tilt: f64,
    gap: f64,
    /// Whether velocities are in proportion to the distance from the interface: from 0 there to these at the height of
    /// a block. All meshes have the same ones.
    smooth: bool,
    expected: [[f64; 2]; 4],
}

const HEAD_ON: Row = Row {
    name: "head-on",
    velocities: [[0.0, -20.0], [0.0, 20.0]],
    friction: 0.0,
    steel: false,
    width: 0.04,
    aside: 0.0,
    tilt: 0.0,
    gap: GAP,
    smooth: false,
    expected: [[1.14, 1.19], [1.11, 1.15], [1.12, 1.14], [1.13, 1.14]],
};

const ROWS: [Row; 8] = [
    HEAD_ON,
    Row {
        name: "oblique",
        velocities: [[8.0, -20.0], [0.0, 20.0]],
        friction: 0.2,
        expected: [[1.17, 1.2], [1.12, 1.15], [1.12, 1.14], [1.13, 1.14]],
        ..HEAD_ON
    },
    Row {
        name: "slides at 150 m/s",
        velocities: [[150.0, -20.0], [0.0, 20.0]],
        friction: 0.2,
        expected: [[1.18, 1.24], [1.14, 1.19], [1.13, 1.19], [1.14, 1.18]],
        ..HEAD_ON
    },
    Row {
        name: "enters at 400 m/s",
        velocities: [[400.0, -20.0], [0.0, 20.0]],
        friction: 0.2,
        aside: -0.012,
        expected: [[1.52, 1.47], [1.48, 1.42], [1.52, 1.48], [1.52, 1.48]],
        ..HEAD_ON
    },
    Row {
        name: "narrow",
        velocities: [[0.0, -20.0], [0.0, 20.0]],
        friction: 0.2,
        width: 0.02,
        aside: 0.0113,
        expected: [[1.25, 1.3], [1.2, 1.24], [1.25, 1.29], [1.19, 1.23]],
        ..HEAD_ON
    },
    Row {
        name: "steel below",
        velocities: [[0.0, -20.0], [0.0, 20.0]],
        friction: 0.2,
        steel: true,
        expected: [[1.16, 1.21], [1.14, 1.17], [1.11, 1.14], [1.12, 1.16]],
        ..HEAD_ON
    },
    Row {
        name: "tilted",
        velocities: [[0.0, -200.0], [0.0, 200.0]],
        friction: 0.2,
        tilt: 3.0,
        expected: [[1.14, 1.13], [1.17, 1.14], [1.16, 1.12], [1.28, 1.21]],
        ..HEAD_ON
    },
    Row {
        name: "touching from the start",
        velocities: [[0.0, -20.0], [0.0, 20.0]],
        friction: 0.2,
        gap: 0.0,
        smooth: true,
        expected: [[1.13, 1.31], [1.18, 1.38], [1.35, 1.46], [1.25, 1.46]],
        ..HEAD_ON
    },
];

impl Row {
    fn problem(&self, [lower, upper]: Cells) -> Problem<2> {
        let block = |width: f64, cells: [usize; 2]| Mesh::rectangle(width, HEIGHT, cells[0], cells[1]).unwrap();
        let upper = rotated(&block(self.width, upper), self.tilt.to_radians()).unwrap();
        let low = upper.points_in::<2>().iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        let upper = translated(&upper, [self.aside, HEIGHT + self.gap - low]).unwrap();
        let mesh = Mesh::joined(&[("upper", &upper), ("lower", &block(0.04, lower))]).unwrap();
        let velocity = |i: usize| {
            let far = (mesh.points_in::<2>()[i][1] - HEIGHT).abs() / HEIGHT;
            self.velocities[usize::from(i >= upper.node_count())].map(|v| if self.smooth { far * v } else { v })
        };
        let aluminium = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
        let steel = Elastic::plane_stress(210e9, 0.3, 7800.0, 1.0).unwrap();
        let velocity = (0..mesh.node_count()).map(velocity).collect();
        Problem::<2>::builder(mesh)
            .material_of("upper", aluminium)
            .material_of("lower", if self.steel { steel } else { aluminium })
            .initial_velocity(Initial::Nodal(velocity))
            .interface(Interface::non_matching(2, "upper.bottom", "lower.top", self.friction).unwrap())
            .build()
            .unwrap()
    }

    fn indices(&self, mesh: Cells, reference: Cells) -> [f64; 2] {
        let narrow = |[lower, [along, across]]: Cells| [lower, [(along as f64 * self.width / 0.04) as usize, across]];
        let [mesh, reference] = [mesh, reference].map(|cells| self.problem(narrow(cells)));
        indices(&[mesh], &reference, END)[0]
    }
}

/// At least 1, and at most 0.05 above the prototype. Of bodies that touch from the start, the velocities of the
/// prototype are not known, and waves without a front have an index closer to 1: at least 0.95. Where a surface ends on
/// an edge of the other one, or enters beside it, indices are smaller by up to 0.32: the stress in the star of a node
/// has less energy than that in an edge's element, and both surfaces give way, only while it is needed.
#[test]
#[ignore = "takes a minute"]
fn effectivity_indices_against_a_finer_reference() {
    for row in &ROWS {
        for ((mesh, reference), expected) in MESHES.into_iter().zip(&row.expected) {
            let found = row.indices(mesh, reference);
            println!("{}: {:.3} {:.3} ({expected:?})", row.name, found[0], found[1]);
            let least = if row.smooth { 0.95 } else { 1.0 };
            let near = found.iter().zip(expected).all(|(found, most)| (least..=most + 0.05).contains(found));
            assert!(near, "{}: {found:?} {expected:?}", row.name);
        }
    }
}

/// Two of them at each test, on the coarse mesh.
#[test]
fn effectivity_indices_of_two_blocks_that_slide() {
    for row in &ROWS[1..3] {
        // Against a reference half as fine, both are larger by up to 0.02 than above.
        let found = row.indices(MESHES[0].0, [[56, 48], [60, 48]]);
        let near = found.iter().zip(&row.expected[0]).all(|(found, most)| (1.0..=most + 0.05).contains(found));
        assert!(near, "{}: {found:?} {:?}", row.name, row.expected[0]);
    }
}

/// A block on its corner (10°) at three speeds: measured are 1.36 to 1.39, 1.35 to 1.40 and 1.47 to 1.56. With
/// tractions as wide as edges it would be 10 to 25 at the lowest speed.
#[test]
fn effectivity_indices_of_a_corner_that_slides() {
    for (speed, most) in [(100.0, 1.5), (10.0, 1.5), (1.0, 1.7)] {
        let velocities = [[0.0, -speed], [0.0, speed]];
        let place = Row { width: 0.02, aside: 0.0113, tilt: 10.0, friction: 0.2, ..HEAD_ON };
        let row = Row { name: "corner", velocities, gap: 2e-6 * speed, ..place };
        let found = row.indices(MESHES[0].0, [[56, 48], [60, 48]]);
        println!("{speed} m/s: {found:?}");
        assert!(found.iter().all(|index| (1.0..=most).contains(index)), "{speed} m/s: {found:?}");
    }
}
