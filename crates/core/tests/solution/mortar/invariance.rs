//! Turned, mirrored, renumbered and exchanged bodies.

use super::setup::{Blocks, steps};
use crate::solution::run::{difference, largest, run};
use percute_core::contact::Interface;
use percute_core::problem::Problem;
use percute_testkit::{mirrored, renumbered, rotated};

const END: f64 = 14e-6;

/// The image of a problem under a map of places and velocities has the image of the solution.
fn is_invariant(blocks: Blocks, image: &Problem<2>, back: impl Fn([f64; 2]) -> [f64; 2]) {
    let problem = blocks.problem();
    let times = steps(&problem, END);
    let (straight, other) = (run(&problem, &times), run(image, &times));
    for n in 0..=straight.last() {
        let expected = straight.displacement(n);
        let found: Vec<[f64; 2]> = other.displacement(n).iter().map(|&u| back(u)).collect();
        // Rounding that slipping and sticking nodes let grow.
        assert!(difference(expected, &found) <= 1e-11 * largest(expected), "{n}: {}", difference(expected, &found));
    }
}

#[test]
fn a_turned_problem_has_the_turned_solution() {
    let blocks = Blocks { aside: 0.0031, ..Blocks::oblique() };
    for degrees in [30.0_f64, 90.0, 205.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turn = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let mesh = rotated(&blocks.mesh(), degrees.to_radians()).unwrap();
        let image = blocks.bodies(mesh, turn).interface(blocks.interface()).build().unwrap();
        is_invariant(blocks, &image, |u| [cos * u[0] + sin * u[1], cos * u[1] - sin * u[0]]);
    }
}

#[test]
fn a_mirror_image_has_the_mirrored_solution() {
    let blocks = Blocks { aside: 0.0031, ..Blocks::oblique() };
    let mirror = |v: [f64; 2]| [-v[0], v[1]];
    let image = blocks.bodies(mirrored(&blocks.mesh()).unwrap(), mirror).interface(blocks.interface()).build().unwrap();
    is_invariant(blocks, &image, mirror);
}

/// The order of the two groups is that of the results alone: the same bits.
#[test]
fn the_order_of_the_groups_does_not_matter() {
    let blocks = Blocks::oblique();
    let exchanged = Interface::non_matching(2, "lower.top", "upper.bottom", blocks.friction).unwrap();
    let (first, second) = (blocks.problem(), blocks.bodies(blocks.mesh(), |v| v).interface(exchanged).build().unwrap());
    let times = steps(&first, END);
    let (first, second) = (run(&first, &times), run(&second, &times));
    assert_eq!(first.history.displacement(), second.history.displacement());
    let count = 2 * first.problem.surface().nodes().len();
    let upper = 2 * 15;
    for (a, b) in first.history.reaction().chunks(count).zip(second.history.reaction().chunks(count)) {
        assert_eq!((&a[..upper], &a[upper..]), (&b[count - upper..], &b[..count - upper]));
    }
}

#[test]
fn numbers_do_not_matter() {
    let blocks = Blocks::oblique();
    let problem = blocks.problem();
    let (mesh, new) = renumbered(&blocks.mesh(), 7).unwrap();
    let velocity = percute_core::problem::Initial::Nodal(new.nodal(problem.initial_velocity()));
    let image = Problem::<2>::builder(mesh)
        .material_of("upper", blocks.materials[0])
        .material_of("lower", blocks.materials[1])
        .initial_velocity(velocity)
        .interface(blocks.interface())
        .build()
        .unwrap();
    let times = steps(&problem, END);
    let (straight, other) = (run(&problem, &times), run(&image, &times));
    for n in 0..=straight.last() {
        let expected = new.nodal(straight.displacement(n));
        let apart = difference(&expected, other.displacement(n));
        assert!(apart <= 1e-11 * largest(&expected), "step {n}: {apart}");
    }
}

/// Either body may be the slave: the coarse one sticks out by a micrometre, or the fine one does. The motion of both
/// differs by the error of the discretisation only, a small part of what contact does.
#[test]
fn roles_may_be_exchanged() {
    let run_of = |widths: [f64; 2]| {
        let problem = Blocks { widths, ..Blocks::oblique() }.problem();
        let fine_is_slave = problem.surface().non_matching()[0].slave().len() == 21;
        let run = run(&problem, &steps(&problem, END));
        (run.momentum(run.last() - 1), run.simulation.balance, fine_is_slave, problem.mass()[..180].iter().sum::<f64>())
    };
    let (coarse_out, fine_out) = (run_of([0.040_001, 0.04]), run_of([0.04, 0.040_001]));
    assert!(coarse_out.2 && !fine_out.2);
    let taken = [coarse_out.1.work_of_contact, fine_out.1.work_of_contact];
    assert!((taken[0] / taken[1] - 1.0).abs() < 0.05, "{taken:?}");
    let strain = [coarse_out.1.strain, fine_out.1.strain];
    assert!((strain[0] / strain[1] - 1.0).abs() < 0.005, "{strain:?}");
}
