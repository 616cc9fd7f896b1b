//! Standing waves.

use crate::solution::run::{mean_rate, on_rollers, run};
use percute_core::dynamics::critical_time_step;
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_exact::{BarEnds, BarMode, BlockMode, Wave};
use percute_testkit::random_rectangle;
use std::f64::consts::TAU;

/// The second fixed–free mode; at phase −π/2 it starts from velocities alone.
fn bar_mode(phase: f64) -> BarMode {
    BarMode {
        ends: BarEnds::FixedFree,
        number: 2,
        length: 0.1,
        young: 70e9,
        density: 2700.0,
        section: 0.02,
        amplitude: 1e-4,
        phase,
    }
}

fn bar_problem(mode: &BarMode, elements: usize) -> Problem<1> {
    let mesh = Mesh::uniform_bar(mode.length, elements).unwrap();
    let at = |f: &dyn Fn(f64) -> f64| Initial::Nodal(mesh.points_in::<1>().iter().map(|x| [f(x[0])]).collect());
    // The fixed end is at rest in exact arithmetic and here, since sin 0 = 0.
    let (displacement, velocity) = (at(&|x| mode.displacement(x, 0.0)), at(&|x| mode.velocity(x, 0.0)));
    Problem::<1>::builder(mesh)
        .material(Elastic::bar(mode.young, mode.density, mode.section).unwrap())
        .initial_displacement(displacement)
        .initial_velocity(velocity)
        .support(Support { group: "start".to_string(), components: [true, false, false], velocity: None })
        .build()
        .unwrap()
}

/// On a uniform bar the mode keeps its shape and swings as cos(ω_h t) with the frequency of the
/// scheme, sin(ω_h Δt/2) = r sin(kh/2), r = cΔt/h: the start u_1 = u_0 + ½Δt² a_0 fits it exactly.
#[test]
fn a_bar_mode_has_the_frequency_of_the_dispersion_relation() {
    for (elements, courant) in [(8, 0.3), (16, 0.9), (40, 0.7)] {
        let mode = bar_mode(0.0);
        let problem = bar_problem(&mode, elements);
        let h = mode.length / elements as f64;
        let dt = courant * h / (mode.young / mode.density).sqrt();
        let run = run(&problem, &TimeGrid::uniform(200.0 * dt, 200).unwrap());
        let omega = 2.0 / dt * (courant * (0.5 * mode.wave_number() * h).sin()).asin();
        for n in 0..=200 {
            for (u, u0) in run.displacement(n).iter().zip(run.displacement(0)) {
                let expected = u0[0] * (omega * run.time(n)).cos();
                // Rounding of 200 steps, which add up twice: 1e-16 · 200²/2.
                assert!((u[0] - expected).abs() < 1e-11 * mode.amplitude, "step {n}: {} against {expected}", u[0]);
            }
        }
    }
}

/// Largest nodal error at the end over the amplitude.
fn bar_error(mode: &BarMode, elements: usize, end: f64) -> f64 {
    let problem = bar_problem(mode, elements);
    let run = run(&problem, &TimeGrid::with_step(end, 0.7 * critical_time_step(&problem)).unwrap());
    let points = problem.mesh().points_in::<1>().iter().zip(run.displacement(run.last()));
    points.fold(0.0_f64, |m, (x, u)| m.max((u[0] - mode.displacement(x[0], end)).abs())) / mode.amplitude
}

/// Order 2 with Δt ∝ h. The error after a time T is the lag of phase ωT(kh)²(1 − r²)/24, read where
/// the mode moves fastest: with 2.25 periods, kL = 3π/2, r = 0.7 and 128 elements 4.07e-4.
#[test]
fn a_bar_mode_converges_at_order_two() {
    let mode = bar_mode(0.0);
    let end = 2.25 * TAU / mode.angular_frequency();
    let errors: Vec<f64> = [16, 32, 64, 128].iter().map(|&n| bar_error(&mode, n, end)).collect();
    // The next term of the expansion is (kh)² ≈ 1e-3 smaller; r is rounded to a whole number of steps.
    assert!((mean_rate(&errors[2..]) - 2.0).abs() < 0.05, "{errors:?}");
    let lag = mode.angular_frequency() * end * (mode.wave_number() * mode.length / 128.0).powi(2) * (1.0 - 0.49) / 24.0;
    assert!((errors[3] / lag - 1.0).abs() < 0.05, "{} against {lag}", errors[3]);
}

/// The same from velocities alone.
#[test]
fn a_bar_mode_that_starts_moving_converges_at_order_two() {
    let mode = bar_mode(-0.25 * TAU);
    let end = 2.0 * TAU / mode.angular_frequency();
    let errors: Vec<f64> = [16, 32, 64, 128].iter().map(|&n| bar_error(&mode, n, end)).collect();
    assert!((mean_rate(&errors[2..]) - 2.0).abs() < 0.05, "{errors:?}");
}

/// λ = Eν/(1−ν²), G = E/(2(1+ν)): plane stress.
fn block_mode(wave: Wave, numbers: [u32; 2], phase: f64) -> BlockMode {
    let (young, poisson) = (70e9, 0.3);
    BlockMode {
        wave,
        numbers,
        sides: [0.05, 0.04],
        thickness: 0.01,
        lambda: young * poisson / (1.0 - poisson * poisson),
        shear: young / (2.0 * (1.0 + poisson)),
        density: 2700.0,
        amplitude: 1e-5,
        phase,
    }
}

fn block_problem(mode: &BlockMode, mesh: Mesh) -> Problem<2> {
    let material = Elastic::plane_stress(70e9, 0.3, mode.density, mode.thickness).unwrap();
    let mut fields = [vec![], vec![]];
    for &point in mesh.points_in::<2>() {
        // On the rollers sin(nπ) is rounding only; the supports want exact zeros.
        let on = [0, 1].map(|c| point[c] == 0.0 || point[c] == mode.sides[c]);
        let still = |v: [f64; 2]| [0, 1].map(|c| if on[c] { 0.0 } else { v[c] });
        fields[0].push(still(mode.displacement(point, 0.0)));
        fields[1].push(still(mode.velocity(point, 0.0)));
    }
    let [displacement, velocity] = fields.map(Initial::Nodal);
    on_rollers(mesh, material).initial_displacement(displacement).initial_velocity(velocity).build().unwrap()
}

/// Root mean square of the nodal error at the end, weighted with the masses, over the amplitude.
fn block_error(mode: &BlockMode, mesh: Mesh, end: f64) -> f64 {
    let problem = block_problem(mode, mesh);
    let run = run(&problem, &TimeGrid::with_step(end, 0.7 * critical_time_step(&problem)).unwrap());
    let (mut squares, mut total) = (0.0, 0.0);
    for ((point, u), mass) in
        problem.mesh().points_in::<2>().iter().zip(run.displacement(run.last())).zip(problem.mass())
    {
        let exact = mode.displacement(*point, end);
        squares += mass * ((u[0] - exact[0]).powi(2) + (u[1] - exact[1]).powi(2));
        total += mass;
    }
    (squares / total).sqrt() / mode.amplitude
}

/// Order 2 with Δt ∝ h, on structured and unstructured meshes. As for the bar, the error is a lag
/// of phase of about ωT|k|²h²/24, times the root mean square ½ of a mode.
#[test]
fn block_modes_converge_at_order_two() {
    for (wave, numbers, phase) in [
        (Wave::Pressure, [1, 1], 0.0),
        (Wave::Shear, [1, 1], 0.0),
        (Wave::Pressure, [2, 1], -0.25 * TAU),
        (Wave::Shear, [1, 2], -0.25 * TAU),
    ] {
        let mode = block_mode(wave, numbers, phase);
        let end = 1.2 * TAU / mode.angular_frequency();
        let structured = |n: usize| Mesh::rectangle(0.05, 0.04, n, n * 4 / 5).unwrap();
        let random = |n: usize| random_rectangle(0.05, 0.04, n, 1).unwrap();
        let errors = [10, 20, 40].map(|n| block_error(&mode, structured(n), end));
        let others = [10, 20, 40].map(|n| block_error(&mode, random(n), end));
        let order = mean_rate(&errors[1..]);
        assert!((1.9..=2.1).contains(&order), "{wave:?} {numbers:?}: order {order}, {errors:?}");
        // Each random mesh has a constant of its own; over two halvings it weighs half.
        let order = mean_rate(&others);
        assert!((1.8..=2.8).contains(&order), "{wave:?} {numbers:?}: order {order}, {others:?}");
        let squares: f64 = mode.wave_vector().iter().map(|k| k * k).sum();
        let lag = 0.5 * 1.2 * TAU * squares * (0.05_f64 / 40.0).powi(2) / 24.0;
        // Half as much again for the shape of the elements.
        assert!(errors[2].max(others[2]) < 1.5 * lag, "{wave:?} {numbers:?}: {errors:?}, {others:?}, lag {lag}");
    }
}
