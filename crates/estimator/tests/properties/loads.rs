//! Admissible fields under supports and loads.

use crate::properties::bodies::{aluminium, fixed, gravity, in_two_groups, plane_below, steps, swinging, thrown};
use crate::properties::estimating::{check, history};
use percute_core::contact::Obstacle;
use percute_core::load::{BodyForce, Profile, Support, Table, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::{ElementGroups, Mesh};
use percute_core::problem::{Initial, Problem};
use percute_testkit::random_rectangle;

fn block(seed: u64) -> Mesh {
    random_rectangle(0.05, 0.04, 5, seed).unwrap()
}

fn pull(group: &str, value: Table, gradient: [f64; 2]) -> Traction {
    Traction {
        group: group.to_string(),
        value,
        profile: Profile { value: 1.0, gradient: [gradient[0], gradient[1], 0.0] },
    }
}

/// Up and down within 20 µs; the instants of the steps miss its corners.
fn pulse(peak: [f64; 2]) -> Table {
    Table::new(vec![0.0, 3.3e-6, 7.1e-6, 2e-5], vec![[0.0; 2], peak, peak.map(|p| -0.3 * p), [0.0; 2]]).unwrap()
}

/// No node touches; every side in turn is clamped or on rollers, and its neighbour is loaded.
#[test]
fn supported_and_pulled() {
    let sides = ["left", "bottom", "right", "top"];
    for (k, side) in sides.iter().enumerate() {
        for components in [[true, false], [false, true], [true, true]] {
            let next = sides[(k + 1) % 4];
            let problem = Problem::<2>::builder(block(k as u64))
                .material(aluminium())
                .support(fixed(side, components))
                .traction(pull(next, pulse([3e8, -1e8]), [20.0, -35.0]))
                .traction(pull(sides[(k + 2) % 4], Table::constant([1e7, 2e7]), [0.0, 10.0]))
                .build()
                .unwrap();
            check(&format!("{side} {components:?}"), &problem, &steps(&problem, 0.9, 33));
        }
    }
}

/// Rollers on two sides that share a corner, and on all four: stars without free faces.
#[test]
fn boxes_on_rollers() {
    for sides in [vec!["left", "bottom"], vec!["left", "bottom", "right", "top"]] {
        let mut builder = Problem::<2>::builder(block(4)).material(aluminium());
        for side in &sides {
            builder = builder
                .support(fixed(side, if ["left", "right"].contains(side) { [true, false] } else { [false, true] }));
        }
        let velocity = builder.body_force(BodyForce { group: None, value: pulse([4e9, -7e9]) });
        let problem = velocity.build().unwrap();
        check(&format!("{sides:?}"), &problem, &steps(&problem, 0.9, 33));
    }
}

/// A body struck from below while its top is driven along a table of velocities.
#[test]
fn driven_into_a_plane() {
    for (seed, components) in [(1, [true, true, false]), (2, [false, true, false])] {
        let mesh = block(seed);
        let plane = plane_below(&mesh, 0.0, 4e-5, 0.3, None);
        let value = vec![[0.0, -100.0], [30.0, -60.0], [-30.0, 40.0], [0.0, 40.0]];
        let velocity = Table::new(vec![0.0, 4e-6, 9e-6, 2e-5], value).unwrap();
        let problem = thrown(mesh, [0.0, -100.0], plane)
            .support(Support { group: "top".to_string(), components, velocity: Some(velocity) })
            .build()
            .unwrap();
        assert!(check(&format!("driven {components:?}"), &problem, &steps(&problem, 0.7, 61)) > 3);
        assert!(check(&format!("driven {components:?}, swinging"), &problem, &swinging(&problem, 61, 3.0)) > 3);
    }
}

/// A clamped side that starts at a corner of the contact surface: that corner is no candidate.
#[test]
fn a_clamp_beside_contact() {
    let mesh = block(6);
    let plane = plane_below(&mesh, 0.0, 4e-5, 0.2, Some("bottom"));
    let problem = thrown(mesh, [0.0, 0.0], plane)
        .support(fixed("left", [true, true]))
        .traction(pull("top", Table::constant([0.0, -5e8]), [0.0, 0.0]))
        .build()
        .unwrap();
    assert!(check("clamp beside contact", &problem, &steps(&problem, 0.9, 61)) > 3);
}

/// With a roller instead, the corner is guided along the side and touches the plane like any other
/// node: its normal motion is not prescribed.
#[test]
fn a_corner_on_a_roller_touches() {
    let mesh = block(6);
    let plane = plane_below(&mesh, 0.0, 4e-5, 0.2, Some("bottom"));
    let problem = thrown(mesh, [0.0, -100.0], plane).support(fixed("left", [true, false])).build().unwrap();
    assert!(problem.surface().nodes().iter().any(|node| node.guided && node.free));
    assert!(check("roller beside contact", &problem, &steps(&problem, 0.9, 61)) > 3);
}

/// Thrown to and fro between two planes that are not quite parallel.
#[test]
fn two_planes() {
    let plane = |point, normal, mu, group: &str| Obstacle::plane(point, normal, mu, Some(group.to_string())).unwrap();
    let problem = Problem::<2>::builder(block(8))
        .material(Elastic::plane_strain(70e9, 0.3, 2700.0, 0.5).unwrap())
        .initial_velocity(Initial::Uniform([50.0, -250.0]))
        .obstacle(plane([0.0, -2e-4], [0.0, 1.0], 0.1, "bottom"))
        // Leans over the body, and clears its corner (0.05, 0.04) by 2e-4.
        .obstacle(plane([0.0, 0.0412], [-0.02, -1.0], 0.4, "top"))
        .build()
        .unwrap();
    let times = steps(&problem, 0.9, 81);
    assert!(check("two planes", &problem, &times) > 3);
    let history = history(&problem, &times);
    for plane in 0..2 {
        let touches = |n: usize| {
            let step = history.step(n).unwrap();
            problem.surface().nodes().iter().zip(step.touching).any(|(c, t)| c.obstacle == plane && *t)
        };
        assert!((0..history.len()).any(touches), "plane {plane} is never touched");
    }
}

/// Two materials with two thicknesses, loaded apart.
#[test]
fn two_materials() {
    for seed in 0..3 {
        let mesh = in_two_groups(&block(seed), |c| c[0] + 0.3 * c[1] < 0.027);
        let plane = plane_below(&mesh, 0.05, 1e-4, 0.2, None);
        let problem = Problem::<2>::builder(mesh)
            .material_of("first", Elastic::plane_stress(210e9, 0.28, 7800.0, 0.03).unwrap())
            .material_of("second", Elastic::plane_strain(3e9, 0.4, 1200.0, 0.011).unwrap())
            .initial_velocity(Initial::Uniform([20.0, -150.0]))
            .obstacle(plane)
            .body_force(BodyForce { group: Some("second".to_string()), value: pulse([1e9, -3e9]) })
            .traction(pull("top", pulse([1e7, -5e7]), [30.0, 0.0]))
            .build()
            .unwrap();
        assert!(check(&format!("two materials, seed {seed}"), &problem, &steps(&problem, 0.9, 81)) > 3);
    }
}

/// Bars with elements of many lengths, two sections, a support or a load at the far end.
#[test]
fn uneven_bars() {
    let points: Vec<_> = (0..=20).map(|i| [0.1 * (f64::from(i) / 20.0).powf(1.6)]).collect();
    let cells: Vec<_> = (0..20).map(|e| [e, e + 1]).collect();
    let ends = [("start".to_string(), vec![[0]]), ("end".to_string(), vec![[20]])].into();
    let mesh = Mesh::new(points, &cells, &ends, &ElementGroups::new()).unwrap();
    let mesh = in_two_groups(&mesh, |c| c[0] < 0.04);
    let table = |v: [f64; 3]| Table::new(vec![0.0, 8e-6, 3e-5], v.map(|x| [x]).to_vec()).unwrap();
    for end in 0..3 {
        let builder = Problem::<1>::builder(mesh.clone())
            .material_of("first", Elastic::bar(70e9, 2700.0, 0.02).unwrap())
            .material_of("second", Elastic::bar(210e9, 7800.0, 0.005).unwrap())
            .initial_velocity(Initial::Uniform([-30.0]))
            .obstacle(Obstacle::plane([-1e-5], [1.0], 0.0, None).unwrap());
        let moved = Support {
            group: "end".to_string(),
            components: [true, false, false],
            velocity: Some(table([-30.0, 20.0, -5.0])),
        };
        let load = Traction { group: "end".to_string(), value: table([0.0, -4e8, 1e8]), profile: Profile::UNIFORM };
        let problem = match end {
            0 => builder.body_force(gravity([-1e5])),
            1 => builder.support(moved),
            _ => builder.traction(load),
        };
        let problem = problem.build().unwrap();
        assert!(check(&format!("bar, end {end}"), &problem, &steps(&problem, 0.9, 181)) > 3);
        assert!(check(&format!("bar, end {end}, swinging"), &problem, &swinging(&problem, 181, 4.0)) > 3);
    }
}
