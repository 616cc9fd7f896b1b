//! Bodies without energy at the start: what counts as unstable there.
//!
//! A run is stopped when T_n + V_n > 10 (T_0 + V_0 + works). By the identity of the scheme,
//! T_n + V_n = T_0 + V_0 + W_n + (Δt²/8)(a_n·M a_n − a_0·M a_0): the last term is there before any
//! work is, and rounding is there without any.

use crate::solution::run::{aluminium, fixed, gravity, largest, run};
use percute_core::dynamics::critical_time_step;
use percute_core::load::{BodyForce, Profile, Support, Table, Traction};
use percute_core::problem::{Builder, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::random_rectangle;

/// Zero until 5 µs, then `value` and more.
fn late(value: [f64; 2]) -> Table {
    Table::new(vec![0.0, 5e-6, 1e-5], vec![[0.0; 2], [0.0; 2], value]).unwrap()
}

fn block() -> Builder<2> {
    Problem::<2>::builder(random_rectangle(0.05, 0.04, 5, 0).unwrap()).material(aluminium())
}

fn moves(problem: &Problem<2>) -> bool {
    let run = run(problem, &TimeGrid::with_step(6e-5, 0.8 * critical_time_step(problem)).unwrap());
    largest(run.displacement(run.last())) > 0.0
}

/// At the first step with a load u is still zero, hence the work, but v_n = ½Δt a_n is not.
#[test]
fn a_load_that_grows_from_zero_is_no_instability() {
    let ramp = Table::new(vec![0.0, 1e-5], vec![[0.0, 0.0], [1e7, 0.0]]).unwrap();
    for value in [ramp, late([1e7, 0.0])] {
        let traction = Traction { group: "right".to_string(), value, profile: Profile::UNIFORM };
        assert!(moves(&block().support(fixed("left", [true, true])).traction(traction).build().unwrap()));
    }
}

#[test]
fn a_body_force_that_grows_from_zero_is_no_instability() {
    assert!(moves(&block().body_force(BodyForce { group: None, value: late([0.0, -1e9]) }).build().unwrap()));
}

#[test]
fn a_support_that_starts_late_is_no_instability() {
    let support =
        Support { group: "left".to_string(), components: [true, false, false], velocity: Some(late([10.0, 0.0])) };
    assert!(moves(&block().support(support).build().unwrap()));
}

/// A linearised rotation has no strain: all energy there is, 1e-31 of what such displacements
/// could hold, is rounding, and may grow by any factor.
#[test]
fn a_body_turned_at_rest_stays_at_rest() {
    let mesh = random_rectangle(0.05, 0.04, 6, 1).unwrap();
    let turned: Vec<_> = mesh.points_in::<2>().iter().map(|p| [-1e-3 * p[1], 1e-3 * p[0]]).collect();
    let builder = Problem::<2>::builder(mesh).material(aluminium());
    let problem = builder.initial_displacement(Initial::Nodal(turned.clone())).build().unwrap();
    let run = run(&problem, &TimeGrid::uniform(500.0 * 0.9 * critical_time_step(&problem), 500).unwrap());
    // Rounding of displacements of 5e-5 m that vibrations carry on.
    assert!(crate::solution::run::difference(run.displacement(500), &turned) < 1e-10 * 5e-5);
}

/// What does have energy from the first step on goes through.
#[test]
fn constant_loads_and_steady_ramps_from_rest_go_through() {
    assert!(moves(&block().body_force(gravity(2700.0, [0.0, -1e5])).build().unwrap()));
    let pull = Traction { group: "right".to_string(), value: Table::constant([1e7, 0.0]), profile: Profile::UNIFORM };
    assert!(moves(&block().support(fixed("left", [true, true])).traction(pull).build().unwrap()));
}
