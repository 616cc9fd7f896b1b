//! Half a body on its plane of symmetry moves as the whole: a node that a support guides along the
//! obstacle touches it like any other.

use crate::solution::run::{aluminium, run};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::load::Support;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::random_rectangle;

/// The mesh and its mirror image in x = 0, on which its left side lies.
fn doubled(half: &Mesh) -> Mesh {
    let mut points = half.points_in::<2>().to_vec();
    let image: Vec<usize> = half
        .points_in::<2>()
        .iter()
        .enumerate()
        .map(|(i, p)| {
            if p[0] == 0.0 {
                return i;
            }
            points.push([-p[0], p[1]]);
            points.len() - 1
        })
        .collect();
    let cells = half.nodes_of::<3>().iter().map(|c| c.map(|n| n.index()));
    let cells: Vec<_> = cells.clone().chain(cells.map(|c| c.map(|n| image[n]))).collect();
    Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new()).unwrap()
}

fn dropped(mesh: Mesh, guide: bool) -> Problem<2> {
    let builder = Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform([0.0, -100.0]))
        .obstacle(Obstacle::plane([0.0, -3e-4], [0.0, 1.0], 0.3, None).unwrap());
    let left = Support { group: "left".to_string(), components: [true, false, false], velocity: None };
    if guide { builder.support(left) } else { builder }.build().unwrap()
}

#[test]
fn half_a_body_moves_as_the_whole() {
    let half_mesh = random_rectangle(0.02, 0.03, 6, 11).unwrap();
    let (whole, half) = (dropped(doubled(&half_mesh), false), dropped(half_mesh, true));
    assert_eq!(half.surface().nodes().iter().filter(|c| c.guided).count(), 1);
    assert!(half.surface().nodes().iter().all(|c| c.free));
    let times = TimeGrid::uniform(60.0 * 0.8 * critical_time_step(&whole), 60).unwrap();
    let (whole, half) = (run(&whole, &times), run(&half, &times));
    let mut touched = false;
    for n in 0..=60 {
        let (a, b) = (half.history.step(n).unwrap(), whole.history.step(n).unwrap());
        touched |= a.touching.iter().any(|t| *t);
        for (u, v) in a.displacement::<2>().iter().zip(b.displacement::<2>()) {
            // Displacements reach 5 mm; rounding of sums in another order grows over 60 steps.
            assert!((u[0] - v[0]).hypot(u[1] - v[1]) < 1e-14, "step {n}: {u:?} against {v:?}");
        }
    }
    assert!(touched);
}

/// A component along the normal takes the node out of contact.
#[test]
fn a_node_held_along_the_normal_is_no_candidate() {
    let mesh = random_rectangle(0.02, 0.03, 6, 11).unwrap();
    let held = Support { group: "left".to_string(), components: [true, true, false], velocity: None };
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .support(held)
        .obstacle(Obstacle::plane([0.0, -3e-4], [0.0, 1.0], 0.3, None).unwrap())
        .build()
        .unwrap();
    assert_eq!(problem.surface().nodes().iter().filter(|c| !c.free).count(), 1);
    assert!(problem.surface().nodes().iter().all(|c| !c.guided));
}
