//! Energy and momentum: identities of the scheme that hold to rounding.

use crate::solution::run::{Run, aluminium, fixed, gravity, run};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{Balance, critical_time_step};
use percute_core::load::{Profile, Table, Traction};
use percute_core::problem::{Builder, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::random_rectangle;

/// A block that falls onto a rough plane, hits it askew and slides.
fn falling_block() -> Builder<2> {
    Problem::<2>::builder(random_rectangle(0.05, 0.04, 6, 2).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([40.0, -30.0]))
        .obstacle(Obstacle::plane([0.0, -1e-5], [0.02, 1.0], 0.3, Some("bottom".to_string())).unwrap())
        .body_force(gravity(2700.0, [1e6, -3e6]))
}

/// A block held on the left, pulled on the right.
fn pulled_block() -> Builder<2> {
    let pull = Table::new(vec![0.0, 1e-5, 3e-5], vec![[1e7, 0.0], [3e7, -2e7], [-1e7, 1e7]]).unwrap();
    Problem::<2>::builder(random_rectangle(0.05, 0.04, 6, 4).unwrap())
        .material(aluminium())
        .support(fixed("left", [true, true]))
        .traction(Traction {
            group: "right".to_string(),
            value: pull,
            profile: Profile { value: 1.0, gradient: [0.0, 20.0, 0.0] },
        })
        .body_force(gravity(2700.0, [0.0, -1e6]))
}

/// Steps of 0.8 of the critical one.
fn steps(problem: &Problem<2>, count: usize) -> TimeGrid {
    TimeGrid::uniform(0.8 * critical_time_step(problem) * count as f64, count).unwrap()
}

/// Balance with `count` of 120 equal steps done.
fn balance_after(problem: &Problem<2>, times: &TimeGrid, count: usize) -> Balance {
    let steps: Vec<f64> = (0..count).map(|n| times.step(n)).collect();
    run(problem, &TimeGrid::from_steps(&steps).unwrap()).simulation.balance
}

/// For a constant step T_n + V_n − W_n − (Δt²/8) a_n·M a_n = const, with T_n = ½ v_n·M v_n,
/// v_n = v_{n+½} − ½Δt a_n = v_{n−½} + ½Δt a_n and W the trapezoidal work of all forces:
///
/// ΔT = ½Δt v_{n+½}·M(a_n + a_{n+1}) + (Δt²/8)(a_{n+1}·M a_{n+1} − a_n·M a_n), and
/// ΔV − ΔW = ½Δu·(K(u_n + u_{n+1}) − F_n − F_{n+1}) = −½Δt v_{n+½}·M(a_n + a_{n+1}).
///
/// T, V and W are those that the code reports, a_n is the second difference of the steps.
#[test]
fn the_reported_energies_balance_to_rounding() {
    for problem in [falling_block().build().unwrap(), pulled_block().build().unwrap()] {
        let times = steps(&problem, 120);
        let whole = run(&problem, &times);
        let inertia = |n: usize| {
            let (before, after) = (whole.half_velocity(n - 1), whole.half_velocity(n));
            let rows = before.iter().zip(&after).zip(problem.mass());
            rows.map(|((v, w), m)| m * ((w[0] - v[0]).powi(2) + (w[1] - v[1]).powi(2))).sum::<f64>() / 8.0
        };
        let constant = |n: usize| {
            let b = balance_after(&problem, &times, n);
            let works = b.work_of_loads + b.work_of_supports + b.work_of_contact;
            (b.kinetic + b.strain - works - inertia(n), b.kinetic + b.strain + works.abs())
        };
        let (start, _) = constant(1);
        for n in [2, 3, 10, 37, 80, 119] {
            let (now, scale) = constant(n);
            // v from differences of u loses u/(vΔt) ≈ 100 units in the last place, in 100 sums.
            assert!((now - start).abs() < 1e-11 * scale, "step {n}: {now} against {start}, energies of {scale}");
        }
    }
}

/// The same identity with everything taken from the recorded steps: masses, gravity and reactions.
#[test]
fn the_recorded_steps_balance_to_rounding() {
    let problem = falling_block().build().unwrap();
    let run = run(&problem, &steps(&problem, 120));
    let dt = run.step(0);
    let (mut work, mut start, mut scale) = (0.0, None, 0.0_f64);
    let mut touched = 0;
    for n in 1..run.last() {
        let (before, after) = (run.half_velocity(n - 1), run.half_velocity(n));
        let (mut kinetic, mut inertia) = (0.0, 0.0);
        for ((v, w), m) in before.iter().zip(&after).zip(problem.mass()) {
            for c in 0..2 {
                kinetic += m * (v[c] + w[c]).powi(2) / 8.0;
                inertia += m * (w[c] - v[c]).powi(2) / 8.0;
            }
        }
        let energy = kinetic + run.strain_energy(n) - work - inertia;
        scale = scale.max(kinetic);
        let start = *start.get_or_insert(energy);
        assert!((energy - start).abs() < 1e-11 * scale, "step {n}: {energy} against {start}");
        for (m, w) in problem.mass().iter().zip(&after) {
            work += m * dt * (1e6 * w[0] - 3e6 * w[1]);
        }
        let (now, next) =
            (run.history.step(n).unwrap().reaction::<2>(), run.history.step(n + 1).unwrap().reaction::<2>());
        for (at, node) in run.contact_nodes().into_iter().enumerate() {
            (0..2).for_each(|c| work += 0.5 * dt * (now[at][c] + next[at][c]) * after[node][c]);
            touched += usize::from(now[at][1] > 0.0);
        }
    }
    assert!(touched > 20, "only {touched} reactions: nothing was tested");
}

/// M(v_{n+½} − v_{n−½}) = Δt ΣF: the momentum of the recorded steps against gravity and reactions,
/// and the drift that the code reports.
#[test]
fn momentum_is_the_impulse() {
    let problem = falling_block().build().unwrap();
    let run = run(&problem, &steps(&problem, 200));
    let mass: f64 = problem.mass().iter().sum();
    let dt = run.step(0);
    let mut expected = [40.0 * mass, -30.0 * mass];
    for n in 0..run.last() {
        let h = if n == 0 { 0.5 * dt } else { dt };
        let reactions = run.history.step(n).unwrap().reaction::<2>();
        for c in 0..2 {
            expected[c] += h * (mass * [1e6, -3e6][c] + reactions.iter().map(|r| r[c]).sum::<f64>());
            let found = run.momentum(n)[c];
            // Differences of u: 1e-16 · u/(vΔt), in 50 nodes.
            assert!((found - expected[c]).abs() < 1e-11 * 50.0 * mass, "step {n}: {found} against {}", expected[c]);
        }
    }
    // Sums of 200 steps over 50 nodes.
    assert!(run.simulation.balance.impulse_drift < 1e-13, "{}", run.simulation.balance.impulse_drift);
    let held = pulled_block().build().unwrap();
    let drift = self::run(&held, &steps(&held, 200)).simulation.balance.impulse_drift;
    assert!(drift < 1e-13, "{drift}");
}

/// The energy drift that the code reports is the Δt²/8 term: order 2 in Δt.
#[test]
fn the_energy_drift_falls_with_the_square_of_the_step() {
    let problem = pulled_block().build().unwrap();
    let critical = critical_time_step(&problem);
    let drift = |fraction: f64| {
        let times = TimeGrid::with_step(40.0 * critical, fraction * critical).unwrap();
        run(&problem, &times).simulation.balance.energy_drift
    };
    let ratio = drift(0.2) / drift(0.1);
    // 4 to within the change of the largest a_n·M a_n between the two runs.
    assert!((3.6..=4.4).contains(&ratio), "{ratio}");
}

/// Friction takes energy at every step, and the sum of what it takes is what the code reports.
#[test]
fn friction_dissipates() {
    let problem = falling_block().build().unwrap();
    let run: Run<'_, 2> = run(&problem, &steps(&problem, 150));
    let plane = &problem.obstacles()[0];
    let mut friction = 0.0;
    for n in 0..run.last() {
        let velocity = run.half_velocity(n);
        let (now, next) = (run.history.step(n).unwrap().reaction(), run.history.step(n + 1).unwrap().reaction());
        for (at, node) in run.contact_nodes().into_iter().enumerate() {
            let tangential = plane.flat_frame().split(&velocity[node]).1;
            let power = |r: &[f64; 2]| -(r[0] * tangential[0] + r[1] * tangential[1]);
            // The reaction of t_n makes v_{n+½} and opposes it, up to rounding of u differences.
            let rounding = 1e-9 * 50.0 * plane.flat_frame().split(&now[at]).0;
            assert!(power(&now[at]) >= -rounding, "step {n}, node {node}: {}", power(&now[at]));
            friction += 0.5 * run.step(n) * (power(&now[at]) + power(&next[at]));
        }
    }
    let reported = run.simulation.balance.friction;
    assert!(reported > 0.0 && (friction / reported - 1.0).abs() < 1e-9, "{friction} against {reported}");
}
