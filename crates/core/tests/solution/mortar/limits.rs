//! Special cases with another solution: pairs of nodes, and a rigid plane.

use super::setup::{Blocks, GAP, HEIGHT, steps};
use crate::solution::run::{aluminium, difference, largest, run};
use percute_core::contact::{Interface, Obstacle};
use percute_core::contact_results::ContactRecorder;
use percute_core::history::StepSource;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_testkit::{translated, upside_down};

/// Two blocks of the same nodes that meet as mirror images do not slide: mortar is pairs, row by row.
#[test]
fn matching_surfaces_are_pairs() {
    let block = Mesh::rectangle(0.04, HEIGHT, 8, 6).unwrap();
    let upper = translated(&block, [0.0, GAP]).unwrap();
    let lower = translated(&upside_down(&block).unwrap(), [0.0, -GAP]).unwrap();
    let mesh = Mesh::joined(&[("upper", &upper), ("lower", &lower)]).unwrap();
    let half = upper.node_count();
    let velocity: Vec<_> = (0..mesh.node_count()).map(|i| [3.0, if i < half { -20.0 } else { 20.0 }]).collect();
    let problem = |interface| {
        Problem::<2>::builder(mesh.clone())
            .material(aluminium())
            .initial_velocity(Initial::Nodal(velocity.clone()))
            .interface(interface)
            .build()
            .unwrap()
    };
    let groups = ["upper.bottom", "lower.bottom"];
    let pairs = problem(Interface::matching(2, groups[0], groups[1], 0.2).unwrap());
    let mortar = problem(Interface::non_matching(2, groups[0], groups[1], 0.2).unwrap());
    let times = steps(&pairs, 25e-6);
    let (expected, found) = (run(&pairs, &times), run(&mortar, &times));
    // Rows by their nodes: the order along the surface is another one.
    let rows = |run: &crate::solution::run::Run<'_, 2>, n: usize| {
        let step = run.history.step(n).unwrap();
        let mut rows = vec![([0.0; 2], false); run.problem.mesh().node_count()];
        for (at, node) in run.contact_nodes().into_iter().enumerate() {
            rows[node] = (step.reaction()[at], step.touching[at]);
        }
        rows
    };
    let mut most = 0.0_f64;
    for n in 0..=expected.last() {
        let (u, v) = (expected.displacement(n), found.displacement(n));
        assert!(difference(u, v) <= 1e-12 * largest(u), "step {n}: {}", difference(u, v));
        let (pairs, mortar) = (rows(&expected, n), rows(&found, n));
        most = pairs.iter().flat_map(|row| row.0).fold(most, |most, force| most.max(force.abs()));
        for (node, (pair, row)) in pairs.iter().zip(&mortar).enumerate() {
            assert_eq!(pair.1, row.1, "step {n}, node {node}");
            assert!((0..2).all(|c| (pair.0[c] - row.0[c]).abs() <= 1e-10 * most), "step {n}, node {node}: {pair:?}");
        }
    }
    assert!(most > 0.0);
}

/// A master of 10⁹ times the stiffness and the density is a rigid plane.
#[test]
fn a_heavy_stiff_master_is_a_rigid_plane() {
    const TIMES: f64 = 1e9;
    let heavy = Elastic::plane_stress(70e9 * TIMES, 0.3, 2700.0 * TIMES, 1.0).unwrap();
    let blocks = Blocks {
        widths: [0.04, 0.05],
        aside: 0.005,
        materials: [aluminium(), heavy],
        velocities: [[8.0, -20.0], [0.0, 0.0]],
        ..Blocks::oblique()
    };
    let problem = blocks.problem();
    let times = steps(&problem, 20e-6);
    let both = run(&problem, &times);
    let upper = Mesh::rectangle(0.04, HEIGHT, 14, 11).unwrap();
    let alone = Problem::<2>::builder(translated(&upper, [0.005, HEIGHT + GAP]).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([8.0, -20.0]))
        .obstacle(Obstacle::plane([0.0, HEIGHT], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap();
    let single = run(&alone, &times);
    let nodes = alone.mesh().node_count();
    for n in 0..=single.last() {
        let expected = single.displacement(n);
        assert!(difference(&both.displacement(n)[..nodes], expected) <= 5e-9 * largest(expected), "step {n}");
    }
}

/// The ends of bars are pairs whatever the interface.
#[test]
fn bars_are_pairs() {
    let bar = |start: f64| Mesh::uniform_bar(0.3, 10).unwrap().mapped(|p| [p[0] + start]).unwrap();
    let mesh = Mesh::joined(&[("left", &bar(-0.3)), ("right", &bar(1e-4))]).unwrap();
    let interface = Interface::non_matching(1, "left.end", "right.start", 0.0).unwrap();
    assert!(interface.is_matching());
    let problem = Problem::<1>::builder(mesh)
        .material(Elastic::bar(70e9, 2700.0, 1e-4).unwrap())
        .interface(interface)
        .build()
        .unwrap();
    assert!(problem.surface().non_matching().is_empty() && problem.surface().nodes()[0].partner == Some(1));
}

/// Contact results of both sides: opposite resultants, gaps of what faces something.
#[test]
fn results_know_both_sides() {
    let blocks = Blocks { widths: [0.02, 0.04], aside: 0.0113, ..Blocks::oblique() };
    let problem = blocks.problem();
    let run = run(&problem, &steps(&problem, 14e-6));
    let recorder = ContactRecorder::new(&problem, run.history.times()).keeping_steps().unwrap();
    let results = recorder.replay(&run.history).unwrap();
    let steps = results.steps.as_ref().unwrap();
    let (surface, count) = (problem.surface(), problem.surface().nodes().len());
    let peak = results.total.iter().map(|total| total.normal_force).fold(0.0, f64::max);
    assert!(peak > 0.0 && results.slip == 0.0);
    for n in 0..results.instants.len() {
        let [upper, lower] = [0, 1].map(|obstacle| results.obstacles[obstacle][n]);
        assert_eq!(upper, results.total[n]);
        // Sums of some ten forces.
        assert!((0..2).all(|c| (upper.force[c] + lower.force[c]).abs() <= 1e-13 * peak), "step {n}");
        for at in 0..count {
            let x = surface.point(at)[0];
            let gap = steps.gap[n * count + at];
            let faces = surface.nodes()[at].obstacle == 0 || (x > 0.0115 && x < 0.0311);
            let apart = surface.nodes()[at].obstacle == 1 && !(0.0111..=0.0315).contains(&x);
            assert!(!faces || gap.is_finite(), "step {n}, {x}: {gap}");
            assert!(!apart || gap == f64::INFINITY, "step {n}, {x}: {gap}");
            if n == 0 && faces {
                assert!((gap - GAP).abs() < 1e-15, "{x}: {gap}");
            }
        }
    }
    // What friction takes is weighted on the slave; the balance has the forces and motions of all nodes.
    let friction = results.total[results.total.len() - 1].friction_energy;
    let balance = run.simulation.balance.friction;
    assert!(friction > 0.0 && (friction / balance - 1.0).abs() < 0.02, "{friction} {balance}");
}
