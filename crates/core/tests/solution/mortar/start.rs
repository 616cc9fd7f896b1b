//! Bodies that touch at the start.

use super::law::check_steps;
use super::setup::{Blocks, steps};
use crate::solution::run::run;
use percute_core::contact::Interface;
use percute_core::load::{BodyForce, Profile, Table, Traction};
use percute_core::material::Elastic;
use percute_core::mesh::{Mesh, MeshError};
use percute_core::problem::{Builder, Cause, Problem};

/// Blocks that touch and move along together.
fn together() -> Blocks {
    Blocks { gap: 0.0, velocities: [[5.0, 3.0]; 2], ..Blocks::oblique() }
}

/// Body forces that press one onto the other (N/m³).
fn pressed(builder: Builder<2>) -> Problem<2> {
    let force = |group: &str, value: f64| BodyForce { group: Some(group.into()), value: Table::constant([0.0, value]) };
    builder.body_force(force("upper", -1e9)).body_force(force("lower", 1e9)).build().unwrap()
}

/// The law of contact, and the status at t_0: all touch if `all`, else none.
fn check(problem: &Problem<2>, all: bool) {
    assert!(!problem.mesh().touching_elements().is_empty());
    let run = run(problem, &steps(problem, 30e-6));
    let seen = check_steps(&run);
    let touching = |n: usize| run.history.step(n).unwrap().touching.iter().filter(|touches| **touches).count();
    let count = problem.surface().nodes().len();
    assert_eq!(touching(0), if all { count } else { 0 });
    assert!((0..=run.last()).any(|n| touching(n) >= count / 2));
    if !problem.surface().non_matching().is_empty() {
        assert!(seen.reactions > 500, "{seen:?}");
    }
}

#[test]
fn bodies_that_are_pressed_together_touch_at_the_start() {
    let blocks = together();
    check(&pressed(blocks.bodies(blocks.mesh(), |v| v).interface(blocks.interface())), true);
    let matching = Blocks { cells: [[14, 11]; 2], ..blocks };
    let pairs = Interface::matching(2, "upper.bottom", "lower.top", 0.2).unwrap();
    check(&pressed(matching.bodies(matching.mesh(), |v| v).interface(pairs)), true);
}

/// A block slides along a plate: nodes of the plate that it reaches within the first step face nothing at t_0.
#[test]
fn a_node_that_faces_nothing_does_not_touch_at_the_start() {
    let blocks = Blocks {
        cells: [[7, 3], [8, 3]],
        widths: [0.02, 0.04],
        aside: 0.005,
        velocities: [[20.0, 0.0], [0.0; 2]],
        ..together()
    };
    let force = BodyForce { group: Some("upper".into()), value: Table::constant([0.0, -2.65e8]) };
    let builder = blocks.bodies(blocks.mesh(), |v| v).interface(blocks.interface()).body_force(force);
    let problem = builder.build().unwrap();
    let run = run(&problem, &steps(&problem, 2e-6));
    let touching = run.history.step(0).unwrap().touching;
    let starts = problem.starts_of_contact();
    assert!(touching.iter().filter(|touches| **touches).count() > 8);
    for at in (0..touching.len()).filter(|&at| touching[at]) {
        assert!(starts[at].0 <= problem.contact_tolerance(), "{at}: {}", starts[at].0);
    }
}

/// Tractions on the far sides: the wave arrives later.
#[test]
fn tractions_press_bodies_together() {
    let blocks = together();
    let pull = |group: &str, value: f64| Traction {
        group: group.to_string(),
        value: Table::constant([0.0, value]),
        profile: Profile::UNIFORM,
    };
    let builder = blocks.bodies(blocks.mesh(), |v| v).interface(blocks.interface());
    let problem = builder.traction(pull("upper.top", -70e6)).traction(pull("lower.bottom", 70e6)).build().unwrap();
    check(&problem, false);
}

/// Nothing presses them together: no force at all, and no motion but the common one.
#[test]
fn bodies_that_only_touch_do_not_act_on_each_other() {
    let blocks = together();
    let problem = blocks.problem();
    let run = run(&problem, &steps(&problem, 5e-6));
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        // Rounding of the motion may close a gap of zero: forces of rounding.
        let most = step.reaction::<2>().iter().flatten().fold(0.0_f64, |most, force| most.max(force.abs()));
        assert!(most < 1e-3, "step {n}: {most} N");
    }
}

#[test]
fn touching_bodies_need_contact_where_they_touch() {
    let blocks = together();
    let cause = |builder: Builder<2>| builder.build().err().map(|error| error.cause);
    let alone = cause(blocks.bodies(blocks.mesh(), |v| v));
    let Some(Cause::TouchUnstated { elements: [first, second] }) = alone else { panic!("{alone:?}") };
    assert!(first < 2 * 14 * 11 && second >= 2 * 14 * 11);
    let elsewhere = Interface::non_matching(2, "upper.top", "lower.bottom", 0.2).unwrap();
    let other = cause(blocks.bodies(blocks.mesh(), |v| v).interface(elsewhere));
    assert!(matches!(other, Some(Cause::TouchUnstated { .. } | Cause::Overlaps { .. })), "{other:?}");
    // Towards each other: the force would have no bound.
    let strikes = Blocks { velocities: [[0.0, -1.0], [0.0, 1.0]], ..blocks };
    let strikes = cause(strikes.bodies(strikes.mesh(), |v| v).interface(strikes.interface()));
    assert!(matches!(strikes, Some(Cause::StrikesAtStart { .. })), "{strikes:?}");
}

/// The bound is that of rounding, in plane bodies and in bars.
#[test]
fn bodies_must_not_overlap() {
    let joined = |gap: f64| {
        let lower = Mesh::rectangle(1.0, 1.0, 3, 3).unwrap();
        let upper = lower.mapped(|p| [p[0], p[1] + 1.0 + gap]).unwrap();
        Mesh::joined(&[("lower", &lower), ("upper", &upper)])
    };
    for gap in [0.0, 1e-15, -1e-15, 1e-11] {
        let mesh = joined(gap).unwrap();
        assert_eq!(mesh.parts(), 2);
        // Three edges on three: each element meets its own and the neighbours at its two nodes.
        assert!(mesh.touching_elements().len() >= 3);
        assert!(mesh.refined().unwrap().touching_elements().len() > mesh.touching_elements().len());
    }
    assert!(joined(1e-8).unwrap().touching_elements().is_empty());
    for gap in [-1e-10, -0.5, -1.0] {
        let MeshError::PartsTouch { elements } = joined(gap).unwrap_err() else { panic!("another error") };
        assert!(elements[0] < 18 && elements[1] >= 18);
    }
    let bar = Mesh::uniform_bar(1.0, 4).unwrap();
    let beside = |start: f64| Mesh::joined(&[("a", &bar), ("b", &bar.mapped(|p| [p[0] + start]).unwrap())]);
    assert!(beside(0.99).is_err());
    let problem = Problem::<1>::builder(beside(1.0).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 1e-4).unwrap())
        .interface(Interface::matching(1, "a.end", "b.start", 0.0).unwrap());
    problem.build().unwrap();
}
