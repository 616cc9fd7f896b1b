//! Shapes of the tractions of a block on its corner, and the own force of a node that touches alone.

use super::own_forces::OwnForces;
use super::star::CandidateEdge;
use super::*;
use crate::contact_density::{Densities, nodal_forces};
use crate::reconstruction::corrected::auxiliary_solution::Approach;
use crate::reconstruction::{StepDensities, SurfaceSteps, check};
use crate::time_level::SurfaceStep;
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::TriangleMesh;
use percute_core::problem::{Initial, TriangleProblem};
use std::collections::BTreeMap;

const YOUNG: f64 = 70e9;

/// A block of 2 × 1 m in 8×4 cells, on a plane that is turned by 10° under it.
fn tilted() -> TriangleProblem {
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    Problem::builder(TriangleMesh::rectangle(2.0, 1.0, 8, 4).unwrap())
        .material(Elastic::plane_stress(YOUNG, 0.3, 2700.0, 0.5).unwrap())
        .initial_velocity(Initial::Uniform([0.0, -1.0]))
        .obstacle(Obstacle::plane([0.0, -1e-3], [sin, cos], 0.2, None).unwrap())
        .build()
        .unwrap()
}

fn gaps(problem: &TriangleProblem) -> Vec<f64> {
    problem.surface().gaps(&vec![[0.0; 2]; problem.mesh().node_count()])
}

/// The surface at an instant without any force of the simulation.
fn free_step(problem: &TriangleProblem) -> SurfaceStep<2> {
    let count = problem.surface().nodes().len();
    SurfaceStep {
        reaction: vec![[0.0; 2]; count],
        force: vec![[0.0; 2]; count],
        arresting: vec![[0.0; 2]; count],
        touching: vec![false; count],
        gap: gaps(problem),
    }
}

/// The node nearest to the plane, and a normal force on it with some friction.
fn corner(problem: &TriangleProblem) -> (usize, [f64; 2]) {
    let gap = gaps(problem);
    let at = (0..gap.len()).min_by(|&a, &b| gap[a].total_cmp(&gap[b])).unwrap();
    let frame = problem.obstacles()[0].flat_frame();
    let normal = *frame.normal();
    (at, [1e6 * normal[0] + 1e5 * normal[1], 1e6 * normal[1] - 1e5 * normal[0]])
}

/// Hats and the wide part have the resultant of the force, and its moment about the node where the centroid is.
#[test]
fn tractions_have_the_force_and_its_centroid() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    for scale in [1e-3, 1.0, 1e3] {
        let force = force.map(|f| scale * f);
        let shape = concentration.shape(&problem, at, &force, &gaps(&problem)).unwrap();
        let hats: Vec<_> = concentration.hats(at, &shape, &force).collect();
        let values = |f: usize, k: usize| if k == at { concentration.wide(k, f, &shape, &force) } else { [0.0; 2] };
        let densities = Densities::with_hats(&problem, |f, facet| facet.nodes.map(|k| values(f, k)), hats);
        let (mut sum, mut moment) = ([0.0; 2], 0.0);
        let origin = problem.surface().point(at);
        for (k, f) in nodal_forces(&problem, &densities).iter().enumerate() {
            let arm: [f64; 2] = std::array::from_fn(|c| problem.surface().point(k)[c] - origin[c]);
            (0..2).for_each(|c| sum[c] += f[c]);
            moment += arm[0] * f[1] - arm[1] * f[0];
        }
        let centroid = concentration.centroid(&problem, at, &shape);
        let expected = centroid[0] * force[1] - centroid[1] * force[0];
        // Rounding of some ten terms of the size of the force, on edges of 0.25 m.
        assert!((0..2).all(|c| (sum[c] - force[c]).abs() < 1e-13 * force[1]), "{sum:?}");
        assert!((moment - expected).abs() < 1e-13 * force[1], "{moment} {expected}");
    }
}

/// Nodes of equal stars share forms; a flat zone needs none.
#[test]
fn congruent_stars_share_their_stress() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let alike: BTreeSet<_> = concentration.nodes.iter().map(|star| star.alike).collect();
    assert!(alike.len() <= 5 && concentration.nodes.len() == 13, "{} of {}", alike.len(), concentration.nodes.len());
    let flat = vec![0.0; concentration.nodes.len()];
    assert!((0..flat.len()).all(|at| concentration.shape(&problem, at, &[0.0, 1e6], &flat).is_none()));
    assert!(concentration.stresses.iter().all(|stress| stress.get().is_none()));
}

/// A polygon of equal triangles around its centre: the stars of all its corners are copies of one, turned. Rounding of the
/// corners may put some on the other side of a bound of congruence.
#[test]
fn turned_stars_share_their_stress() {
    let corner = |k: usize| {
        let (sin, cos) = (0.3 + 2.0 * std::f64::consts::PI * k as f64 / 24.0).sin_cos();
        [3.0 + cos, 2.0 + sin]
    };
    let points: Vec<_> = std::iter::once([3.0, 2.0]).chain((0..24).map(corner)).collect();
    let cells: Vec<[usize; 3]> =
        (0..24).map(|k| [[k + 1, (k + 1) % 24 + 1, 0], [0, k + 1, (k + 1) % 24 + 1]][k % 2]).collect();
    let problem = Problem::builder(TriangleMesh::new(points, &cells, &BTreeMap::new(), &BTreeMap::new()).unwrap())
        .material(Elastic::plane_stress(YOUNG, 0.3, 2700.0, 0.5).unwrap())
        .initial_velocity(Initial::Uniform([0.0, -1.0]))
        .obstacle(Obstacle::plane([0.0, 0.9], [0.0, 1.0], 0.2, None).unwrap())
        .build()
        .unwrap();
    let concentration = Concentration::new(&problem);
    let inner = concentration.nodes.iter().filter(|star| star.edges.len() == 2);
    let alike: BTreeSet<_> = inner.clone().map(|star| star.alike).collect();
    assert!(alike.len() <= 4 && inner.count() == 11, "{}", alike.len());
    // Two elements, two edges: 12 kB for each element.
    let memory = concentration.memory(&problem);
    assert!(memory > 24_000 * alike.len() && memory < 25_000 * (alike.len() + 2), "{memory}");
    // Hats in the frame of a star have the same stress in each of them.
    let stress = |at: usize| {
        let NodeStar { edges, elements, corners, frame, .. } = &concentration.nodes[at];
        let hats = [0, 1].map(|edge| {
            let CandidateEdge { facet, end, .. } = edges[edge];
            NarrowHat { node: at, facet, end, edge, halvings: 3 + edge, resultant: frame.global([1e5, 3e4]) }
        });
        let stress = concentration.in_element(&problem, &hats, elements[0]).unwrap();
        let products = stress.products();
        // At both ends of the facet opposite to the node of the star.
        let vector = |p: usize| frame.own([0, 1].map(|c| products[4 * corners[0] + 2 * p + c]));
        [[stress.energy(), 0.0], vector(0), vector(1)].concat()
    };
    let inner: Vec<_> = (0..concentration.nodes.len()).filter(|&at| concentration.nodes[at].edges.len() == 2).collect();
    let first = stress(inner[0]);
    for at in inner {
        let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-11 * b.abs();
        assert!(stress(at).iter().zip(&first).all(close), "{:?} {first:?}", stress(at));
    }
}

/// Under its own force a node comes to its plane, with the compliance of its traction. The force is none where it stays off
/// the plane, and never above the largest that is allowed; it goes on after the release of the simulation, but does not grow.
#[test]
fn own_forces_close_the_gap() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    let gap = gaps(&problem);
    let frame = problem.obstacles()[0].flat_frame();
    let most = frame.split(&force).0;
    let apply = |own: &mut OwnForces<2>, given: [f64; 2], approach: Approach| {
        let mut contact = vec![[0.0; 2]; gap.len()];
        contact[at] = given;
        let mut arresting = contact.clone();
        own.apply(&problem, &concentration, &gap, |_| approach, [&mut contact, &mut arresting]);
        // The work of the reaction of a node with a force of its own is not measured.
        assert_eq!(arresting[at], [0.0; 2]);
        contact[at]
    };
    let approach = |gap: f64| Approach { gap, mobility: 1e-12 };
    let mut own = OwnForces::new(&problem);
    assert_eq!(apply(&mut own.clone(), force, approach(1e-9)), [0.0; 2]);
    assert!((frame.split(&apply(&mut own.clone(), force, approach(-1.0))).0 / most - 1.0).abs() < 1e-15);
    let found = apply(&mut own, force, approach(-6e-5));
    let normal = frame.split(&found).0;
    let direction = force.map(|f| f / most);
    let gaps = concentration.gaps(at, &gap).unwrap();
    let costs = concentration.costs(&problem, at, &direction, &gaps);
    let remaining = |normal: f64| -6e-5 + 1e-12 * normal + costs.approach(&costs.shape(normal), normal);
    assert!(normal > 0.0 && normal < most);
    // 40 bisections of the largest force.
    assert!(remaining(normal - 2e-12 * most) < 0.0 && remaining(normal + 2e-12 * most) > 0.0);
    let after = frame.split(&apply(&mut own, [0.0; 2], approach(-1.0))).0;
    assert!((after / normal - 1.0).abs() < 1e-12, "{after} {normal}");
}

/// A hat outside the cone shows, whatever its width.
#[test]
fn a_hat_outside_the_cone_shows() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    let shape = concentration.shape(&problem, at, &force, &gaps(&problem)).unwrap();
    let step = free_step(&problem);
    let cone = |force: [f64; 2]| {
        let hats: Vec<_> = concentration.hats(at, &shape, &force).collect();
        assert!(!hats.is_empty());
        let densities = Densities::with_hats(&problem, |_, _| [[0.0; 2]; 2], hats);
        let mut residuals = Residuals::default();
        let steps = SurfaceSteps { before: None, now: &step, next: &step, after: None };
        check(&problem, &steps, &StepDensities { start: densities.clone(), end: densities }, true, &mut residuals);
        residuals.hat_cone
    };
    assert!(cone(force) < 1e-14);
    // Pulling, and with more friction than the cone allows.
    assert!(cone(force.map(|f| -f)) > 0.1 && cone([force[1], force[1]]) > 0.1);
}

/// The residuals of the stress of hats are those of the report.
#[test]
fn the_residuals_of_stars_are_reported() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    concentration.shape(&problem, at, &force, &gaps(&problem)).unwrap();
    let mut residuals = Residuals::default();
    concentration.add_residuals(&mut residuals);
    let made = [residuals.hat_resultants, residuals.hat_stress];
    assert!(made.iter().all(|r| *r > 0.0 && *r < 1e-12), "{made:?}");
}

/// Shares that are negative, lost or counted twice show.
#[test]
fn shares_that_are_none_show() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    let gap = gaps(&problem);
    let shape = concentration.shape(&problem, at, &force, &gap).unwrap();
    let hats: Vec<_> = concentration.hats(at, &shape, &force).collect();
    let residual = |hats: &[NarrowHat<2>]| concentration.share_residual(at, &shape, &force, hats);
    assert!(hats.len() == 2 && residual(&hats) < 1e-15, "{hats:?}");
    let lost = hats[1..].to_vec();
    let twice = [hats.clone(), hats[..1].to_vec()].concat();
    // The sum is right, but one share is above 1 and the other below 0.
    let mut negative = hats.clone();
    (0..2).for_each(|c| negative[0].resultant[c] += 1.5 * force[c]);
    (0..2).for_each(|c| negative[1].resultant[c] -= 1.5 * force[c]);
    let turned = vec![NarrowHat { resultant: [force[1], force[0]], ..hats[0] }, hats[1]];
    for broken in [lost, twice, negative, turned] {
        assert!(residual(&broken) > 0.05, "{} {broken:?}", residual(&broken));
    }
    // The residual of the densities is that of the report.
    let step = free_step(&problem);
    let densities = Densities::with_hats(&problem, |_, _| [[0.0; 2]; 2], hats).with_shares(0.3);
    let mut residuals = Residuals::default();
    let steps = SurfaceSteps { before: None, now: &step, next: &step, after: None };
    check(&problem, &steps, &StepDensities { start: densities.clone(), end: densities }, true, &mut residuals);
    assert_eq!(residuals.hat_shares, 0.3);
}
