//! Admissible fields when contact comes and goes.
use crate::properties::bodies::{aluminium, bouncing_bar, gravity, plane_below, steps, thrown};
use crate::properties::estimating::check;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_testkit::{disc, random_rectangle};

/// Steps far below the critical one: nodes rebound and return many times while the body is down.
#[test]
fn small_steps() {
    for courant in [0.05, 0.2, 0.5] {
        let mesh = random_rectangle(0.05, 0.04, 4, 2).unwrap();
        let plane = plane_below(&mesh, 0.0, 6e-5, 0.2, None);
        let problem = thrown(mesh, [50.0, -200.0], plane).build().unwrap();
        let times = steps(&problem, courant, (30.0 / courant) as usize);
        assert!(check(&format!("{courant} of the critical step"), &problem, &times) > 3);
    }
}

/// A body force that brings the body back several times.
#[test]
fn bounces() {
    let meshes = [
        ("block", Mesh::rectangle(0.05, 0.04, 4, 3).unwrap()),
        ("unstructured block", random_rectangle(0.05, 0.04, 4, 2).unwrap()),
        ("disc", disc(0.02, 0.008).unwrap()),
    ];
    for (what, mesh) in meshes {
        for (speed, g) in [(10.0, 1e6), (1.0, 3e6), (0.0, 1e7)] {
            let plane = plane_below(&mesh, 0.02, 1e-5, 0.2, None);
            let builder = thrown(mesh.clone(), [1.0, -speed], plane).body_force(gravity([0.0, -g]));
            let problem = builder.build().unwrap();
            let reactions = check(&format!("{what}, {g} m/s²"), &problem, &steps(&problem, 0.8, 251));
            assert!(reactions > 3);
        }
    }
}

/// Speeds at which a step moves a node by little more than the tolerance of contact.
#[test]
fn slow_bodies() {
    for speed in [1e-2, 1e-4, 1e-6] {
        let mesh = random_rectangle(0.05, 0.04, 4, 5).unwrap();
        let free = Problem::<2>::builder(mesh.clone()).material(aluminium()).build().unwrap();
        let times = steps(&free, 0.3, 101);
        let plane = plane_below(&mesh, 0.0, 1.4 * speed * times.step(0), 0.2, None);
        let problem = thrown(mesh, [0.0, -speed], plane).build().unwrap();
        assert!(check(&format!("{speed} m/s"), &problem, &times) > 3);
    }
}

/// Thin and soft, with one layer of elements.
#[test]
fn thin_strips() {
    for nx in [3, 9] {
        let mesh = Mesh::rectangle(0.05, 0.002, nx, 1).unwrap();
        let plane = plane_below(&mesh, 0.01, 1e-4, 0.5, None);
        let soft = Elastic::plane_stress(1e7, 0.45, 1200.0, 0.01).unwrap();
        let problem = Problem::<2>::builder(mesh)
            .material(soft)
            .initial_velocity(Initial::Uniform([3.0, -5.0]))
            .obstacle(plane)
            .build()
            .unwrap();
        assert!(check(&format!("strip of {nx}"), &problem, &steps(&problem, 0.6, 203)) > 3);
    }
}

/// A bar that a body force presses on the plane again and again.
#[test]
fn a_bouncing_bar() {
    for courant in [0.1, 0.5, 0.9, 1.0] {
        let points: Vec<_> = (0..=12).map(|i| [0.1 * (f64::from(i) / 12.0).powf(1.3)]).collect();
        let cells: Vec<_> = (0..12).map(|e| [e, e + 1]).collect();
        let groups = [("start".to_string(), vec![[0]])].into();
        let mesh = Mesh::new(points, &cells, &groups, &Default::default()).unwrap();
        let problem = bouncing_bar(mesh);
        assert!(check(&format!("bar, {courant}"), &problem, &steps(&problem, courant, 307)) > 3);
    }
}
