//! Contact of nodes at two planes.

use crate::solution::run::{Run, aluminium, difference, largest, run};
use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::kernel::InternalForces;
use percute_core::mesh::Mesh;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::rotated;

/// A parallelogram that fits into the corner of a floor and a wall, which open by an angle (degrees). Its gaps are 0.1
/// and 0.3 mm, unless it begins on the floor.
#[derive(Clone, Copy)]
struct Corner {
    opening: f64,
    velocity: [f64; 2],
    friction: [f64; 2],
    on_the_floor: bool,
    /// All is turned by this angle (rad).
    turn: f64,
    wall_first: bool,
}

impl Corner {
    fn of(opening: f64, velocity: [f64; 2], friction: [f64; 2]) -> Self {
        Self { opening, velocity, friction, on_the_floor: false, turn: 0.0, wall_first: false }
    }

    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.turn.sin_cos();
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn problem(&self) -> Problem<2> {
        self.at_distance(3e-4)
    }

    /// With this gap to the wall.
    fn at_distance(&self, distance: f64) -> Problem<2> {
        let (sin, cos) = self.opening.to_radians().sin_cos();
        let mesh = Mesh::rectangle(0.05, 0.04, 10, 8).unwrap();
        // At a right angle cos is 6e-17: the planes are exactly orthogonal only if it is 0.
        let cos = if self.opening == 90.0 { 0.0 } else { cos };
        let mesh = mesh.mapped(|[x, y]| [x + y * cos, y * sin]).unwrap();
        let plane = |normal: [f64; 2], gap: f64, friction: f64, group: &str| {
            let normal = self.turned(normal);
            Obstacle::plane(normal.map(|n| -gap * n), normal, friction, Some(group.to_string())).unwrap()
        };
        let floor = plane([0.0, 1.0], if self.on_the_floor { 0.0 } else { 1e-4 }, self.friction[0], "bottom");
        let wall = plane([sin, -cos], distance, self.friction[1], "left");
        let planes = if self.wall_first { [wall, floor] } else { [floor, wall] };
        let builder = Problem::<2>::builder(rotated(&mesh, self.turn).unwrap())
            .material(aluminium())
            .initial_velocity(Initial::Uniform(self.turned(self.velocity)));
        planes.into_iter().fold(builder, |builder, plane| builder.obstacle(plane)).build().unwrap()
    }
}

fn steps(problem: &Problem<2>, end: f64) -> TimeGrid {
    let count = (end / (0.9 * critical_time_step(problem))).ceil() as usize;
    TimeGrid::uniform(end, count).unwrap()
}

/// The laws at both planes, and the balances of momentum and energy. Returns the steps at which a node is pressed on
/// both.
fn check(run: &Run<'_, 2>, what: &str) -> usize {
    let (problem, surface) = (run.problem, run.problem.surface());
    let (depth, mut both) = (1e-12 * problem.mesh().size(), 0);
    let energy = |n: usize| {
        // ½ v·Mv at t_{n+½} and ½ u_n·K u_{n+1}: reactions alone change their sum.
        let kinetic: f64 =
            run.half_velocity(n).iter().zip(problem.mass()).map(|(v, m)| 0.5 * m * (v[0] * v[0] + v[1] * v[1])).sum();
        let mut force = vec![[0.0; 2]; problem.mesh().node_count()];
        InternalForces::linear(problem)
            .subtract_from_rows(run.displacement(n).as_flattened(), force.as_flattened_mut());
        let next = run.displacement(n + 1).iter().flatten();
        kinetic - 0.5 * force.iter().flatten().zip(next).map(|(f, u)| f * u).sum::<f64>()
    };
    let start = energy(0);
    let (mut work, mut least) = (0.0, 0.0_f64);
    for n in 1..run.last() {
        let (step, next) = (run.history.step(n).unwrap(), run.history.step(n + 1).unwrap());
        let velocity = run.half_velocity(n);
        let mut pressed = vec![0; problem.mesh().node_count()];
        for (at, contact) in surface.nodes().iter().enumerate() {
            let node = contact.node.index();
            let gap = surface.gap(at, &next.displacement()[node]);
            assert!(gap >= -depth, "{what}, step {n}: {gap}");
            let obstacle = &problem.obstacles()[contact.obstacle];
            let (frame, force) = (obstacle.flat_frame(), step.reaction()[at]);
            let (normal, _) = frame.split(&force);
            let before = run.displacement(n - 1)[node];
            work += 0.5 * (0..2).map(|c| force[c] * (next.displacement::<2>()[node][c] - before[c])).sum::<f64>();
            if normal == 0.0 {
                assert_eq!(force, [0.0; 2], "{what}, step {n}");
                continue;
            }
            pressed[node] += 1;
            assert!(normal > 0.0 && gap.abs() <= depth, "{what}, step {n}: {normal} N at {gap} m");
            let excess = obstacle.law().excess(&frame, &force)[0];
            assert!(excess <= 1e-11 * normal, "{what}, step {n}: {excess} N outside the cone");
            let sliding = frame.split(&velocity[node]).1;
            // Speeds below this are rounding of u over a step.
            if sliding[0].hypot(sliding[1]) > 1e-5 && obstacle.law().friction() > 0.0 {
                assert!(excess.abs() <= 1e-9 * normal, "{what}, step {n}: slides inside the cone");
                assert!(force[0] * sliding[0] + force[1] * sliding[1] < 0.0, "{what}, step {n}");
            }
        }
        both += usize::from(pressed.contains(&2));
        let change = energy(n) - start - work;
        assert!(change.abs() <= 1e-12 * start, "{what}, step {n}: energy changes by {change} J of {start}");
        // Contact gives no energy beyond what it took.
        assert!(work <= least + 1e-12 * start, "{what}, step {n}: contact gives {} J", work - least);
        least = least.min(work);
    }
    assert!(run.simulation.balance.impulse_drift < 1e-12, "{what}: {}", run.simulation.balance.impulse_drift);
    both
}

#[test]
fn the_laws_hold_at_both_planes() {
    for opening in [30.0, 60.0, 90.0, 120.0, 150.0] {
        for friction in [[0.0, 0.0], [0.2, 0.2], [0.1, if opening > 30.0 { 0.4 } else { 0.3 }]] {
            // Thrown at both, and sliding along the floor into the wall.
            let (sin, cos) = f64::to_radians(opening).sin_cos();
            let towards = |speed: f64| [-speed * (1.0 + cos), -speed * sin];
            let into = Corner::of(opening, towards(200.0), friction);
            let sliding = Corner { on_the_floor: true, ..Corner::of(opening, [-100.0, 0.0], friction) };
            for (kind, corner) in [("thrown", into), ("sliding", sliding)] {
                let problem = corner.problem();
                let what = format!("{opening}°, {friction:?}, {kind}");
                let both = check(&run(&problem, &steps(&problem, 30e-6)), &what);
                // In an obtuse corner the wall may lift the body from the floor.
                assert!(both > 0 || opening > 90.0, "{what}: no node is at both planes");
            }
        }
    }
}

/// A second plane that is never reached leaves all bits as they are.
#[test]
fn a_far_wall_changes_nothing() {
    for turn in [0.0, 0.3] {
        let corner = Corner { turn, ..Corner::of(90.0, [-30.0, -200.0], [0.2, 0.3]) };
        let far = corner.at_distance(1.0);
        let floor = Problem::<2>::builder(far.mesh().clone())
            .material(aluminium())
            .initial_velocity(Initial::Uniform(corner.turned(corner.velocity)))
            .obstacle(far.obstacles()[0].clone())
            .build()
            .unwrap();
        let times = steps(&far, 25e-6);
        let (with, without) = (run(&far, &times), run(&floor, &times));
        for n in 0..=with.last() {
            let (a, b) = (with.history.step(n).unwrap(), without.history.step(n).unwrap());
            assert_eq!((a.displacement, &a.reaction[..b.reaction.len()]), (b.displacement, b.reaction), "step {n}");
        }
    }
}

/// The order of the planes and a turn of all change rounding only.
#[test]
fn order_and_turning_change_nothing() {
    for (opening, friction) in [(60.0, [0.2, 0.2]), (90.0, [0.4, 0.1]), (120.0, [0.1, 0.4])] {
        let corner = Corner::of(opening, [-150.0, -60.0], friction);
        let (problem, exchanged) = (corner.problem(), Corner { wall_first: true, ..corner }.problem());
        let other = Corner { turn: 0.57, ..corner };
        let turned = other.problem();
        let times = steps(&problem, 25e-6);
        let [first, second, third] = [&problem, &exchanged, &turned].map(|problem| run(problem, &times));
        for n in 0..=first.last() {
            let (u, scale) = (first.displacement(n), largest(first.displacement(first.last())));
            assert!(difference(u, second.displacement(n)) <= 1e-12 * scale, "{opening}°, step {n}");
            let moved: Vec<_> = u.iter().map(|u| other.turned(*u)).collect();
            assert!(difference(&moved, third.displacement(n)) <= 1e-9 * scale, "{opening}°, step {n}");
        }
    }
}
