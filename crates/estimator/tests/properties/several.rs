//! A block on two blocks: a non-matching interface with two bodies.

use crate::properties::bodies::{aluminium, steps};
use crate::properties::estimating::{assert_admissible, estimate, history};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Between, Contact, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Options, Sampling};
use percute_testkit::{Random, translated};

const GAP: f64 = 50e-6;
const HEIGHT: f64 = 0.025;
/// Between the lower blocks (m).
const SLIT: f64 = 20e-6;

/// The upper block and those below it at the left and at the right.
#[derive(Clone, Copy)]
struct Three {
    cells: [[usize; 2]; 3],
    /// How far the slit is to the right of the middle (m).
    aside: f64,
    velocities: [[f64; 2]; 3],
    friction: f64,
    right: Elastic,
}

impl Three {
    fn oblique() -> Self {
        let velocities = [[8.0, -20.0], [0.0, 20.0], [0.0, 20.0]];
        Self { cells: [[20, 16], [7, 11], [9, 12]], aside: 0.0, velocities, friction: 0.2, right: aluminium() }
    }

    fn problem(&self) -> Problem<2> {
        let width = 0.02 - 0.5 * SLIT;
        let block = |k: usize, width: f64, at: [f64; 2]| {
            let mesh = Mesh::rectangle(width, HEIGHT, self.cells[k][0], self.cells[k][1]).unwrap();
            translated(&mesh, at).unwrap()
        };
        let blocks = [
            block(0, 0.04, [0.0, HEIGHT + GAP]),
            block(1, width + self.aside, [0.0, 0.0]),
            block(2, width - self.aside, [width + self.aside + SLIT, 0.0]),
        ];
        let named: Vec<(&str, &Mesh)> = ["upper", "left", "right"].into_iter().zip(&blocks).collect();
        let velocity = (0..3).flat_map(|k| vec![self.velocities[k]; blocks[k].node_count()]).collect();
        let contact = |below: &str| {
            let groups = Between::Groups(["upper.bottom".to_string(), below.to_string()]);
            Contact::new(2, groups, self.friction, None).unwrap()
        };
        Problem::<2>::builder(Mesh::joined(&named).unwrap())
            .material_of("upper", aluminium())
            .material_of("left", aluminium())
            .material_of("right", self.right)
            .initial_velocity(Initial::Nodal(velocity))
            .contact(contact("left.top"))
            .contact(contact("right.top"))
            .build()
            .unwrap()
    }
}

#[test]
fn everything_is_admissible() {
    let oblique = Three::oblique();
    let steel = Elastic::plane_stress(210e9, 0.3, 7800.0, 1.0).unwrap();
    let cases = [
        oblique,
        Three { velocities: [[0.0, -20.0], [0.0, 20.0], [0.0, 20.0]], friction: 0.0, ..oblique },
        Three { aside: 1.7e-3, right: steel, ..oblique },
        Three { velocities: [[150.0, -20.0], [0.0, 20.0], [0.0, 20.0]], ..oblique },
        // The lower ones come apart, and one of them is faster.
        Three { velocities: [[8.0, -20.0], [-5.0, 20.0], [5.0, 10.0]], ..oblique },
    ];
    for (k, case) in cases.iter().enumerate() {
        let problem = case.problem();
        let times = steps(&problem, 0.9, 90);
        let made = estimate(&problem, &history(&problem, &times), Options::default());
        assert_admissible(&format!("case {k}"), &made);
    }
}

/// Any meshes, speeds and places of the slit.
#[test]
fn any_three_blocks_are_admissible() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let cells = [(); 3].map(|()| [1 + random.bits() as usize % 7, 1 + random.bits() as usize % 4]);
        let speed = 10.0_f64.powf(random.between(-1.0, 2.5));
        let below = |random: &mut Random| [random.between(-0.3 * speed, 0.3 * speed), random.between(0.0, speed)];
        let velocities = [[random.between(-speed, speed), -speed], below(&mut random), below(&mut random)];
        let case = Three {
            cells,
            aside: random.between(-0.015, 0.015),
            velocities,
            friction: random.between(0.0, 0.8),
            right: aluminium(),
        };
        let problem = case.problem();
        let critical = steps(&problem, 1.0, 1).end();
        let count = 60;
        let way = 3.0 * GAP / speed;
        let step = (way / f64::from(count)).min(random.between(0.3, 0.95) * critical);
        let times = TimeGrid::uniform(step * f64::from(count), count as usize).unwrap();
        let made = estimate(&problem, &history(&problem, &times), Options::default());
        assert_admissible(&format!("seed {seed}"), &made);
    }
}

/// Threads and windows do not matter a bit.
#[test]
fn threads_and_windows_do_not_matter() {
    let problem = Three::oblique().problem();
    let history = history(&problem, &steps(&problem, 0.9, 60));
    let with = |threads, window| {
        let every = Sampling::Every(1);
        estimate(&problem, &history, Options { threads, window, every, ..Options::default() }).error
    };
    let expected = with(None, None);
    for (threads, window) in [(1, 1), (2, 3), (3, 8)] {
        assert_eq!(with(Some(threads), Some(window)), expected, "{threads} {window}");
    }
}
