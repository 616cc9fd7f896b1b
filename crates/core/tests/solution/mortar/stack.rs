//! Three blocks, one above the other, with two interfaces, of which the middle one has both roles.

use super::law::{check_energy, check_law, check_steps};
use super::setup::{GAP, HEIGHT, steel, steps};
use crate::solution::run::{aluminium, run};
use percute_core::contact::{Interface, Obstacle};
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_testkit::translated;

/// Cells of the blocks from below, along and across.
const CELLS: [[usize; 2]; 3] = [[14, 9], [19, 12], [25, 16]];

/// The blocks with these velocities (m/s), on a plane perhaps. The middle one is of steel.
fn stack(velocities: [[f64; 2]; 3], plane: Option<Obstacle<2>>) -> Problem<2> {
    let block = |k: usize| {
        let [nx, ny] = CELLS[k];
        let mesh = Mesh::rectangle(0.04, HEIGHT, nx, ny).unwrap();
        translated(&mesh, [0.0, k as f64 * (HEIGHT + GAP)]).unwrap()
    };
    let blocks = [block(0), block(1), block(2)];
    let names = ["lower", "middle", "upper"];
    let bodies: Vec<(&str, &Mesh)> = names.into_iter().zip(&blocks).collect();
    let velocity = (0..3).flat_map(|k| vec![velocities[k]; blocks[k].node_count()]).collect();
    let between = |below: &str, above: &str| {
        Interface::non_matching(2, format!("{above}.bottom"), format!("{below}.top"), 0.2).unwrap()
    };
    let mut builder = Problem::<2>::builder(Mesh::joined(&bodies).unwrap())
        .material_of("lower", aluminium())
        .material_of("middle", steel())
        .material_of("upper", aluminium())
        .initial_velocity(Initial::Nodal(velocity))
        .interface(between("lower", "middle"))
        .interface(between("middle", "upper"));
    if let Some(plane) = plane {
        builder = builder.obstacle(plane);
    }
    builder.build().unwrap()
}

#[test]
fn two_interfaces_keep_momentum_and_energy() {
    let problem = stack([[4.0, 20.0], [0.0, 0.0], [-4.0, -20.0]], None);
    let slaves: Vec<usize> =
        problem.surface().non_matching().iter().map(|non_matching| non_matching.slave().len()).collect();
    assert_eq!(slaves, [CELLS[1][0] + 1, CELLS[2][0] + 1]);
    let run = run(&problem, &steps(&problem, 20e-6));
    let seen = check_steps(&run);
    check_energy(&run);
    assert!(seen.reactions > 1000 && seen.slips > 100, "{seen:?}");
    for non_matching in problem.surface().non_matching() {
        let pressed = |n: usize| run.history.step(n).unwrap().touching[non_matching.slave().position(3)];
        assert!((0..run.last()).any(pressed));
    }
}

/// The lowest one strikes a plane, too, at nodes of its other side.
#[test]
fn a_body_may_have_interfaces_and_a_plane() {
    let floor = Obstacle::plane([0.0, -GAP], [0.0, 1.0], 0.2, Some("lower.bottom".into())).unwrap();
    let problem = stack([[6.0, -20.0], [0.0, -40.0], [-6.0, -60.0]], Some(floor));
    let run = run(&problem, &steps(&problem, 25e-6));
    let seen = check_law(&run);
    check_energy(&run);
    assert!(seen.reactions > 1000 && seen.slips > 100, "{seen:?}");
    let surface = problem.surface();
    let floor: Vec<usize> = (0..surface.nodes().len()).filter(|&at| surface.nodes()[at].obstacle == 0).collect();
    assert_eq!(floor.len(), CELLS[0][0] + 1);
    let mut touches = 0;
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        for &at in &floor {
            let gap = surface.gap(at, &step.displacement()[surface.nodes()[at].node.index()]);
            assert!(gap >= -1e-12 * problem.mesh().size(), "step {n}: {gap}");
            touches += usize::from(step.touching[at]);
        }
    }
    assert!(touches > 100, "{touches}");
}
