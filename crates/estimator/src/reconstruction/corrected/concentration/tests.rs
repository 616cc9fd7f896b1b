//! Shapes of the tractions of a block on its corner, and the auxiliary contact force of a node that touches alone.

use super::auxiliary_forces::{AuxiliaryForces, Known};
use super::star::CandidateEdge;
use super::*;
use crate::contact_density::{Densities, nodal_forces};
use crate::reconstruction::corrected::auxiliary::{Approach, Mobility};
use crate::reconstruction::{StepDensities, SurfaceSteps, check};
use crate::time_level::SurfaceStep;
use percute_core::contact::Obstacle;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use std::collections::BTreeMap;

const YOUNG: f64 = 70e9;

/// A block of 2 × 1 m in 8×4 cells, on a plane that is turned by 10° under it.
fn tilted() -> Problem<2> {
    rough(0.2)
}

/// The same with another coefficient of friction.
fn rough(friction: f64) -> Problem<2> {
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    Problem::<2>::builder(Mesh::rectangle(2.0, 1.0, 8, 4).unwrap())
        .material(Elastic::plane_stress(YOUNG, 0.3, 2700.0, 0.5).unwrap())
        .initial_velocity(Initial::Uniform([0.0, -1.0]))
        .obstacle(Obstacle::plane([0.0, -1e-3], [sin, cos], friction, None).unwrap())
        .build()
        .unwrap()
}

fn gaps(problem: &Problem<2>) -> Vec<f64> {
    problem.surface().gaps(&vec![[0.0; 2]; problem.mesh().node_count()])
}

/// The surface at an instant without any force of the simulation.
fn free_step(problem: &Problem<2>) -> SurfaceStep<2> {
    let count = problem.surface().nodes().len();
    SurfaceStep {
        reaction: vec![[0.0; 2]; count],
        force: vec![[0.0; 2]; count],
        densities: None,
        touching: vec![false; count],
        gap: gaps(problem),
    }
}

/// The node nearest to the plane, and a normal force on it with some friction.
fn corner(problem: &Problem<2>) -> (usize, [f64; 2]) {
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
        let shape = concentration.shape(&problem, at, &Faced::WHOLE, [&force; 2], &gaps(&problem), None).unwrap();
        let hats: Vec<_> = concentration.hats(at, &shape, [&force; 2]).collect();
        let values = |f: usize, k: usize| if k == at { concentration.wide(k, f, &shape, &force) } else { [0.0; 2] };
        let densities = Densities::with_hats(&problem, |f, face| face.nodes.map(|k| values(f, k)), hats);
        let (mut sum, mut moment) = ([0.0; 2], 0.0);
        let origin = problem.surface().point(at);
        for (k, f) in nodal_forces(&problem, &densities).iter().enumerate() {
            let arm: [f64; 2] = std::array::from_fn(|c| problem.surface().point(k)[c] - origin[c]);
            (0..2).for_each(|c| sum[c] += f[c]);
            moment += arm[0] * f[1] - arm[1] * f[0];
        }
        let centroid = concentration.centroid(&problem, at, Some(&shape), &[]);
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
    assert!(
        (0..flat.len())
            .all(|at| concentration.shape(&problem, at, &Faced::WHOLE, [&[0.0, 1e6]; 2], &flat, None).is_none())
    );
    assert!(concentration.stresses.iter().all(|stress| stress.get().is_none()));
}

/// A polygon of equal triangles around its centre: the stars of all its corners are copies of one, turned. Rounding of
/// the corners may put some on the other side of a bound of congruence.
#[test]
fn turned_stars_share_their_stress() {
    let corner = |k: usize| {
        let (sin, cos) = (0.3 + 2.0 * std::f64::consts::PI * k as f64 / 24.0).sin_cos();
        [3.0 + cos, 2.0 + sin]
    };
    let points: Vec<_> = std::iter::once([3.0, 2.0]).chain((0..24).map(corner)).collect();
    let cells: Vec<[usize; 3]> =
        (0..24).map(|k| [[k + 1, (k + 1) % 24 + 1, 0], [0, k + 1, (k + 1) % 24 + 1]][k % 2]).collect();
    let problem = Problem::<2>::builder(Mesh::new(points, &cells, &BTreeMap::new(), &BTreeMap::new()).unwrap())
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
            let CandidateEdge { face, end, .. } = edges[edge];
            {
                let resultant = frame.global([1e5, 3e4]);
                NarrowHat { node: at, star: at, face, end, edge, halvings: 3 + edge, resultant, pulled: resultant }
            }
        });
        let stress = concentration.in_element(&problem, &hats, elements[0]).unwrap();
        let products = stress.products();
        // At both ends of the face opposite to the node of the star.
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

/// A node that is on its plane now, and without a force at this gap (m) at the next instant.
fn onto(gap: f64) -> Approach<2> {
    Approach { gap_now: 0.0, gap, along: [[0.0; 2]; 2], mobility: Mobility::of_mass(1e-12), far: [None; 2] }
}

/// The force of a node after a step of `AuxiliaryForces` of τ, from the reaction of the simulation and the motion of
/// the node.
fn auxiliary_force(
    problem: &Problem<2>,
    concentration: &Concentration<2>,
    own: &mut AuxiliaryForces<2>,
    step: ([f64; 2], Approach<2>),
) -> [f64; 2] {
    after(problem, concentration, own, 1.0, step)
}

/// Replaces the first of two fields, with these gaps (m) and a step so long, over τ.
fn replace(
    problem: &Problem<2>,
    concentration: &Concentration<2>,
    own: &mut AuxiliaryForces<2>,
    (gap, steps): (&[f64], f64),
    approach: impl Fn(usize) -> Approach<2>,
    [contact, arresting]: [&mut [[f64; 2]]; 2],
) {
    let unturned = |_: usize, vector: &[f64; 2]| *vector;
    let (steps, strained, unturned) = (&|_| steps, &|_| false, &unturned);
    let mut known = Known { problem, concentration, gap, steps, strained, unturned, contact, arresting };
    own.replace(&mut known, |at| approach(at).gap, |at, _| approach(at));
}

/// The same after a step of another length, over τ.
fn after(
    problem: &Problem<2>,
    concentration: &Concentration<2>,
    own: &mut AuxiliaryForces<2>,
    steps: f64,
    (reaction, approach): ([f64; 2], Approach<2>),
) -> [f64; 2] {
    let (gap, (at, _)) = (gaps(problem), corner(problem));
    let mut contact = vec![[0.0; 2]; gap.len()];
    contact[at] = reaction;
    let mut arresting = contact.clone();
    let away = Approach { gap: 1.0, ..approach };
    let of = |k: usize| if k == at { approach } else { away };
    replace(problem, concentration, own, (&gap, steps), of, [&mut contact, &mut arresting]);
    // The work of the reaction of a node with a force of its own is not measured.
    assert_eq!(arresting[at], [0.0; 2]);
    assert!((0..gap.len()).all(|k| k == at || contact[k] == [0.0; 2]));
    contact[at]
}

/// Under its auxiliary contact force a node comes to its plane, with the compliance of its traction, however large the
/// reaction of the simulation is, and also where there is none. Off the plane it has no force.
#[test]
fn own_forces_close_the_gap() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let ((at, force), gap) = (corner(&problem), gaps(&problem));
    let normal = *problem.obstacles()[0].flat_frame().normal();
    let apply = |own: &mut AuxiliaryForces<2>, reaction: [f64; 2], gap: f64| {
        auxiliary_force(&problem, &concentration, own, (reaction, onto(gap)))
    };
    let mut own = AuxiliaryForces::new(&problem);
    let found = apply(&mut own, force, -6e-5);
    let size = found[0] * normal[0] + found[1] * normal[1];
    let (gaps, largest) = (concentration.gaps(at, &Faced::WHOLE, &gap).unwrap(), 6e7);
    let costs = concentration.costs(&problem, at, &Faced::WHOLE, &normal, &gaps).unwrap();
    let remaining = |size: f64| -6e-5 + 1e-12 * size + costs.approach(&costs.shape(size), normal, size);
    assert!(size > 0.0 && size < 0.1 * largest, "{size}");
    // 40 bisections of the force that stops the node.
    assert!(remaining(size - 2e-12 * largest) < 0.0 && remaining(size + 2e-12 * largest) > 0.0);
    assert_eq!(apply(&mut own.clone(), force, 1e-9), [0.0; 2]);
    for reaction in [[0.0; 2], force.map(|f| 1e-3 * f), force.map(|f| 3.0 * f)] {
        assert_eq!(apply(&mut AuxiliaryForces::new(&problem), reaction, -6e-5), found);
    }
    // Under this reaction the node would not be alone; it keeps its auxiliary contact force.
    let large = force.map(|f| 1e5 * f);
    assert!(
        concentration
            .shape(&problem, at, &Faced::WHOLE, [&large; 2], &gap, None)
            .unwrap()
            .iter()
            .any(|hat| hat.halvings == 0)
    );
    assert_eq!(apply(&mut own.clone(), large, -6e-5), apply(&mut own.clone(), [0.0; 2], -6e-5));
}

/// The traction sticks until Coulomb's limit, from where it first touched, and slides beyond.
#[test]
fn own_forces_stick_and_slide() {
    let problem = rough(1.0);
    let concentration = Concentration::new(&problem);
    let (_, force) = corner(&problem);
    let frame = problem.obstacles()[0].flat_frame();
    let tangent = [-frame.normal()[1], frame.normal()[0]];
    let mut own = AuxiliaryForces::new(&problem);
    let mut apply = |slides: f64| {
        let along = [[0.0; 2], tangent.map(|t| slides * t)];
        let found = auxiliary_force(&problem, &concentration, &mut own, (force, Approach { along, ..onto(-6e-5) }));
        (found[0] * tangent[0] + found[1] * tangent[1]) / frame.split(&found).0
    };
    let held = apply(0.0);
    assert!(held.abs() < 0.99, "{held}");
    assert!(apply(1e-6) < held);
    assert!((apply(1e-3) + 1.0).abs() < 1e-12);
    // It has slid: on the way back it is pulled from the other side before it is where it was.
    assert!((apply(0.0) - 1.0).abs() < 1e-12);
}

/// A node that is released begins a new contact: neither where the last one stuck nor how deep it was is known.
#[test]
fn a_released_node_begins_anew() {
    let problem = rough(1.0);
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    let frame = problem.obstacles()[0].flat_frame();
    let slid = [[0.0; 2], [-frame.normal()[1], frame.normal()[0]].map(|t| 1e-3 * t)];
    let apply = |own: &mut AuxiliaryForces<2>, along| {
        auxiliary_force(&problem, &concentration, own, (force, Approach { along, ..onto(-6e-5) }))
    };
    let mut own = AuxiliaryForces::new(&problem);
    apply(&mut own, slid);
    let mut released = own.clone();
    released.release(at);
    let fresh = apply(&mut AuxiliaryForces::new(&problem), [[0.0; 2]; 2]);
    assert_eq!(apply(&mut released, [[0.0; 2]; 2]), fresh);
    assert_ne!(apply(&mut own, [[0.0; 2]; 2]), fresh);
}

/// A node that is behind its plane when it begins to touch alone does not come to it within a short step: in each step,
/// the depth falls by the square of the step over τ.
#[test]
fn a_depth_is_not_taken_back_at_once() {
    // With friction, the shape is that of the direction of the step before.
    let problem = rough(0.0);
    let concentration = Concentration::new(&problem);
    let (_, force) = corner(&problem);
    let (depth, gap, steps) = (5e-5, -6e-5, 0.1);
    let behind = Approach { gap_now: -depth, ..onto(gap) };
    let on_its_plane =
        |gap: f64| auxiliary_force(&problem, &concentration, &mut AuxiliaryForces::new(&problem), (force, onto(gap)));
    let mut own = AuxiliaryForces::new(&problem);
    for n in 1..4 {
        let found = after(&problem, &concentration, &mut own, steps, (force, behind));
        let expected = on_its_plane(gap + depth * (1.0 - steps * steps).powi(n));
        // Bisections to 1e-12 of a force that is 50 times as large.
        let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9 * b.abs();
        assert!(found.iter().zip(&expected).all(close), "{n}: {found:?} {expected:?}");
    }
    for long in [1.0, 3.0] {
        let found = after(&problem, &concentration, &mut AuxiliaryForces::new(&problem), long, (force, behind));
        assert_eq!(found, on_its_plane(gap));
    }
}

/// Where an edge lies on the plane, the force of the simulation remains.
#[test]
fn a_flat_zone_has_no_own_force() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    let mut gap = gaps(&problem);
    gap[concentration.nodes[at].edges[0].far] = gap[at];
    let mut contact = vec![[0.0; 2]; gap.len()];
    contact[at] = force;
    let mut arresting = contact.clone();
    let of = |k: usize| onto(if k == at { -6e-5 } else { 1.0 });
    replace(
        &problem,
        &concentration,
        &mut AuxiliaryForces::new(&problem),
        (&gap, 1.0),
        of,
        [&mut contact, &mut arresting],
    );
    assert_eq!([contact[at], arresting[at]], [force; 2]);
}

/// A hat outside the cone shows, whatever its width.
#[test]
fn a_hat_outside_the_cone_shows() {
    let problem = tilted();
    let concentration = Concentration::new(&problem);
    let (at, force) = corner(&problem);
    let shape = concentration.shape(&problem, at, &Faced::WHOLE, [&force; 2], &gaps(&problem), None).unwrap();
    let step = free_step(&problem);
    let cone = |force: [f64; 2]| {
        let hats: Vec<_> = concentration.hats(at, &shape, [&force; 2]).collect();
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
    concentration.shape(&problem, at, &Faced::WHOLE, [&force; 2], &gaps(&problem), None).unwrap();
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
    let shape = concentration.shape(&problem, at, &Faced::WHOLE, [&force; 2], &gap, None).unwrap();
    let hats: Vec<_> = concentration.hats(at, &shape, [&force; 2]).collect();
    let residual = |hats: &[NarrowHat<2>]| concentration.share_residual(at, &shape, &force, hats);
    assert!(hats.len() == 2 && residual(&hats) < 1e-15, "{hats:?}");
    let lost = hats[1..].to_vec();
    let twice = [hats.clone(), hats[..1].to_vec()].concat();
    // The sum is right, but one share is above 1 and the other below 0.
    let mut negative = hats.clone();
    (0..2).for_each(|c| negative[0].resultant[c] += 1.5 * force[c]);
    (0..2).for_each(|c| negative[1].resultant[c] -= 1.5 * force[c]);
    let turned = vec![NarrowHat { resultant: [force[1], force[0]], pulled: [force[1], force[0]], ..hats[0] }, hats[1]];
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
