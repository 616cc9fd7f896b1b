//! Motions that the finite elements represent exactly: no error but rounding.

use percute_core::dynamics::critical_time_step;
use percute_core::load::{BodyForce, Profile, Support, Table, Traction};
use percute_core::material::{Elastic, Law, LinearLaw};
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::{Acceleration, Options, Reconstruction, Request};

/// Estimates with every reconstruction and option over 40 steps; e_sup (J^½) is at most 1e-12 of the root
/// of an energy (J) of the motion: rounding of 1e-16, times the some hundred operations on a field
/// and the cancellation of neighbouring values in strains.
#[track_caller]
fn assert_no_error<const D: usize>(problem: &Problem<D>, energy: f64) {
    let times = TimeGrid::uniform(40.0 * 0.9 * critical_time_step(problem), 40).unwrap();
    for &reconstruction in Reconstruction::ALL {
        for &acceleration in Acceleration::of(reconstruction) {
            let options = Options { acceleration: Some(acceleration), reconstruction, ..Options::default() };
            let (_, estimate) =
                crate::common::beside::run(problem, &times, options, &Request::default(), &mut Unobserved);
            let error = estimate.error.sup / energy.sqrt();
            assert!(error < 1e-12, "{acceleration}, {reconstruction}: {error}");
        }
    }
}

/// A rectangle of 2 × 1 m in 6 × 4 cells whose inner nodes were moved by up to a quarter of a cell,
/// so that no two elements are alike.
fn distorted() -> Mesh {
    let (nx, ny) = (6, 4);
    let id = |i: usize, j: usize| j * (nx + 1) + i;
    let mut points = Vec::new();
    for j in 0..=ny {
        for i in 0..=nx {
            let inner = i > 0 && i < nx && j > 0 && j < ny;
            let shift = |k: f64| if inner { 0.25 * (k * (3 * i + 7 * j) as f64).sin() } else { 0.0 };
            points.push([(i as f64 + shift(1.3)) / 3.0, (j as f64 + shift(2.1)) / 4.0]);
        }
    }
    let cells: Vec<_> = (0..ny)
        .flat_map(|j| {
            (0..nx).flat_map(move |i| {
                [[id(i, j), id(i + 1, j), id(i + 1, j + 1)], [id(i, j), id(i + 1, j + 1), id(i, j + 1)]]
            })
        })
        .collect();
    let groups = FaceGroups::from([
        ("bottom".to_string(), (0..nx).map(|i| [id(i, 0), id(i + 1, 0)]).collect()),
        ("top".to_string(), (0..nx).map(|i| [id(i, ny), id(i + 1, ny)]).collect()),
        ("left".to_string(), (0..ny).map(|j| [id(0, j), id(0, j + 1)]).collect()),
        ("right".to_string(), (0..ny).map(|j| [id(nx, j), id(nx, j + 1)]).collect()),
    ]);
    Mesh::new(points, &cells, &groups, &ElementGroups::new()).unwrap()
}

fn law() -> Elastic {
    Elastic::plane_strain(70e9, 0.3, 2700.0, 0.1).unwrap()
}

fn bar_law() -> Elastic {
    Elastic::bar(70e9, 2700.0, 0.02).unwrap()
}

/// ½mv² of the bodies below at 50 m/s.
const SPEED: f64 = 50.0;
fn kinetic(volume: f64) -> f64 {
    0.5 * 2700.0 * volume * SPEED * SPEED
}

#[test]
fn rigid_translation() {
    let velocity = Initial::Uniform([0.8 * SPEED, -0.6 * SPEED]);
    let block = Problem::<2>::builder(distorted()).material(law()).initial_velocity(velocity).build().unwrap();
    assert_no_error(&block, kinetic(0.2));
    let bar = Mesh::uniform_bar(1.0, 9).unwrap();
    let bar =
        Problem::<1>::builder(bar).material(bar_law()).initial_velocity(Initial::Uniform([-SPEED])).build().unwrap();
    assert_no_error(&bar, kinetic(0.02));
}

/// The same acceleration at all nodes: velocity linear and displacement quadratic in time, as
/// the kinematic field has them.
#[test]
fn free_flight_under_gravity() {
    // So strong that 40 steps change the speed by as much as there is.
    let weight = |g: f64| 2700.0 * g;
    let force = BodyForce { group: None, value: Table::constant([weight(1e5), weight(-1e6)]) };
    let velocity = Initial::Uniform([0.8 * SPEED, 0.6 * SPEED]);
    let block = Problem::<2>::builder(distorted()).material(law()).initial_velocity(velocity).body_force(force);
    assert_no_error(&block.build().unwrap(), kinetic(0.2));
    let force = BodyForce { group: None, value: Table::constant([weight(-1e6)]) };
    let bar = Problem::<1>::builder(Mesh::uniform_bar(1.0, 9).unwrap()).material(bar_law()).body_force(force);
    let bar = bar.initial_velocity(Initial::Uniform([SPEED])).build().unwrap();
    assert_no_error(&bar, kinetic(0.02));
}

/// A uniform stress under its own tractions, started with its own linear displacement, stays: it
/// is both admissible fields. So does one that a side holds, wherever that side is held.
#[test]
fn uniform_stress() {
    let gradient = [[1e-3, 4e-4], [-2e-4, -5e-4]];
    let stress = law().stress(&gradient);
    let mesh = distorted();
    let displacement = mesh.points_in::<2>().iter().map(|p| gradient.map(|g| g[0] * p[0] + g[1] * p[1])).collect();
    let free = Problem::<2>::builder(mesh).material(law()).initial_displacement(Initial::Nodal(displacement));
    for held in [None, Some("left"), Some("top")] {
        let mut builder = free.clone();
        let sides = [("left", [-1.0, 0.0]), ("right", [1.0, 0.0]), ("bottom", [0.0, -1.0]), ("top", [0.0, 1.0])];
        for (group, normal) in sides {
            let value = Table::constant(stress.map(|s| s[0] * normal[0] + s[1] * normal[1]));
            builder = if held == Some(group) {
                builder.support(Support { group: group.into(), components: [true, true, false], velocity: None })
            } else {
                builder.traction(Traction { group: group.into(), value, profile: Profile::UNIFORM })
            };
        }
        assert_no_error(&builder.build().unwrap(), 0.2 * law().complementary_energy(&stress));
    }

    let mesh = Mesh::uniform_bar(1.0, 9).unwrap();
    let displacement = mesh.points_in::<1>().iter().map(|p| [1e-3 * p[0]]).collect();
    let bar = Problem::<1>::builder(mesh)
        .material(bar_law())
        .initial_displacement(Initial::Nodal(displacement))
        .support(Support { group: "start".into(), components: [true, false, false], velocity: None })
        .traction(Traction { group: "end".into(), value: Table::constant([70e6]), profile: Profile::UNIFORM })
        .build()
        .unwrap();
    assert_no_error(&bar, 0.5 * 0.02 * 70e9 * 1e-6);
}
