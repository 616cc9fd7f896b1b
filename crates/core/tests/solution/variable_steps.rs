//! Steps of different lengths.

use crate::solution::run::{aluminium, difference, largest, mean_rate, on_rollers, run, swinging_steps};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{SimulationError, critical_time_step, simulate};
use percute_core::history::Discard;
use percute_core::load::{BodyForce, Table};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_exact::{BarImpact, BlockMode, Wave};
use percute_testkit::{Random, random_rectangle};
use std::f64::consts::TAU;

/// Random steps of 0.5 to 0.9 of `critical` until `end` at least.
fn random_steps(critical: f64, end: f64, seed: u64) -> TimeGrid {
    let mut random = Random::new(seed);
    let (mut steps, mut time) = (Vec::new(), 0.0);
    while time < end {
        let step = critical * random.between(0.5, 0.9);
        steps.push(step);
        time += step;
    }
    TimeGrid::from_steps(&steps).unwrap()
}

/// v_{n+½} is the exact velocity in the middle of each step, whatever their lengths.
#[test]
fn free_flight_is_exact() {
    let (v0, g) = ([-7.0, 15.0], [2e4, -8e4]);
    let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 6, 3).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform(v0))
        .body_force(BodyForce { group: None, value: Table::constant(g.map(|g| 2700.0 * g)) })
        .build()
        .unwrap();
    let run = run(&problem, &random_steps(critical_time_step(&problem), 3e-4, 2));
    for n in 0..=run.last() {
        let t = run.time(n);
        for (u, c) in run.displacement(n).iter().flat_map(|u| [(u[0], 0), (u[1], 1)]) {
            let expected = v0[c] * t + 0.5 * g[c] * t * t;
            // Rounding of 350 steps that add up twice, of displacements of 2e-3 m.
            assert!((u - expected).abs() < 1e-11 * 2e-3, "step {n}: {u} against {expected}");
        }
    }
}

/// A standing wave converges at order 2 if the steps change smoothly: what their change leaves,
/// (Δt_n − Δt_{n−1})/2 · a, is then O(Δt²) too.
#[test]
fn a_standing_wave_converges() {
    let (young, poisson) = (70e9, 0.3);
    let mode = BlockMode {
        wave: Wave::Pressure,
        numbers: [1, 1],
        sides: [0.05, 0.04],
        thickness: 1.0,
        lambda: young * poisson / (1.0 - poisson * poisson),
        shear: young / (2.0 * (1.0 + poisson)),
        density: 2700.0,
        amplitude: 1e-5,
        phase: 0.0,
    };
    let end = 1.2 * TAU / mode.angular_frequency();
    let errors = [10, 20, 40].map(|n| {
        let mesh = Mesh::rectangle(0.05, 0.04, n, n * 4 / 5).unwrap();
        let still =
            |p: &[f64; 2], u: [f64; 2]| [0, 1].map(|c| if p[c] == 0.0 || p[c] == mode.sides[c] { 0.0 } else { u[c] });
        let start = mesh.points_in::<2>().iter().map(|p| still(p, mode.displacement(*p, 0.0))).collect();
        let problem = on_rollers(mesh, aluminium()).initial_displacement(Initial::Nodal(start)).build().unwrap();
        let run = run(&problem, &swinging_steps(critical_time_step(&problem), end, 3.0));
        let reached = run.time(run.last());
        let exact: Vec<_> = problem.mesh().points_in::<2>().iter().map(|p| mode.displacement(*p, reached)).collect();
        difference(run.displacement(run.last()), &exact) / mode.amplitude
    });
    let order = mean_rate(&errors);
    assert!((1.9..=2.1).contains(&order), "order {order}: {errors:?}");
    // With constant steps the largest error is 4e-3, twice the root mean square of 2e-3.
    assert!(errors[2] < 6e-3, "{errors:?}");
}

/// The impact of a bar: multipliers R = −m g/(Δt_n h_n) land the node on the plane at every step.
#[test]
fn a_bar_stays_on_the_plane_and_rebounds() {
    let exact = BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 0.02, speed: 400.0, gap: 1e-4 };
    let problem = Problem::<1>::builder(Mesh::uniform_bar(0.1, 200).unwrap())
        .material(Elastic::bar(exact.young, exact.density, exact.section).unwrap())
        .initial_velocity(Initial::Uniform([-exact.speed]))
        .obstacle(Obstacle::plane([-exact.gap], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap();
    let end = 1.5 * exact.release_time();
    let run = run(&problem, &swinging_steps(critical_time_step(&problem), end, 5.0));
    let mut impulse = 0.0;
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        let gap = step.displacement[0] + exact.gap;
        assert!(gap >= -2.0 * problem.contact_tolerance(), "step {n}: {gap}");
        assert!(!step.touching[0] || gap.abs() <= 2.0 * problem.contact_tolerance(), "step {n}: touching at {gap}");
        if n > 0 && n < run.last() {
            impulse += step.reaction[0] * 0.5 * (run.step(n - 1) + run.step(n));
        }
    }
    let mass = exact.density * exact.section * exact.length;
    let momentum = run.momentum(run.last() - 1)[0];
    // Rounding of differences of u; the impulse is that of the scheme, to the last digit.
    assert!((momentum + mass * exact.speed - impulse).abs() < 1e-10 * impulse, "{momentum} with {impulse}");
    // The front is smeared over (h/L)^⅔ = 0.03 of the bar.
    assert!((impulse / (2.0 * mass * exact.speed) - 1.0).abs() < 0.02, "{impulse}");
}

/// Below the critical step, steps that jump at random still make the scheme unstable, by parametric
/// resonance (Skeel, *Variable step size destabilizes the Störmer/leapfrog/Verlet method*, BIT 33,
/// 1993): the run ends with the error, and steps of the same lengths that change smoothly go through.
#[test]
fn jumping_steps_can_be_unstable_below_the_critical_step() {
    let problem = Problem::<1>::builder(Mesh::uniform_bar(0.1, 100).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .initial_velocity(Initial::Nodal((0..=100).map(|i| [f64::from(i % 7) - 3.0]).collect()))
        .build()
        .unwrap();
    let critical = critical_time_step(&problem);
    let end = 2000.0 * 0.7 * critical;
    let jumping = random_steps(critical, end, 8);
    assert!(jumping.longest_step() < 0.9 * critical);
    let error = simulate(&problem, &jumping, &mut Discard, &mut Unobserved).unwrap_err();
    assert!(matches!(error, SimulationError::Unstable { .. }), "{error}");
    run(&problem, &swinging_steps(critical, end, 5.0));
}

/// Equal steps given one by one are the uniform grid, up to rounding of the sum of the steps.
#[test]
fn equal_steps_one_by_one_are_a_uniform_grid() {
    let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 5, 3).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([50.0, -100.0]))
        .obstacle(Obstacle::plane([0.0, -3.3e-5], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap();
    let dt = 0.8 * critical_time_step(&problem);
    let uniform = run(&problem, &TimeGrid::uniform(100.0 * dt, 100).unwrap());
    let listed = run(&problem, &TimeGrid::from_steps(&[dt; 100]).unwrap());
    let (a, b) = (uniform.displacement(100), listed.displacement(100));
    // Steps differ by 1e-16 · t_n, 1e-14 of Δt, and vibrations keep that.
    assert!(difference(a, b) < 1e-10 * largest(a), "{}", difference(a, b));
}
