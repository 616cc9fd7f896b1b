//! The impact of a uniform bar, for which the exact solution is known (§7.1).

use crate::solution::run::{Run, mean_rate, run};
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_exact::BarImpact;

/// The bar of §7.1.4.
fn bar(gap: f64) -> BarImpact {
    BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 0.02, speed: 400.0, gap }
}

fn problem(bar: &BarImpact, elements: usize) -> Problem<1> {
    Problem::<1>::builder(Mesh::uniform_bar(bar.length, elements).unwrap())
        .material(Elastic::bar(bar.young, bar.density, bar.section).unwrap())
        .initial_velocity(Initial::Uniform([-bar.speed]))
        .obstacle(Obstacle::plane([-bar.gap], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
}

/// Contact force at t_n (N).
fn force(run: &Run<'_, 1>, n: usize) -> f64 {
    run.history.step(n).unwrap().reaction::<1>()[0][0]
}

/// With Δt = h/c and a gap of k steps, the scheme is u_i^{n+1} = u_{i−1}^n + u_{i+1}^n − u_i^{n−1},
/// which d'Alembert's solution satisfies (with u_{−1} = u_1 at a free end): exact at all nodes until
/// the release at step k + 2n_e.
///
/// The first multiplier only has to stop the half mass ρSh/2 of the end: ρScv₀/2 at step k; then the
/// plateau ρScv₀ until step k + 2n_e − 1. The impulse is ρScv₀Δt(2n_e − ½) instead of 2n_e, so that
/// the mean velocity after the release is v₀(1 − 1/(2n_e)).
#[test]
fn courant_one_is_exact_at_the_nodes() {
    const ELEMENTS: usize = 20;
    const FLIGHT: usize = 3;
    let mut exact = bar(0.0);
    let dt = exact.length / ELEMENTS as f64 / exact.wave_speed();
    exact.gap = FLIGHT as f64 * dt * exact.speed;
    let problem = problem(&exact, ELEMENTS);
    let count = FLIGHT + 2 * ELEMENTS + 10;
    let run = run(&problem, &TimeGrid::uniform(count as f64 * dt, count).unwrap());
    let release = FLIGHT + 2 * ELEMENTS;

    // Displacements are of the order of v₀t; rounding grows with the steps: 60 · 1e-16 · 60.
    let travelled = exact.speed * run.time(release);
    for n in 0..=release {
        for (x, u) in problem.mesh().points_in::<1>().iter().zip(run.displacement(n)) {
            let expected = exact.displacement(x[0], run.time(n));
            assert!((u[0] - expected).abs() < 1e-12 * travelled, "step {n}, x = {}: {} against {expected}", x[0], u[0]);
        }
    }
    let plateau = exact.contact_force(exact.impact_time() + dt);
    for n in 0..=count {
        let expected = match n {
            FLIGHT => 0.5 * plateau,
            n if n > FLIGHT && n < release => plateau,
            _ => 0.0,
        };
        // Forces are stiffness times differences of displacements: their rounding is larger by
        // v₀t/(v₀Δt) ≈ 50.
        assert!((force(&run, n) - expected).abs() < 1e-11 * plateau, "step {n}: {} against {expected}", force(&run, n));
        let touching = run.history.step(n).unwrap().touching[0];
        assert_eq!(touching, n > FLIGHT && n <= release, "step {n}");
    }
    // From the first force to the last instant on the plane: 2L/c.
    assert!((run.time(release) - exact.release_time()).abs() < 1e-12 * exact.release_time());
    check_rebound(&run, &exact, release);
}

/// The mean velocity after the release, for the impulse of 2n_e − ½ steps.
fn check_rebound(run: &Run<'_, 1>, exact: &BarImpact, release: usize) {
    let mass = exact.density * exact.section * exact.length;
    for n in release..run.last() {
        let velocity = run.momentum(n)[0] / mass;
        let expected = exact.speed * (1.0 - 0.5 / run.problem.mesh().element_count() as f64);
        assert!((velocity - expected).abs() < 1e-11 * exact.speed, "step {n}: {velocity} against {expected}");
    }
}

/// At 0.9 of the critical step the front is smeared over a width ∝ h^⅔ t^⅓, the Airy front of a
/// dispersive scheme (Whitham, *Linear and Nonlinear Waves*, §11.8): what hangs on when it comes
/// back — the rebound, the length of the contact, the force around the ends of the plateau —
/// converges at order ⅔. Between the fronts the mean force is far better than that.
#[test]
fn courant_nine_tenths_converges_at_order_two_thirds() {
    let results = [25, 50, 100, 200, 400].map(at_nine_tenths);
    let column = |k: usize| results.map(|r| r[k]);
    for (k, what, finest) in [(0, "force", 0.05), (1, "momentum", 0.01), (2, "duration", 0.01)] {
        let errors = column(k);
        // The instants of contact are whole steps, which scatters single pairs: the mean of four.
        let order = mean_rate(&errors);
        assert!((0.6..=0.9).contains(&order), "{what}: order {order}, {errors:?}");
        // (h/L)^⅔ is 0.018 at 400 elements; momentum and duration see one front, the force three.
        assert!(errors[4] < finest, "{what}: {errors:?}");
    }
    // Away from the fronts an error of 1e-3 would be a wrong plateau, not a smeared one.
    assert!(column(3).iter().all(|e| *e < 1e-3) && column(3)[4] < 1e-6, "{:?}", column(3));
}

/// Relative errors of the force (mean over the contact), of the momentum after the rebound, of the
/// length of the contact, and of the mean force over its middle half.
fn at_nine_tenths(elements: usize) -> [f64; 4] {
    let mut exact = bar(0.0);
    let dt = 0.9 * exact.length / elements as f64 / exact.wave_speed();
    exact.gap = 2.3 * dt * exact.speed;
    let problem = problem(&exact, elements);
    let contact = exact.release_time() - exact.impact_time();
    let end = exact.release_time() + 0.5 * contact;
    let run = run(&problem, &TimeGrid::with_step(end, dt).unwrap());
    let dt = run.step(0);

    let plateau = exact.contact_force(exact.impact_time() + 0.5 * contact);
    let gap = |n: usize| (force(&run, n) - exact.contact_force(run.time(n))).abs();
    let force_error = (0..run.last()).map(gap).sum::<f64>() * dt / (contact * plateau);
    let mass = exact.density * exact.section * exact.length;
    let momentum_error = (run.momentum(run.last() - 1)[0] / (mass * exact.speed) - 1.0).abs();
    let touching = (0..=run.last()).filter(|&n| run.history.step(n).unwrap().touching[0]).count();
    let duration_error = (touching as f64 * dt / contact - 1.0).abs();
    let middle = |n: &usize| (0.25..0.75).contains(&((run.time(*n) - exact.impact_time()) / contact));
    let forces: Vec<f64> = (0..run.last()).filter(middle).map(|n| force(&run, n)).collect();
    let plateau_error = (forces.iter().sum::<f64>() / forces.len() as f64 / plateau - 1.0).abs();
    [force_error, momentum_error, duration_error, plateau_error]
}
