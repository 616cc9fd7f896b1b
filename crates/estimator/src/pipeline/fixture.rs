//! Small problems for the tests of this module, and their steps prepared.

use super::prepare::Preparation;
use crate::options::{Options, Reconstruction};
use percute_core::contact::Obstacle;
use percute_core::dynamics::Evaluation;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::history::History;
use percute_core::load::{Support, Table};
use percute_core::material::Elastic;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::random_rectangle;

/// Above any rounding, and far below what a change of 1 % does.
pub(super) const SHOWS: f64 = 1e-6;

fn steps(problem: &Problem<2>) -> TimeGrid {
    TimeGrid::uniform(20.0 * 0.9 * critical_time_step(problem), 20).unwrap()
}

/// A block thrown on a plane, with rollers on these sides.
fn thrown(velocity: [f64; 2], friction: f64, rollers: &[&str]) -> (Problem<2>, TimeGrid) {
    let mut builder = Problem::<2>::builder(random_rectangle(0.05, 0.04, 5, 1).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform(velocity))
        .obstacle(Obstacle::plane([0.0, -6e-4], [0.0, 1.0], friction, Some("bottom".to_string())).unwrap());
    for group in rollers {
        builder =
            builder.support(Support { group: group.to_string(), components: [true, false, false], velocity: None });
    }
    let problem = builder.build().unwrap();
    let times = steps(&problem);
    (problem, times)
}

/// A block that strikes and slides.
pub(super) fn impact() -> (Problem<2>, TimeGrid) {
    thrown([400.0, -400.0], 0.2, &[])
}

/// A block that strikes and sticks: friction holds what slides there.
pub(super) fn sticking() -> (Problem<2>, TimeGrid) {
    thrown([40.0, -400.0], 0.9, &[])
}

/// A block that strikes, its left side guided along the normal of the plane.
pub(super) fn guided() -> (Problem<2>, TimeGrid) {
    thrown([0.0, -400.0], 0.2, &["left"])
}

/// A block whose top is driven; no plane.
pub(super) fn driven() -> (Problem<2>, TimeGrid) {
    let velocity = Table::new(vec![0.0, 5e-6], vec![[0.0, -100.0], [0.0, 30.0]]).unwrap();
    let top = Support { group: "top".to_string(), components: [false, true, false], velocity: Some(velocity) };
    let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 5, 2).unwrap())
        .material(Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap())
        .initial_velocity(Initial::Uniform([0.0, -100.0]))
        .support(top)
        .build()
        .unwrap();
    let times = steps(&problem);
    (problem, times)
}

/// All steps of a problem, prepared.
pub(super) fn prepared<'p>(
    problem: &'p Problem<2>,
    times: &'p TimeGrid,
    reconstruction: Reconstruction,
) -> Preparation<'p, 2, 3> {
    prepared_until(problem, times, reconstruction, times.step_count())
}

/// The same with all options.
pub(super) fn prepared_with<'p>(
    problem: &'p Problem<2>,
    times: &'p TimeGrid,
    options: &Options,
) -> Preparation<'p, 2, 3> {
    prepare(problem, times, options, times.step_count())
}

/// Its steps up to one of them.
pub(super) fn prepared_until<'p>(
    problem: &'p Problem<2>,
    times: &'p TimeGrid,
    reconstruction: Reconstruction,
    last: usize,
) -> Preparation<'p, 2, 3> {
    prepare(problem, times, &Options { reconstruction, ..Options::default() }, last)
}

fn prepare<'p>(problem: &'p Problem<2>, times: &'p TimeGrid, options: &Options, last: usize) -> Preparation<'p, 2, 3> {
    let mut history = History::new(times);
    simulate(problem, times, &mut history, &mut Unobserved).unwrap();
    let mut preparation = Preparation::new(problem, times, options);
    let mut evaluation = Evaluation::new(problem, times);
    for n in 0..=last {
        let step = history.step(n).unwrap();
        preparation.check(&step).unwrap();
        preparation.push(&evaluation.advance(&step).unwrap()).unwrap();
    }
    preparation.finish().unwrap();
    preparation
}
