//! Threads and strips change no bit.

use crate::solution::run::aluminium;
use percute_core::border::vectors;
use percute_core::contact::Obstacle;
use percute_core::dynamics::{Balancing, Simulation, replay, simulate, simulate_threaded};
use percute_core::history::History;
use percute_core::load::{BodyForce, Support, Table};
use percute_core::mesh::{Mesh, Strips};
use percute_core::observer::{Progress, Unobserved};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use std::ops::ControlFlow;

/// A block of 22 000 elements that strikes a plane with friction, held at its left and pulled down: every kind of
/// force.
fn block() -> (Problem<2>, TimeGrid) {
    let mesh = Mesh::rectangle(0.05, 0.04, 110, 100).unwrap();
    assert!(Strips::new(&mesh).count() > 8);
    // Some 0.9 of the critical step of legs of 0.4 mm; the plane is met in the second one.
    let step = 5e-8;
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform([0.0, -400.0]))
        .support(Support { group: "left".into(), components: [true, false, false], velocity: None })
        .body_force(BodyForce { group: None, value: Table::constant([1e9, -9.81]) })
        .obstacle(Obstacle::plane([0.0, -600.0 * step], [0.0, 1.0], 0.2, None).unwrap());
    (problem.build().unwrap(), TimeGrid::uniform(12.0 * step, 12).unwrap())
}

fn on(threads: usize) -> (History, Simulation) {
    let (problem, times) = block();
    let mut history = History::new(&times);
    let done = simulate_threaded(&problem, &times, Some(threads), &mut history, &mut Unobserved).unwrap();
    (history, done)
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (problem, times) = block();
    let mut history = History::new(&times);
    let simulation = simulate(&problem, &times, &mut history, &mut Unobserved).unwrap();
    assert!(vectors::<2>(history.reaction()).iter().any(|r| r[0] != 0.0 && r[1] > 0.0));
    for threads in [1, 2, 3, 8] {
        assert!(on(threads) == (history.clone(), simulation.clone()), "{threads} threads");
    }
    let mut balancing = Balancing::new(&problem, &times);
    replay(&problem, &history, &mut balancing).unwrap();
    assert!(balancing.finish() == simulation.balance_over_time);
}

#[test]
fn an_observer_stops_threads_too() {
    let (problem, times) = block();
    let mut history = History::new(&times);
    let mut stop = |p: Progress| if p.done == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let done = simulate_threaded(&problem, &times, Some(2), &mut history, &mut stop).unwrap();
    assert_eq!((done.steps, done.interrupted, history.len()), (3, true, 4));
}
