//! Prescribed motion \[4\].

use crate::solution::run::{aluminium, fixed, nodes_of, run};
use percute_core::dynamics::critical_time_step;
use percute_core::load::{Support, Table};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{Random, random_rectangle};

/// A block driven on the left by a table, on rollers at the bottom.
fn driven(table: &Table) -> Problem<2> {
    Problem::<2>::builder(random_rectangle(0.05, 0.04, 6, 1).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([table.at(0.0)[0], 0.0]))
        .support(Support { group: "left".to_string(), components: [true, false, false], velocity: Some(table.clone()) })
        .support(fixed("bottom", [false, true]))
        .build()
        .unwrap()
}

/// Follows the table through the exact integral of the straight lines between its values at t_n.
fn check(table: &Table, times: &TimeGrid) {
    let problem = driven(table);
    let run = run(&problem, times);
    let (left, bottom) = (nodes_of(problem.mesh(), "left"), nodes_of(problem.mesh(), "bottom"));
    let mut expected = 0.0;
    for n in 0..=run.last() {
        for &node in &left {
            let found = run.displacement(n)[node][0];
            // Rounding of up to 100 steps of displacements of up to 1e-3 m.
            assert!(
                (found - expected).abs() < 1e-13 * 1e-3 * 100.0,
                "step {n}, node {node}: {found} against {expected}"
            );
        }
        assert!(bottom.iter().all(|&node| run.displacement(n)[node][1] == 0.0), "step {n}");
        if n < run.last() {
            expected += 0.5 * run.step(n) * (table.at(run.time(n))[0] + table.at(run.time(n + 1))[0]);
        }
    }
    assert!(expected.abs() > 1e-6, "nothing moved");
}

/// A ramp from 10 m/s up, down to −20 m/s, and a rest.
fn table() -> Table {
    let values = vec![[10.0, 0.0], [40.0, 0.0], [-20.0, 0.0], [0.0, 0.0]];
    Table::new(vec![0.0, 1.1e-5, 3.3e-5, 5e-5], values).unwrap()
}

#[test]
fn tables_are_followed_with_equal_steps() {
    let critical = critical_time_step(&driven(&table()));
    check(&table(), &TimeGrid::with_step(6e-5, 0.9 * critical).unwrap());
}

#[test]
fn tables_are_followed_with_variable_steps() {
    let critical = critical_time_step(&driven(&table()));
    let mut random = Random::new(6);
    let steps: Vec<f64> = (0..90).map(|_| critical * random.between(0.5, 0.9)).collect();
    check(&table(), &TimeGrid::from_steps(&steps).unwrap());
}

/// If the instants of the table are instants t_n, the motion is the exact integral of the table:
/// 25 m/s · 10 µs + ½·(40 + 0) m/s · 20 µs.
#[test]
fn tables_at_instants_of_steps_give_the_exact_integral() {
    let table = Table::new(vec![0.0, 1e-5, 3e-5], vec![[10.0, 0.0], [40.0, 0.0], [0.0, 0.0]]).unwrap();
    let problem = driven(&table);
    let run = run(&problem, &TimeGrid::uniform(4e-5, 80).unwrap());
    for node in nodes_of(problem.mesh(), "left") {
        let found = run.displacement(run.last())[node][0];
        // Rounding of 80 steps.
        assert!((found - 6.5e-4).abs() < 1e-13 * 6.5e-4 * 80.0, "{found}");
    }
}

/// A body moved as a whole by its support stays without strain, at the table's speed.
#[test]
fn a_uniform_motion_of_the_support_is_a_translation() {
    let problem = driven(&Table::constant([25.0, 0.0]));
    let run = run(&problem, &TimeGrid::uniform(6e-5, 100).unwrap());
    for n in 0..=run.last() {
        for u in run.displacement(n) {
            // Rounding of displacements of 1.5e-3 m drives vibrations of that size.
            assert!((u[0] - 25.0 * run.time(n)).abs() < 1e-12 * 1.5e-3 && u[1].abs() < 1e-12 * 1.5e-3, "step {n}");
        }
    }
    assert!(run.simulation.balance.work_of_supports.abs() < 1e-9 * run.simulation.balance.kinetic);
}

/// Rollers hold one component and leave the other: a block on rollers slides along them for ever.
#[test]
fn rollers_let_slide() {
    let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 6, 1).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([30.0, 0.0]))
        .support(fixed("bottom", [false, true]))
        .support(fixed("top", [false, true]))
        .build()
        .unwrap();
    let run = run(&problem, &TimeGrid::uniform(6e-5, 100).unwrap());
    let held = nodes_of(problem.mesh(), "bottom");
    for n in 0..=run.last() {
        assert!(held.iter().all(|&node| run.displacement(n)[node][1] == 0.0));
        // Rounding of displacements of 1.8e-3 m.
        assert!(run.displacement(n).iter().all(|u| (u[0] - 30.0 * run.time(n)).abs() < 1e-12 * 1.8e-3), "step {n}");
    }
}

/// Work of the support: a body brought from rest to the speed V by a slow ramp has got ½mV².
#[test]
fn the_work_of_the_support_is_the_kinetic_energy() {
    let ramp = Table::new(vec![0.0, 4e-4], vec![[0.0, 0.0], [20.0, 0.0]]).unwrap();
    let problem = driven(&ramp);
    let run = run(&problem, &TimeGrid::with_step(4e-4, 0.8 * critical_time_step(&problem)).unwrap());
    let balance = run.simulation.balance;
    let mass: f64 = problem.mass().iter().sum();
    let energy = balance.kinetic + balance.strain;
    // The identity's term Δt²/8 a·M a: a = 5e4 m/s² on the whole mass is (aΔt/V)²/4 = 1e-6 of it.
    assert!((balance.work_of_supports / energy - 1.0).abs() < 1e-5, "{balance:?}");
    // The vibrations that the start excites have a speed of aL/c = 0.5 m/s against 20.
    assert!((energy / (0.5 * mass * 400.0) - 1.0).abs() < 0.1, "{energy}");
}
