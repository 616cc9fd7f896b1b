//! Admissible fields whatever the mesh, the plane's angle and the body's shape.

use crate::properties::bodies::{aluminium, plane_below, steps, swinging, thrown};
use crate::properties::estimating::{assert_admissible, check, estimate, history, reactions};
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_estimator::Options;
use percute_testkit::{Random, disc, random_rectangle, rotated};

/// Distance from the plane at the start (m). At 400 m/s it is more than a quarter of any step here,
/// 5 µs at most: nearer starts are refused.
const GAP: f64 = 6e-4;

fn impact(what: &str, mesh: Mesh, tilt: f64, friction: f64, count: usize) {
    let plane = plane_below(&mesh, tilt, GAP, friction, None);
    // 400 m/s into the plane and as fast along it.
    let (sin, cos) = tilt.sin_cos();
    let velocity = [400.0 * (cos + sin), 400.0 * (sin - cos)];
    let problem = thrown(mesh, velocity, plane).build().unwrap();
    let reactions = check(what, &problem, &steps(&problem, 0.9, count));
    assert!(reactions > 3, "{what}: only {reactions} reactions");
}

#[test]
fn structured_blocks() {
    for (nx, ny) in [(1, 1), (2, 1), (5, 4), (10, 8)] {
        for friction in [0.0, 0.2, 2.0] {
            let mesh = Mesh::rectangle(0.05, 0.04, nx, ny).unwrap();
            impact(&format!("{nx} × {ny}, μ = {friction}"), mesh, 0.0, friction, 37);
        }
    }
}

#[test]
fn unstructured_blocks() {
    for seed in 0..6 {
        let mesh = random_rectangle(0.05, 0.04, 3 + seed as usize, seed).unwrap();
        impact(&format!("seed {seed}"), mesh, 0.0, 0.1 * seed as f64, 43);
    }
}

#[test]
fn blocks_over_tilted_planes() {
    let mut random = Random::new(7);
    let angles = [3.0_f64, 10.0].into_iter().map(f64::to_radians);
    let random_angles: Vec<_> = (0..4).map(|_| random.between(-3.1, 3.1)).collect();
    for (seed, tilt) in angles.chain(random_angles).enumerate() {
        let mesh = random_rectangle(0.05, 0.04, 6, seed as u64).unwrap();
        impact(&format!("plane tilted by {tilt}"), mesh, tilt, 0.3, 61);
    }
}

#[test]
fn tilted_blocks() {
    for degrees in [3.0_f64, 10.0, 133.0] {
        let mesh = rotated(&random_rectangle(0.05, 0.04, 6, 3).unwrap(), degrees.to_radians()).unwrap();
        impact(&format!("block tilted by {degrees}°"), mesh, 0.0, 0.2, 71);
    }
}

/// Almost incompressible blocks, also of needles, strike the plane flat and with a corner: rounding in the stress of
/// hats is largest.
#[test]
fn almost_incompressible_blocks() {
    for aspect in [1.0, 1e1, 1e2, 1e3, 1e4] {
        for ratio in [0.3, 0.49, 0.4999, 0.499_99, 0.499_999, 0.499_999_99] {
            for tilt in [0.0, 0.1_f64] {
                let mesh = Mesh::rectangle(0.01 * aspect, 0.0075, 4, 3).unwrap();
                let build = |plane: Option<Obstacle<2>>| {
                    let builder = Problem::<2>::builder(mesh.clone())
                        .material(Elastic::plane_strain(70e9, ratio, 2700.0, 1.0).unwrap())
                        .initial_velocity(Initial::Uniform([4.0, -4.0]));
                    plane.into_iter().fold(builder, percute_core::problem::Builder::obstacle).build().unwrap()
                };
                let times = steps(&build(None), 0.9, 60);
                let gap = 20.0 * times.step(0);
                let problem = build(Some(plane_below(&mesh, tilt, gap, 0.2, None)));
                let (what, history) = (format!("{aspect:e}, ν = {ratio}, {tilt}"), history(&problem, &times));
                assert!(reactions::<2>(&history) > 3, "{what}");
                assert_admissible(&what, &estimate(&problem, &history, Options::default()));
            }
        }
    }
}

#[test]
fn discs_touch_gradually() {
    for (size, tilt) in [(0.01, 0.0), (0.005, 0.0), (0.004, 1.1), (0.003, -2.0)] {
        impact(&format!("disc, {size} m"), disc(0.02, size).unwrap(), tilt, 0.25, 83);
    }
}

#[test]
fn steps_that_change_all_the_time() {
    for (seed, waves) in [(1, 1.0), (2, 3.0), (3, 5.0)] {
        let mesh = random_rectangle(0.05, 0.04, 5, seed).unwrap();
        let plane = plane_below(&mesh, 0.1, GAP, 0.2, None);
        let problem = thrown(mesh, [100.0, -400.0], plane).build().unwrap();
        let what = format!("{waves} waves of steps");
        assert!(check(&what, &problem, &swinging(&problem, 71, waves)) > 3, "{what}");
    }
}

/// Initial velocities that turn the body, stretch it or follow no rule, and a prestrained body: the
/// rotation is free of strain to rounding only, as long as nothing touches.
#[test]
fn initial_fields() {
    let mesh = random_rectangle(0.05, 0.04, 6, 11).unwrap();
    let field =
        |f: &mut dyn FnMut(&[f64; 2]) -> [f64; 2]| Initial::Nodal(mesh.points_in::<2>().iter().map(f).collect());
    let mut random = Random::new(5);
    let fields = [
        ("turning", field(&mut |p| [-8e3 * (p[1] - 0.02), 8e3 * (p[0] - 0.025) - 200.0])),
        ("stretching", field(&mut |p| [3e3 * p[0], -2e3 * p[1] - 100.0])),
        ("random", field(&mut |_| [random.between(-100.0, 100.0), random.between(-300.0, -100.0)])),
    ];
    for (what, velocity) in fields {
        for prestrain in [0.0, 1e-3] {
            let problem = Problem::<2>::builder(mesh.clone())
                .material(aluminium())
                .initial_velocity(velocity.clone())
                .initial_displacement(field(&mut |p| [prestrain * p[0] * p[1] / 0.05, -prestrain * p[0]]))
                .obstacle(plane_below(&mesh, 0.1, GAP, 0.3, None))
                .build()
                .unwrap();
            let what = format!("{what}, prestrain {prestrain}");
            assert!(check(&what, &problem, &steps(&problem, 0.9, 91)) > 3, "{what}");
        }
    }
}
