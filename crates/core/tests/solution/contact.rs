//! The contact law at every step (eq. \[2\]): no penetration, Coulomb's cone, complementarity.

use crate::solution::run::{Run, aluminium, gravity, run, swinging_steps};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::history::History;
use percute_core::load::{Support, Table};
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{disc, random_rectangle, rotated};

/// Speeds below this (m/s) are rounding: u differences of 1e-16 · 1e-2 m over steps of 1e-7 s are
/// 1e-11 m/s.
const STILL: f64 = 1e-9;

/// Distance from the plane at the start (m): more than a step at the speeds used here, at most
/// 200 m/s · 1 µs, as a start nearer than a quarter of that is refused.
const GAP: f64 = 2.7e-4;

fn thrown(mesh: Mesh, velocity: [f64; 2], friction: f64, group: Option<&str>) -> Problem<2> {
    let lowest = mesh.points_in::<2>().iter().fold(f64::INFINITY, |m, p| m.min(p[1]));
    let plane = Obstacle::plane([0.0, lowest - GAP], [0.0, 1.0], friction, group.map(String::from)).unwrap();
    Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform(velocity))
        .obstacle(plane)
        .build()
        .unwrap()
}

fn steps(problem: &Problem<2>, count: usize) -> TimeGrid {
    TimeGrid::uniform(0.9 * critical_time_step(problem) * count as f64, count).unwrap()
}

/// About as many steps that change all the time: h_n and Δt_n differ.
fn swinging(problem: &Problem<2>, count: usize) -> TimeGrid {
    let critical = critical_time_step(problem);
    swinging_steps(critical, 0.7 * critical * count as f64, 6.0)
}

/// Checks the law on every node and step and returns the number of reactions.
fn check_law(run: &Run<'_, 2>, what: &str) -> usize {
    let problem = run.problem;
    let plane = &problem.obstacles()[0];
    // The tolerance of the method, and rounding of a gap made of coordinates of the body's size.
    let depth = problem.contact_tolerance() + 1e-15 * problem.mesh().size();
    let mut reactions = 0;
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        let next = run.history.step((n + 1).min(run.last())).unwrap();
        for (at, node) in run.contact_nodes().into_iter().enumerate() {
            let at_place = format!("{what}, step {n}, node {node}");
            let gap = problem.surface().gap(at, &step.displacement()[node]);
            assert!(gap >= -depth, "{at_place}: {gap} m behind the plane");
            let (normal, tangential) = plane.flat_frame().split(&step.reaction()[at]);
            let friction = tangential[0].hypot(tangential[1]);
            assert!(normal >= 0.0, "{at_place}: the plane pulls with {normal} N");
            // Rounding of the projection.
            assert!(
                friction <= plane.law().friction() * normal + 1e-12 * normal,
                "{at_place}: {friction} N of friction"
            );
            if n == run.last() {
                continue;
            }
            let lands = problem.surface().gap(at, &next.displacement()[node]);
            assert_eq!(next.touching[at], normal > 0.0, "{at_place}: touching at {lands} m with {normal} N");
            if normal > 0.0 {
                reactions += 1;
                assert!(lands.abs() <= depth, "{at_place}: a force of {normal} N at a gap of {lands} m");
            }
        }
    }
    reactions
}

#[test]
fn the_law_holds_at_every_step() {
    for friction in [0.0, 0.2, 0.7, 1e3] {
        let block = |angle: f64| rotated(&random_rectangle(0.05, 0.04, 8, 3).unwrap(), angle).unwrap();
        for (what, mesh) in [("flat", block(0.0)), ("tilted", block(0.05)), ("disc", disc(0.02, 0.003).unwrap())] {
            let problem = thrown(mesh, [200.0, -200.0], friction, None);
            for (kind, times) in [("equal", steps(&problem, 400)), ("swinging", swinging(&problem, 400))] {
                let reactions =
                    check_law(&run(&problem, &times), &format!("{what}, friction {friction}, {kind} steps"));
                assert!(reactions > 40, "{what}, friction {friction}, {kind} steps: only {reactions} reactions");
            }
        }
    }
}

/// The same between two planes at a right angle, the body thrown into the corner.
#[test]
fn two_planes_share_the_nodes_by_groups() {
    let mesh = random_rectangle(0.05, 0.04, 6, 5).unwrap();
    let (points, cells): (Vec<_>, Vec<_>) =
        (mesh.points_in::<2>().to_vec(), mesh.nodes_of::<3>().iter().map(|c| c.map(|n| n.index())).collect());
    // The corner node belongs to the bottom only.
    let side = |group: &str, keep: &dyn Fn(&[f64; 2]) -> bool| {
        let faces = mesh.face_groups()[group].iter().map(|f| mesh.face_nodes::<2>(*f).map(|n| n.index()));
        faces.filter(|nodes| nodes.iter().all(|&n| keep(&points[n]))).collect::<Vec<_>>()
    };
    let groups =
        [("floor".to_string(), side("bottom", &|_| true)), ("wall".to_string(), side("left", &|p| p[1] > 0.0))];
    let mesh = Mesh::new(points.clone(), &cells, &groups.into(), &Default::default()).unwrap();
    let plane = |point, normal, group: &str| Obstacle::plane(point, normal, 0.1, Some(group.to_string())).unwrap();
    let problem = Problem::<2>::builder(mesh)
        .material(aluminium())
        .initial_velocity(Initial::Uniform([-100.0, -100.0]))
        .obstacle(plane([0.0, -GAP], [0.0, 1.0], "floor"))
        .obstacle(plane([-1.6 * GAP, 0.0], [1.0, 0.0], "wall"))
        .build()
        .unwrap();
    let run = run(&problem, &steps(&problem, 400));
    let depth = 2.0 * problem.contact_tolerance();
    let mut impulse = [0.0; 2];
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            let gap = problem.surface().gap(at, &step.displacement()[contact.node.index()]);
            assert!(gap >= -depth, "step {n}, node {}: {gap}", contact.node);
            impulse[contact.obstacle] +=
                problem.obstacles()[contact.obstacle].flat_frame().split(&step.reaction()[at]).0;
        }
    }
    assert!(impulse[0] > 0.0 && impulse[1] > 0.0, "{impulse:?}");
    // Thrown into the corner, it leaves it on both axes.
    let momentum = run.momentum(run.last() - 1);
    assert!(momentum[0] > 0.0 && momentum[1] > 0.0, "{momentum:?}");
}

/// Fast along the plane and slow into it: every node that touches slides all the time, so that the
/// tangential impulse is −μ times the normal one, at each node and in all.
#[test]
fn a_sliding_block_loses_mu_times_the_normal_impulse() {
    let friction = 0.3;
    let problem = thrown(random_rectangle(0.05, 0.04, 8, 6).unwrap(), [500.0, -10.0], friction, Some("bottom"));
    let run = run(&problem, &steps(&problem, 200));
    let mut impulse = [0.0; 2];
    for n in 0..run.last() {
        let velocity = run.half_velocity(n);
        for (reaction, node) in run.history.step(n).unwrap().reaction::<2>().iter().zip(run.contact_nodes()) {
            assert!(velocity[node][0] > 0.0, "node {node} stopped at step {n}: the test does not test");
            assert!((reaction[0] + friction * reaction[1]).abs() <= 1e-13 * reaction[1], "step {n}: {reaction:?}");
            (0..2).for_each(|c| impulse[c] += reaction[c] * run.step(n) * if n == 0 { 0.5 } else { 1.0 });
        }
    }
    let mass: f64 = problem.mass().iter().sum();
    let momentum = run.momentum(run.last() - 1);
    assert!(impulse[1] > 10.0 * mass, "no rebound: {impulse:?}");
    // Momentum from differences of u: 1e-16 u/(vΔt) of it, over 80 nodes.
    assert!((momentum[0] - 500.0 * mass + friction * impulse[1]).abs() < 1e-10 * 500.0 * mass);
}

/// With more friction than any force can overcome a node that touches does not move along the plane.
#[test]
fn sticking_nodes_do_not_move() {
    let problem = thrown(random_rectangle(0.05, 0.04, 8, 7).unwrap(), [100.0, -200.0], 1e6, Some("bottom"));
    for times in [steps(&problem, 200), swinging(&problem, 200)] {
        let run = run(&problem, &times);
        let mut stuck = 0;
        for n in 0..run.last() {
            let velocity = run.half_velocity(n);
            for (reaction, node) in run.history.step(n).unwrap().reaction::<2>().iter().zip(run.contact_nodes()) {
                if reaction[1] > 0.0 {
                    stuck += 1;
                    assert!(velocity[node][0].abs() < STILL, "step {n}, node {node}: {} m/s", velocity[node][0]);
                    assert!(reaction[0].abs() < 1e6 * reaction[1], "step {n}, node {node} slides: {reaction:?}");
                }
            }
        }
        assert!(stuck > 100, "only {stuck} reactions");
    }
}

/// Without friction the plane gives no tangential force, so that the momentum along it stays.
#[test]
fn without_friction_the_tangential_momentum_stays() {
    let problem =
        thrown(rotated(&random_rectangle(0.05, 0.04, 8, 8).unwrap(), 0.1).unwrap(), [120.0, -200.0], 0.0, None);
    let run = run(&problem, &steps(&problem, 300));
    let mass: f64 = problem.mass().iter().sum();
    for n in 0..run.last() {
        assert!(run.history.step(n).unwrap().reaction::<2>().iter().all(|r| r[0] == 0.0), "step {n}");
        // Rounding of differences of u, over 80 nodes.
        assert!((run.momentum(n)[0] - 120.0 * mass).abs() < 1e-10 * 120.0 * mass, "step {n}");
    }
    assert!(run.momentum(run.last() - 1)[1] > 0.0, "no rebound");
}

/// A uniform tangential velocity changes nothing but the place, without friction (Galileo).
#[test]
fn without_friction_a_tangential_velocity_only_carries_the_body_along() {
    let mesh = || rotated(&random_rectangle(0.05, 0.04, 6, 9).unwrap(), 0.2).unwrap();
    let (still, moving) = (thrown(mesh(), [0.0, -200.0], 0.0, None), thrown(mesh(), [300.0, -200.0], 0.0, None));
    let times = steps(&still, 200);
    let (still, moving) = (run(&still, &times), run(&moving, &times));
    for n in 0..=still.last() {
        for (u, v) in still.displacement(n).iter().zip(moving.displacement(n)) {
            let carried = [u[0] + 300.0 * still.time(n), u[1]];
            // Rounding, which the vibrations carry on, of displacements of up to 2e-2 m.
            assert!((carried[0] - v[0]).abs().max((carried[1] - v[1]).abs()) < 1e-9 * 2e-2, "step {n}");
        }
    }
}

/// A body that rests on the plane with a pull into it touches from t₀ on; without it, not.
#[test]
fn a_body_at_rest_on_the_plane_touches_from_the_start() {
    for (pull, touches) in [(-1e4, true), (0.0, false), (1e4, false)] {
        let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 5, 2).unwrap())
            .material(aluminium())
            .obstacle(Obstacle::plane([0.0, 0.0], [0.0, 1.0], 0.2, Some("bottom".to_string())).unwrap())
            .body_force(gravity(2700.0, [0.0, pull]))
            .build()
            .unwrap();
        let run = run(&problem, &steps(&problem, 20));
        let first = run.history.step(0).unwrap();
        assert!(first.touching.iter().all(|t| *t == touches), "pull {pull}: {:?}", first.touching);
        assert!(first.reaction::<2>().iter().all(|r| (r[1] > 0.0) == touches), "pull {pull}: {:?}", first.reaction);
    }
}

/// A block that rests on a slope and already slides down it starts like one on a level plane: that
/// n·v is 1e-15 instead of 0 must not count as a blow, nor as a flight.
#[test]
fn a_block_may_start_sliding_on_a_slope() {
    let mut wrong = Vec::new();
    for angle in [0.0_f64, 0.3, 0.7, -1.1, 2.0, 2.9] {
        let (sin, cos) = angle.sin_cos();
        let problem = Problem::<2>::builder(rotated(&random_rectangle(0.05, 0.04, 5, 2).unwrap(), angle).unwrap())
            .material(aluminium())
            .initial_velocity(Initial::Uniform([30.0 * cos, 30.0 * sin]))
            .obstacle(Obstacle::plane([0.0, 0.0], [-sin, cos], 0.2, Some("bottom".to_string())).unwrap())
            .body_force(gravity(2700.0, [1e4 * sin, -1e4 * cos]))
            .build();
        let problem = match problem {
            Ok(problem) => problem,
            Err(error) => {
                wrong.push(format!("angle {angle}: {error}"));
                continue;
            }
        };
        let times = steps(&problem, 20);
        let mut history = History::new(&times);
        match simulate(&problem, &times, &mut history, &mut Unobserved) {
            Err(error) => wrong.push(format!("angle {angle}: {error}")),
            Ok(_) if !history.step(0).unwrap().touching.iter().all(|t| *t) => {
                wrong.push(format!("angle {angle}: touching {:?}", history.step(0).unwrap().touching));
            }
            Ok(_) => {}
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A node whose normal motion is prescribed is no candidate (supports come first): it gets no
/// reaction, whatever its gap, and its neighbours do.
#[test]
fn held_nodes_get_no_reaction() {
    let problem = Problem::<2>::builder(random_rectangle(0.05, 0.04, 6, 4).unwrap())
        .material(aluminium())
        .initial_velocity(Initial::Uniform([0.0, -100.0]))
        .support(Support {
            group: "left".to_string(),
            components: [false, true, false],
            velocity: Some(Table::constant([0.0, -100.0])),
        })
        .obstacle(Obstacle::plane([0.0, -GAP], [0.0, 1.0], 0.3, Some("bottom".to_string())).unwrap())
        .build()
        .unwrap();
    let run = run(&problem, &steps(&problem, 60));
    let held =
        problem.surface().nodes().iter().position(|c| problem.mesh().points_in::<2>()[c.node.index()] == [0.0, 0.0]);
    let held = held.unwrap();
    let mut reactions = 0;
    for n in 0..=run.last() {
        let step = run.history.step(n).unwrap();
        assert_eq!((step.reaction()[held], step.touching[held]), ([0.0; 2], false), "step {n}");
        reactions += step.reaction::<2>().iter().filter(|r| r[1] > 0.0).count();
    }
    assert!(reactions > 20, "only {reactions} reactions");
}
