//! The law of contact, momentum and energy where surfaces slide.

use super::setup::{Blocks, steel, steps};
use crate::solution::run::{Run, run, swinging_steps};
use percute_core::contact::{Coupling, NonMatchingSurfaces};
use percute_core::dynamics::critical_time_step;
use percute_core::material::Elastic;

/// What contact did in a run.
#[derive(Debug, Default)]
pub(super) struct Seen {
    pub(super) reactions: usize,
    pub(super) slips: usize,
    sticks: usize,
}

/// The displacements of step n + 1 without the reactions of step n.
fn predicted(run: &Run<'_, 2>, n: usize) -> Vec<[f64; 2]> {
    let mut displacement = run.displacement(n + 1).to_vec();
    let h = if n == 0 { 0.5 * run.step(0) } else { 0.5 * (run.step(n - 1) + run.step(n)) };
    let step = run.history.step(n).unwrap();
    for (contact, force) in run.problem.surface().nodes().iter().zip(step.reaction::<2>()) {
        let node = contact.node.index();
        (0..2).for_each(|c| displacement[node][c] -= run.step(n) * h * force[c] / run.problem.mass()[node]);
    }
    displacement
}

/// The weighted value of a multiplier, of a nodal field on the slave less that on the master, along a direction.
fn weighted(
    run: &Run<'_, 2>,
    (non_matching, coupling): (&NonMatchingSurfaces<2>, &Coupling),
    k: usize,
    field: &[[f64; 2]],
    direction: &[f64; 2],
) -> f64 {
    let nodes = run.problem.surface().nodes();
    let along = |at: usize| {
        let value = field[nodes[at].node.index()];
        value[0] * direction[0] + value[1] * direction[1]
    };
    let values = |node| along(non_matching.slave().position(node));
    coupling.difference(k, values, |node| along(non_matching.master().position(node))) / coupling.weight(k)
}

/// Momentum, the law of contact for each multiplier, and the balance of energy with equal steps.
fn check(run: &Run<'_, 2>) -> Seen {
    let seen = check_steps(run);
    check_energy(run);
    seen
}

/// Momentum, and the law of contact for each multiplier.
pub(super) fn check_steps(run: &Run<'_, 2>) -> Seen {
    let start = run.momentum(0);
    let scale = run.problem.mass().iter().sum::<f64>() * fastest(run);
    for n in 0..run.last() {
        let momentum = run.momentum(n);
        // v from differences of u loses some 100 units in the last place.
        assert!((0..2).all(|c| (momentum[c] - start[c]).abs() <= 1e-12 * scale), "step {n}: {momentum:?} {start:?}");
    }
    check_law(run)
}

/// The law of contact for each multiplier, at each step.
pub(super) fn check_law(run: &Run<'_, 2>) -> Seen {
    let mut seen = Seen::default();
    for n in 0..run.last() {
        for non_matching in run.problem.surface().non_matching() {
            check_multipliers(run, n, non_matching, &mut seen);
        }
    }
    seen
}

/// The largest component of a velocity at the start (m/s).
fn fastest(run: &Run<'_, 2>) -> f64 {
    run.problem.initial_velocity().iter().flatten().fold(0.0, |most, v| most.max(v.abs()))
}

/// The law of contact in the step from t_n.
fn check_multipliers(run: &Run<'_, 2>, n: usize, non_matching: &NonMatchingSurfaces<2>, seen: &mut Seen) {
    let surface = run.problem.surface();
    let (step, next) = (run.history.step(n).unwrap(), run.history.step(n + 1).unwrap());
    let coupling = non_matching.coupling(surface, &predicted(run, n));
    let multipliers = non_matching.multipliers(&coupling, step.reaction());
    let velocity = run.half_velocity(n);
    let points = run.problem.mesh().points_in::<2>();
    let places: Vec<[f64; 2]> =
        points.iter().zip(next.displacement::<2>()).map(|(x, u)| [x[0] + u[0], x[1] + u[1]]).collect();
    check_couple(run, (non_matching, &coupling), step.reaction());
    let largest = multipliers.iter().flatten().fold(0.0_f64, |most, force| most.max(force.abs()));
    for k in 0..coupling.len() {
        let (normal, along) = non_matching.frame().split(&multipliers[k]);
        let touches = next.touching[non_matching.slave().position(k)];
        if !coupling.is_active(k) {
            assert!(!touches);
            continue;
        }
        let of = (non_matching, &coupling);
        // Where a multiplier sets in, gaps give way.
        let give = coupling.give(k, |k| non_matching.frame().split(&multipliers[k]).0) / coupling.weight(k);
        let gap = weighted(run, of, k, &places, non_matching.frame().normal()) + give;
        assert!(gap >= -1e-12 * run.problem.mesh().size(), "step {n}, {k}: {gap}");
        // Multipliers come from the forces: rounding of the largest.
        let rounding = 1e-9 * largest;
        assert!(normal >= -rounding && touches == (normal > rounding), "step {n}, {k}: {normal} {touches}");
        let limit = non_matching.law().limit(normal);
        let tangential = along[0] * non_matching.tangent()[0] + along[1] * non_matching.tangent()[1];
        assert!(tangential.abs() <= limit + rounding, "step {n}, {k}");
        if touches {
            seen.reactions += 1;
            assert!(gap.abs() <= 1e-12 * run.problem.mesh().size(), "step {n}, {k}: {gap}");
            let slip = weighted(run, of, k, &velocity, non_matching.tangent());
            // The tangential problem is solved to 1e-13 of the largest multiplier; speeds are differences of u.
            if slip.abs() > 1e-6 * fastest(run) {
                seen.slips += 1;
                assert!((tangential.abs() - limit).abs() <= rounding, "step {n}, {k}: slips inside the cone");
                assert!(tangential * slip <= 0.0);
            } else if tangential.abs() < limit - rounding {
                seen.sticks += 1;
            }
        }
    }
}

/// Normal forces on both sides have no resultant, and no couple at their places ξ in the step.
fn check_couple(
    run: &Run<'_, 2>,
    (non_matching, coupling): (&NonMatchingSurfaces<2>, &Coupling),
    reaction: &[[f64; 2]],
) {
    let (mut force, mut couple, mut scale) = (0.0, 0.0, 0.0);
    for (which, side) in [non_matching.slave(), non_matching.master()].into_iter().enumerate() {
        for (node, xi) in side.xi().iter().enumerate() {
            let xi = if which == 0 { xi + coupling.shifts()[side.part_of(node)] } else { *xi };
            let [x, y] = reaction[side.position(node)];
            let normal = non_matching.frame().normal();
            let press = x * normal[0] + y * normal[1];
            force += press;
            couple += press * xi;
            scale += press.abs();
        }
    }
    // Sums of some thirty products.
    assert!(force.abs() <= 1e-13 * scale, "{force} {scale}");
    assert!(couple.abs() <= 1e-13 * scale * run.problem.mesh().size(), "{couple} {scale}");
}

/// v_{n−½}·M v_{n+½}/2 + ½u·Ku less the work of the recorded forces is constant.
pub(super) fn check_energy(run: &Run<'_, 2>) {
    let (mut work, mut start, mut scale) = (0.0, None, 0.0_f64);
    let nodes = run.contact_nodes();
    for n in 1..run.last() {
        let (before, after) = (run.half_velocity(n - 1), run.half_velocity(n));
        let products = before.iter().zip(&after).zip(run.problem.mass());
        let kinetic: f64 = products.map(|((v, w), m)| 0.5 * m * (v[0] * w[0] + v[1] * w[1])).sum();
        let energy = kinetic + run.strain_energy(n) - work;
        scale = scale.max(kinetic);
        let start = *start.get_or_insert(energy);
        assert!((energy - start).abs() <= 1e-12 * scale, "step {n}: {energy} {start}");
        let (now, next) =
            (run.history.step(n).unwrap().reaction::<2>(), run.history.step(n + 1).unwrap().reaction::<2>());
        for (at, &node) in nodes.iter().enumerate() {
            (0..2).for_each(|c| work += 0.5 * run.step(n) * (now[at][c] + next[at][c]) * after[node][c]);
        }
    }
}

fn checked(blocks: Blocks, end: f64) -> Seen {
    let problem = blocks.problem();
    let run = run(&problem, &steps(&problem, end));
    let seen = check(&run);
    assert!(run.simulation.balance.impulse_drift < 1e-12, "{}", run.simulation.balance.impulse_drift);
    assert!(run.simulation.balance.friction >= 0.0);
    seen
}

#[test]
fn the_law_holds_where_blocks_meet_at_an_angle() {
    for materials in [Blocks::oblique().materials, [Blocks::oblique().materials[0], steel()]] {
        let seen = checked(Blocks { materials, ..Blocks::oblique() }, 14e-6);
        assert!(seen.reactions > 300 && seen.slips > 20 && seen.sticks > 50, "{seen:?}");
    }
}

/// Contact gives no energy to blocks that meet head-on: what it takes is that of the nodes that it stops. The mean of a
/// surface swings a little as it is strained, and D and M with it: 2e-7 of the energy was found, and 4e-6 of what
/// contact takes.
#[test]
fn contact_gives_no_energy_without_sliding() {
    let blocks = Blocks { velocities: [[0.0, -20.0], [0.0, 20.0]], friction: 0.0, ..Blocks::oblique() };
    let problem = blocks.problem();
    let run = run(&problem, &steps(&problem, 30e-6));
    check(&run);
    let mut least = 0.0_f64;
    for balance in &run.simulation.balance_over_time {
        let work = balance.work_of_contact;
        assert!(work <= least + 1e-6 * balance.initial, "{work} {least}");
        least = least.min(work);
    }
    assert!(least < 0.0);
}

#[test]
fn steps_may_vary() {
    let problem = Blocks::oblique().problem();
    let run = run(&problem, &swinging_steps(critical_time_step(&problem), 14e-6, 3.0));
    let seen = check_steps(&run);
    assert!(seen.reactions > 300, "{seen:?}");
}

#[test]
fn a_block_slides_fast() {
    let seen = checked(Blocks { velocities: [[150.0, -20.0], [0.0, 20.0]], ..Blocks::oblique() }, 25e-6);
    assert!(seen.reactions > 300 && seen.slips > 250, "{seen:?}");
}

/// 12 mm aside, at 400 m/s: edges of both are covered more and more.
#[test]
fn a_block_enters_from_beside() {
    let blocks = Blocks { aside: 0.037, velocities: [[-400.0, -20.0], [0.0, 20.0]], ..Blocks::oblique() };
    let seen = checked(blocks, 25e-6);
    assert!(seen.reactions > 100 && seen.slips > 100, "{seen:?}");
    // The other way out: the overlap vanishes.
    let blocks = Blocks { aside: 0.037, velocities: [[400.0, -20.0], [0.0, 20.0]], ..Blocks::oblique() };
    let seen = checked(blocks, 25e-6);
    assert!(seen.reactions > 10, "{seen:?}");
}

/// Corners of the upper block inside edges of the lower one; and a lower one that is narrower.
#[test]
fn one_block_is_narrower() {
    let narrow = Blocks { widths: [0.02, 0.04], aside: 0.0113, cells: [[10, 8], [14, 11]], ..Blocks::oblique() };
    let seen = checked(narrow, 14e-6);
    assert!(seen.reactions > 100, "{seen:?}");
    let seen = checked(Blocks { widths: [0.04, 0.02], aside: -0.0113, ..narrow }, 14e-6);
    assert!(seen.reactions > 100, "{seen:?}");
}

/// The left end of the upper block is on 0.55 of an edge of the lower one.
fn end_inside_an_edge() -> Blocks {
    Blocks { aside: 0.0009, velocities: [[1.0, -20.0], [0.0, 20.0]], friction: 0.9, ..Blocks::oblique() }
}

/// Friction has nothing of what the conditions give way: nodes stick without any slip.
#[test]
fn nodes_stick_where_a_multiplier_sets_in() {
    let problem = end_inside_an_edge().problem();
    let non_matching = &problem.surface().non_matching()[0];
    let coupling = non_matching.coupling_at(&[0.0]);
    assert!((0..coupling.len()).any(|k| coupling.is_active(k) && !coupling.binds(k)));
    let seen = checked(end_inside_an_edge(), 14e-6);
    assert!(seen.reactions > 100 && seen.sticks > 50, "{seen:?}");
}

/// Forces grow in proportion to the thickness, and conditions give way alike.
#[test]
fn the_thickness_does_not_matter() {
    let end = |thickness: f64| {
        let material = Elastic::plane_stress(70e9, 0.3, 2700.0, thickness).unwrap();
        let problem = Blocks { materials: [material; 2], ..end_inside_an_edge() }.problem();
        let run = run(&problem, &steps(&problem, 14e-6));
        run.displacement(run.last()).to_vec()
    };
    for (thin, thick) in end(0.25).iter().flatten().zip(end(1.0).iter().flatten()) {
        // Bodies move by 3e-4 m; a quarter is exact.
        assert!((thin - thick).abs() <= 1e-15, "{thin} {thick}");
    }
}
