//! Contact of two bodies whose nodes face each other in pairs.

use crate::solution::run::{Run, aluminium, difference, largest, run};
use percute_core::contact::{Interface, Obstacle};
use percute_core::dynamics::critical_time_step;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::problem::{Cause, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{translated, upside_down};

const GAP: f64 = 50e-6;

/// A block of 40 × 25 mm on y ≥ 0.
fn block() -> Mesh {
    Mesh::rectangle(0.04, 0.025, 8, 6).unwrap()
}

/// The block above its mirror image, 2 GAP apart, with one velocity (m/s) for each.
fn blocks(velocities: [[f64; 2]; 2], friction: f64, materials: [Elastic; 2]) -> Problem<2> {
    let upper = translated(&block(), [0.0, GAP]).unwrap();
    let lower = translated(&upside_down(&block()).unwrap(), [0.0, -GAP]).unwrap();
    let mesh = Mesh::joined(&[("upper", &upper), ("lower", &lower)]).unwrap();
    let half = upper.node_count();
    let velocity = (0..mesh.node_count()).map(|i| velocities[usize::from(i >= half)]).collect();
    Problem::<2>::builder(mesh)
        .material_of("upper", materials[0])
        .material_of("lower", materials[1])
        .initial_velocity(Initial::Nodal(velocity))
        .interface(Interface::matching(2, "upper.bottom", "lower.bottom", friction).unwrap())
        .build()
        .unwrap()
}

fn steel() -> Elastic {
    Elastic::plane_stress(210e9, 0.3, 7800.0, 1.0).unwrap()
}

fn steps(problem: &Problem<2>, fraction: f64, end: f64) -> TimeGrid {
    let count = (end / (fraction * critical_time_step(problem))).ceil() as usize;
    TimeGrid::uniform(end, count).unwrap()
}

/// Two equal blocks that meet head-on are two blocks on a rigid plane between them.
#[test]
fn the_plane_of_symmetry_is_rigid() {
    let both = blocks([[3.0, -20.0], [3.0, 20.0]], 0.2, [aluminium(); 2]);
    let one = Problem::<2>::builder(translated(&block(), [0.0, GAP]).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([3.0, -20.0]))
        .obstacle(Obstacle::plane([0.0, 0.0], [0.0, 1.0], 0.0, None).unwrap())
        .build()
        .unwrap();
    let times = steps(&both, 0.9, 20e-6);
    let (pair, single) = (run(&both, &times), run(&one, &times));
    let half = one.mesh().node_count();
    for n in 0..=pair.last() {
        let (u, expected) = (pair.displacement(n), single.displacement(n));
        let image: Vec<[f64; 2]> = u[half..].iter().map(|u| [u[0], -u[1]]).collect();
        let rounding = 1e-12 * largest(expected);
        // The same side by side, so without friction: the two move along together.
        assert!(difference(&u[..half], expected) <= rounding, "step {n}");
        assert!(difference(&image, expected) <= rounding, "step {n}");
    }
    let touched = (0..=pair.last()).filter(|&n| pair.history.step(n).unwrap().touching.contains(&true)).count();
    assert!(touched >= 20, "{touched}");
}

/// Momentum of both bodies together and, with friction, what the law says of each pair; contact gives no energy.
fn check(run: &Run<'_, 2>) {
    let surface = run.problem.surface();
    let start = run.momentum(0);
    let scale: f64 = run.problem.mass().iter().sum::<f64>() * 30.0;
    let (mut reactions, mut slips) = (0, 0);
    for n in 0..run.last() {
        let momentum = run.momentum(n);
        assert!((0..2).all(|c| (momentum[c] - start[c]).abs() <= 1e-12 * scale), "step {n}: {momentum:?} {start:?}");
        let (step, next) = (run.history.step(n).unwrap(), run.history.step(n + 1).unwrap());
        let velocity = run.half_velocity(n);
        for at in (0..surface.nodes().len()).filter(|&at| surface.leads(at)) {
            let partner = surface.nodes()[at].partner.unwrap();
            let force = step.reaction()[at];
            assert_eq!(force.map(|f| -f), step.reaction()[partner], "step {n}");
            let gap = surface.gap(at, &surface.against_obstacle(at, next.displacement()));
            assert!(gap >= -1e-12 * run.problem.mesh().size(), "step {n}: {gap}");
            let obstacle = &run.problem.obstacles()[surface.nodes()[at].obstacle];
            let frame = obstacle.flat_frame();
            let (normal, _) = frame.split(&force);
            assert!(normal >= 0.0);
            if normal > 0.0 {
                reactions += 1;
                assert!(gap.abs() <= 1e-12 * run.problem.mesh().size(), "step {n}: {gap}");
                let sliding = frame.split(&surface.against_obstacle(at, &velocity)).1;
                let excess = obstacle.law().excess(&frame, &force)[0];
                assert!(excess <= 1e-9 * normal);
                // Speeds below this are rounding of u over a step.
                if sliding[0].hypot(sliding[1]) > 1e-6 {
                    slips += 1;
                    assert!(excess.abs() <= 1e-9 * normal, "step {n}: slides inside the cone");
                    assert!(force[0] * sliding[0] + force[1] * sliding[1] < 0.0);
                }
            }
        }
    }
    assert!(reactions > 100 && slips > 10, "{reactions} {slips}");
}

#[test]
fn the_law_holds_between_bodies() {
    for materials in [[aluminium(); 2], [aluminium(), steel()]] {
        let problem = blocks([[8.0, -20.0], [-2.0, 10.0]], 0.2, materials);
        let run = run(&problem, &steps(&problem, 0.9, 25e-6));
        check(&run);
        let balance = run.simulation.balance;
        assert!(balance.impulse_drift < 1e-12, "{}", balance.impulse_drift);
        // The Δt²/8 term.
        assert!(balance.energy_drift < 0.05 && balance.friction > 0.0, "{balance:?}");
        let contact = run.problem.surface();
        assert_eq!(contact.obstacles().len(), 2);
    }
}

/// A common velocity changes nothing but the rigid motion.
#[test]
fn a_common_velocity_changes_nothing() {
    let slow = blocks([[8.0, -20.0], [-2.0, 10.0]], 0.2, [aluminium(); 2]);
    let fast = blocks([[108.0, 30.0], [98.0, 60.0]], 0.2, [aluminium(); 2]);
    let times = steps(&slow, 0.9, 15e-6);
    let (slow, fast) = (run(&slow, &times), run(&fast, &times));
    for n in 0..=slow.last() {
        let way = [100.0, 50.0].map(|v| v * slow.time(n));
        let back: Vec<[f64; 2]> = fast.displacement(n).iter().map(|u| [u[0] - way[0], u[1] - way[1]]).collect();
        assert!(difference(slow.displacement(n), &back) < 1e-12 * largest(fast.displacement(n)).max(1e-3), "step {n}");
    }
}

/// Two equal bars exchange their velocities after 2L/c, with order 1 in the step but for the oscillations of the mesh,
/// which do not change the mean velocity.
#[test]
fn equal_bars_exchange_their_velocities() {
    for count in [20, 80] {
        let bar = |start: f64| Mesh::uniform_bar(0.3, count).unwrap().mapped(|p| [p[0] + start]).unwrap();
        let (left, right) = (bar(-0.3), bar(1e-4));
        let mesh = Mesh::joined(&[("left", &left), ("right", &right)]).unwrap();
        let velocity = (0..mesh.node_count()).map(|i| [if i <= count { 10.0 } else { 0.0 }]).collect();
        let problem = Problem::<1>::builder(mesh)
            .material(Elastic::bar(70e9, 2700.0, 1e-4).unwrap())
            .initial_velocity(Initial::Nodal(velocity))
            .interface(Interface::matching(1, "left.end", "right.start", 0.0).unwrap())
            .build()
            .unwrap();
        let wave = (70e9_f64 / 2700.0).sqrt();
        let end = 1e-5 + 4.0 * 0.3 / wave;
        let times = TimeGrid::with_step(end, 0.5 * critical_time_step(&problem)).unwrap();
        let run = run(&problem, &times);
        let velocity = run.half_velocity(run.last() - 1);
        let mean = |nodes: std::ops::RangeInclusive<usize>| {
            let mass: f64 = nodes.clone().map(|i| problem.mass()[i]).sum();
            nodes.map(|i| problem.mass()[i] * velocity[i][0]).sum::<f64>() / mass
        };
        let (left, right) = (mean(0..=count), mean(count + 1..=2 * count + 1));
        // The front loses some elements' worth of momentum to oscillations: first order in the mesh.
        let bound = 10.0 * 2.0 / count as f64;
        assert!(left.abs() < bound && (right - 10.0).abs() < bound, "{count}: {left} {right}");
        assert!((left + right - 10.0).abs() < 1e-11, "{left} {right}");
    }
}

#[test]
fn wrong_interfaces_are_refused() {
    let refusal = |first: &str, second: &str, shift: [f64; 2], nx: usize| {
        let lower = upside_down(&Mesh::rectangle(0.04, 0.025, nx, 6).unwrap()).unwrap();
        let lower = translated(&lower, [shift[0], -GAP + shift[1]]).unwrap();
        let mesh = Mesh::joined(&[("upper", &block()), ("lower", &lower)]).unwrap();
        let problem = Problem::<2>::builder(mesh)
            .material(aluminium())
            .interface(Interface::matching(2, first, second, 0.2).unwrap())
            .build();
        problem.err().map(|error| error.cause)
    };
    assert_eq!(refusal("upper.bottom", "lower.bottom", [0.0, 0.0], 8), None);
    let aside = refusal("upper.bottom", "lower.bottom", [1e-4, 0.0], 8);
    assert!(matches!(aside, Some(Cause::NotMatching { .. })), "{aside:?}");
    let other = refusal("upper.bottom", "lower.bottom", [0.0, 0.0], 9);
    assert!(matches!(other, Some(Cause::NotMatching { counts: [9, 10], .. })), "{other:?}");
    let itself = refusal("upper.bottom", "upper.top", [0.0, 0.0], 8);
    assert!(matches!(itself, Some(Cause::SameBody { .. })), "{itself:?}");
    let away = refusal("upper.bottom", "lower.top", [0.0, 0.0], 8);
    assert!(matches!(away, Some(Cause::TurnedAway { .. })), "{away:?}");
    let unknown = refusal("upper.bottom", "anvil.top", [0.0, 0.0], 8);
    assert!(matches!(unknown, Some(Cause::UnknownGroup { .. })), "{unknown:?}");
}
