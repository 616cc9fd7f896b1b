//! A block on two blocks: a non-matching interface with two bodies.

use super::law::{check_energy, check_steps};
use super::setup::{GAP, HEIGHT, steel, steps};
use crate::solution::run::{Run, aluminium, run};
use percute_core::contact::Obstacle;
use percute_core::mesh::Mesh;
use percute_core::problem::{Between, Contact, Initial, Problem};
use percute_testkit::translated;

/// Distance between the lower blocks (m).
const SLIT: f64 = 20e-6;

/// The upper block and those below it at the left and at the right.
#[derive(Clone, Copy)]
struct Three {
    /// Cells along and across.
    cells: [[usize; 2]; 3],
    /// How far the slit is to the right of the middle (m).
    aside: f64,
    /// Velocities (m/s).
    velocities: [[f64; 2]; 3],
    friction: f64,
    /// Whether the contact with the right block is stated first.
    right_first: bool,
}

const OBLIQUE: Three = Three {
    cells: [[20, 16], [7, 12], [9, 11]],
    aside: 0.0,
    velocities: [[8.0, -20.0], [0.0, 20.0], [0.0, 20.0]],
    friction: 0.2,
    right_first: false,
};

impl Three {
    fn problem(&self, on_floor: bool) -> Problem<2> {
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
            let groups = Between::Groups(["upper.bottom".to_string(), format!("{below}.top")]);
            Contact::new(2, groups, self.friction, None).unwrap()
        };
        let [first, second] = if self.right_first { ["right", "left"] } else { ["left", "right"] };
        let mut builder = Problem::<2>::builder(Mesh::joined(&named).unwrap())
            .material_of("upper", aluminium())
            .material_of("left", aluminium())
            .material_of("right", steel())
            .initial_velocity(Initial::Nodal(velocity))
            .contact(contact(first))
            .contact(contact(second));
        for group in ["left.bottom", "right.bottom"].into_iter().filter(|_| on_floor) {
            builder = builder.obstacle(Obstacle::plane([0.0; 2], [0.0, 1.0], 0.2, Some(group.into())).unwrap());
        }
        builder.build().unwrap()
    }
}

/// The displacements at the last instant.
fn last(run: &Run<'_, 2>) -> Vec<[f64; 2]> {
    run.displacement(run.last()).to_vec()
}

fn difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.as_flattened().iter().zip(b.as_flattened()).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

#[test]
fn the_law_of_contact_momentum_and_energy_hold() {
    let cases = [
        OBLIQUE,
        Three { velocities: [[0.0, -20.0], [0.0, 20.0], [0.0, 20.0]], friction: 0.0, ..OBLIQUE },
        Three { aside: 1.7e-3, friction: 0.5, ..OBLIQUE },
        // The lower ones come apart, and one of them is faster.
        Three { velocities: [[8.0, -20.0], [-5.0, 20.0], [5.0, 10.0]], ..OBLIQUE },
    ];
    for (k, case) in cases.iter().enumerate() {
        let problem = case.problem(false);
        assert_eq!(problem.surface().non_matching()[0].slave().parts().len(), 2);
        let run = run(&problem, &steps(&problem, 14e-6));
        let seen = check_steps(&run);
        check_energy(&run);
        assert!(seen.reactions > 500, "{k}: {seen:?}");
    }
}

/// D and M change within a step where bodies slide fast; the law and momentum hold all the same.
#[test]
fn a_block_may_slide_from_one_to_the_other() {
    let problem = Three { velocities: [[150.0, -20.0], [0.0, 20.0], [0.0, 20.0]], ..OBLIQUE }.problem(false);
    let run = run(&problem, &steps(&problem, 14e-6));
    let seen = check_steps(&run);
    assert!(seen.reactions > 500 && seen.slips > 500, "{seen:?}");
}

#[test]
fn the_order_of_contacts_does_not_matter() {
    let [one, two] = [false, true].map(|right_first| Three { right_first, ..OBLIQUE }.problem(false));
    let times = steps(&one, 14e-6);
    let [one, two] = [&one, &two].map(|problem| last(&run(problem, &times)));
    assert!(difference(&one, &two) == 0.0);
}

/// The lower blocks stand on a floor: other nodes of theirs touch it.
#[test]
fn the_lower_blocks_may_stand_on_a_floor() {
    let problem = Three { velocities: [[0.0, -20.0], [0.0; 2], [0.0; 2]], ..OBLIQUE }.problem(true);
    let run = run(&problem, &steps(&problem, 20e-6));
    let seen = super::law::check_law(&run);
    check_energy(&run);
    assert!(seen.reactions > 500, "{seen:?}");
}
