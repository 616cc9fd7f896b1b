//! Tractions and body forces.

use crate::solution::run::{aluminium, difference, fixed, gravity, largest, run};
use percute_core::dynamics::critical_time_step;
use percute_core::load::{BodyForce, Profile, Table, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{disc, random_rectangle};

/// Uniform acceleration is integrated exactly: u = v₀t + ½gt², without strain.
#[test]
fn free_flight_under_gravity_is_exact() {
    let (v0, g) = ([3.0, 20.0], [50.0, -9.81e4]);
    let problem = Problem::<2>::builder(disc(0.02, 0.004).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform(v0))
        .body_force(gravity(2700.0, g))
        .build()
        .unwrap();
    let run = run(&problem, &TimeGrid::uniform(4e-4, 900).unwrap());
    for n in 0..=run.last() {
        let t = run.time(n);
        for u in run.displacement(n) {
            for c in 0..2 {
                let expected = v0[c] * t + 0.5 * g[c] * t * t;
                // Of the largest displacement, 8e-3 m: rounding of 900 steps that add up twice.
                assert!((u[c] - expected).abs() < 1e-11 * 8e-3, "step {n}: {} against {expected}", u[c]);
            }
        }
    }
}

/// Patch test: under a uniform traction with its uniform stress from the start, nothing moves.
#[test]
fn a_uniform_traction_is_in_equilibrium_with_its_stress() {
    let (young, poisson, p, q) = (70e9, 0.3, 4e7, -1e7);
    let mesh = random_rectangle(0.05, 0.04, 7, 11).unwrap();
    // Plane stress: ε_xx = (p − νq)/E, ε_yy = (q − νp)/E.
    let strain = [(p - poisson * q) / young, (q - poisson * p) / young];
    let u0: Vec<_> = mesh.points_in::<2>().iter().map(|x| [strain[0] * x[0], strain[1] * x[1]]).collect();
    let pull = |group: &str, value| Traction {
        group: group.to_string(),
        value: Table::constant(value),
        profile: Profile::UNIFORM,
    };
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_displacement(Initial::Nodal(u0.clone()))
        .support(fixed("left", [true, false]))
        .support(fixed("bottom", [false, true]))
        .traction(pull("right", [p, 0.0]))
        .traction(pull("top", [0.0, q]))
        .build()
        .unwrap();
    let run = run(&problem, &TimeGrid::uniform(300.0 * 0.9 * critical_time_step(&problem), 300).unwrap());
    for n in 0..=run.last() {
        // Rounding of the forces drives vibrations of 1e-16 · u0 per step.
        assert!(difference(run.displacement(n), &u0) < 1e-11 * largest(&u0), "step {n}");
    }
}

/// The nodal forces of a traction that is linear along an edge have its resultant and moment.
#[test]
fn nodal_forces_keep_resultant_and_moment() {
    // On x = 2, y from 0 to 1: F(y) = (3, −1)(1 + 4y), so ∫F = (9, −3), ∫yF_x = 3(½ + 4/3) = 5.5.
    let mesh = random_rectangle(2.0, 1.0, 7, 3).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material(Elastic::plane_strain(1.0, 0.2, 1.0, 0.5).unwrap())
        .traction(Traction {
            group: "right".to_string(),
            value: Table::new(vec![0.0, 2.0], vec![[0.0, 0.0], [6.0, -2.0]]).unwrap(),
            profile: Profile { value: -7.0, gradient: [4.0, 4.0, 0.0] },
        })
        .body_force(BodyForce { group: None, value: Table::constant([0.0, 10.0]) })
        .build()
        .unwrap();
    let times = TimeGrid::uniform(2.0, 2).unwrap();
    let mut force = vec![[0.0; 2]; problem.mesh().node_count()];
    // At t = 1 the table stands halfway; the thickness is 0.5; the body force is uniform on 2 m².
    problem.external_forces(times.instants()[1], &mut force);
    let moment = |c: usize, weight: &dyn Fn(&[f64; 2]) -> f64| -> f64 {
        force.iter().zip(problem.mesh().points_in::<2>()).map(|(f, x)| f[c] * weight(x)).sum()
    };
    // All terms are of order 1.
    assert!((moment(0, &|_| 1.0) - 4.5).abs() < 1e-13);
    assert!((moment(1, &|_| 1.0) - (-1.5 + 10.0)).abs() < 1e-13);
    assert!((moment(0, &|x| x[1]) - 2.75).abs() < 1e-13);
    // Of a uniform density, the lumped forces keep the first moment: centroid at x = 1.
    assert!((moment(1, &|x| x[0]) - (-1.5 * 2.0 + 10.0)).abs() < 1e-13);
}

/// A suddenly loaded bar: d'Alembert's wave u = (p/ρc)(t − x/c) runs in from the end, exact at
/// the nodes for Δt = h/c once the half step at the start is counted: F acts as ½F Δt on ρSh/2.
#[test]
fn a_stepped_load_runs_in_as_a_wave() {
    let (young, density, section, pressure) = (70e9_f64, 2700.0_f64, 0.02, 1e8);
    let c = (young / density).sqrt();
    let problem = Problem::<1>::builder(Mesh::uniform_bar(0.1, 50).unwrap())
        .material(Elastic::bar(young, density, section).unwrap())
        .traction(Traction {
            group: "start".to_string(),
            value: Table::constant([pressure]),
            profile: Profile::UNIFORM,
        })
        .build()
        .unwrap();
    let dt = 0.1 / 50.0 / c;
    let run = run(&problem, &TimeGrid::uniform(40.0 * dt, 40).unwrap());
    for n in 0..=40 {
        for (x, u) in problem.mesh().points_in::<1>().iter().zip(run.displacement(n)) {
            let expected = pressure / (density * c) * (run.time(n) - x[0] / c).max(0.0);
            // Rounding of 40 steps, of the largest displacement 40Δt p/(ρc).
            assert!((u[0] - expected).abs() < 1e-12 * pressure / (density * c) * 40.0 * dt, "step {n}, {x:?}");
        }
    }
}
