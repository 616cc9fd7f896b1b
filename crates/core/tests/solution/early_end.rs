//! Runs that end early: unstable, too near to the plane at the start, interrupted, refused by the sink.

use crate::solution::run::{aluminium, run};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{SimulationError, critical_time_step, simulate};
use percute_core::history::{Discard, History, SinkError, State, StateSink};
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::{Progress, Unobserved};
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;
use percute_testkit::{Random, random_rectangle};
use std::ops::ControlFlow;

/// A free block with velocities at random, so that every mode has its share.
fn shaken_block() -> Problem<2> {
    let mesh = random_rectangle(0.05, 0.04, 6, 8).unwrap();
    let mut random = Random::new(1);
    let velocity = (0..mesh.node_count()).map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)]).collect();
    Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Nodal(velocity)).build().unwrap()
}

/// Above the critical step the run ends with an error that names a node, and no step that was
/// handed on holds a NaN; just below it the run goes through.
#[test]
fn runs_above_the_critical_step_are_unstable() {
    let problem = shaken_block();
    let critical = critical_time_step(&problem);
    run(&problem, &TimeGrid::uniform(2000.0 * 0.999 * critical, 2000).unwrap());
    for factor in [1.01, 1.1, 2.0, 1e3, 1e8, 1e60, 1e120] {
        let times = TimeGrid::uniform(2000.0 * factor * critical, 2000).unwrap();
        let mut history = History::new(&times);
        let error = simulate(&problem, &times, &mut history, &mut Unobserved).unwrap_err();
        let SimulationError::Unstable { step, time, node, speed, longest_step, critical_step, by_contact } = error
        else {
            panic!("factor {factor}: {error}");
        };
        assert_eq!((history.len(), time), (step, times.instants()[step]), "factor {factor}");
        assert!(step >= 1 && node < problem.mesh().node_count() && !by_contact);
        assert!(speed > 1.0 && !speed.is_nan(), "factor {factor}: speed {speed}");
        assert_eq!((longest_step, critical_step), (times.longest_step(), critical));
        let finite = |n: usize| history.step(n).unwrap().displacement.iter().all(|u| u.is_finite());
        assert!((0..history.len()).all(finite), "factor {factor}");
    }
}

fn near_bar(gap: f64) -> Problem<1> {
    Problem::<1>::builder(Mesh::uniform_bar(0.1, 10).unwrap())
        .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
        .initial_velocity(Initial::Uniform([-400.0]))
        .obstacle(Obstacle::plane([-gap], [1.0], 0.0, None).unwrap())
        .build()
        .unwrap()
}

/// A node that touches at step 1 needs a gap of |v|Δt/4; both ways out that the error names lead out.
#[test]
fn a_start_too_near_names_what_will_do() {
    let grid = |step: f64| TimeGrid::uniform(10.0 * step, 10).unwrap();
    let dt = 1e-6;
    let simulate_at = |gap: f64, step: f64| simulate(&near_bar(gap), &grid(step), &mut Discard, &mut Unobserved);
    let error = simulate_at(0.6e-4, dt).unwrap_err();
    let said = error.to_string();
    let SimulationError::StartsTooNear { node, gap, speed, step, smallest_gap, largest_step, .. } = error else {
        panic!("{error}");
    };
    // As they are printed.
    let number = |after: &str| said.split_once(after).unwrap().1.split(' ').next().unwrap().parse().unwrap();
    assert!(simulate_at(number("at least "), dt).is_ok() && simulate_at(gap, number("at most ")).is_ok(), "{said}");
    assert_eq!((node, speed, step), (0, 400.0, grid(dt).step(0)));
    // Products of two or three numbers: rounding only.
    assert!((gap / 0.6e-4 - 1.0).abs() < 1e-12 && (smallest_gap / 1e-4 - 1.0).abs() < 1e-12);
    assert!((largest_step / 0.6e-6 - 1.0).abs() < 1e-12);
    assert!(simulate_at(smallest_gap * (1.0 + 1e-9), dt).is_ok());
    assert!(simulate_at(gap, largest_step * (1.0 - 1e-9)).is_ok());
    assert!(simulate_at(smallest_gap * (1.0 - 1e-9), dt).is_err());
    // A gap of a whole step or more does not touch at step 1 at all.
    assert!(simulate_at(4.0 * smallest_gap, dt).is_ok());
}

/// A bar that starts on its plane, and one at a stated gap; in the same place the two are the same.
#[test]
fn a_plane_is_placed_by_its_gap() {
    for gap in [0.0, 1e-6, 0.25] {
        let stated = |plane| {
            Problem::<1>::builder(Mesh::uniform_bar(0.1, 10).unwrap())
                .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
                .initial_displacement(Initial::Uniform([0.5]))
                .obstacle(plane)
                .build()
                .unwrap()
        };
        let placed = stated(Obstacle::plane_at_gap(gap, [2.0], 0.0, None).unwrap());
        let plane = placed.obstacles()[0].as_plane().unwrap();
        // Node 0 is at 0.5 at the start; rounding of one difference.
        assert!((plane.point()[0] - (0.5 - gap)).abs() < 1e-16 && (placed.initial_gap(0) - gap).abs() < 1e-16);
        let again = stated(Obstacle::plane(*plane.point(), [2.0], 0.0, None).unwrap());
        assert_eq!((placed.obstacles(), placed.surface()), (again.obstacles(), again.surface()));
    }
    assert!([-1e-9, f64::NAN, f64::INFINITY].iter().all(|gap| Obstacle::plane_at_gap(*gap, [1.0], 0.0, None).is_err()));
}

/// A block on a plane in any direction, of which the nodes have velocities of their own: the simulation takes the plane
/// that was moved, refuses it half a percent nearer, and the moved plane is the same problem as one stated there.
#[test]
fn a_plane_that_is_struck_at_once_is_moved_by_the_least_gap() {
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let mesh = random_rectangle(0.05, 0.04, 5, 4).unwrap();
        // The longer side of the block is along the plane, or a corner is nearest.
        let angle = if seed % 2 == 0 { 0.0 } else { random.between(-0.7, 0.7) };
        let normal = [f64::sin(angle), f64::cos(angle)];
        let mut velocity = |_| std::array::from_fn(|c| -10.0 * normal[c] + random.between(-2.0, 2.0));
        let velocity: Vec<[f64; 2]> = (0..mesh.node_count()).map(&mut velocity).collect();
        let stated = |plane: Obstacle<2>| {
            Problem::<2>::builder(mesh.clone())
                .material(aluminium())
                .initial_velocity(Initial::Nodal(velocity.clone()))
                .obstacle(plane)
        };
        let touching = || stated(Obstacle::plane_at_gap(0.0, normal, 0.3, None).unwrap());
        assert!(touching().build().is_err(), "a problem that is not simulated keeps its plane");
        let struck = touching().planes_to_be_moved().build().unwrap();
        assert!(struck.check_planes().is_err() && struck.moved_planes().is_empty());
        let times = TimeGrid::with_step(1e-6, 0.9 * critical_time_step(&struck)).unwrap();
        let moved = struck.with_planes_moved(times.step(0)).unwrap();
        assert!(moved.with_planes_moved(times.step(0)).is_none(), "seed {seed}");
        simulate(&moved, &times, &mut Discard, &mut Unobserved).unwrap();
        let [told] = moved.moved_planes() else { panic!("seed {seed}") };
        let at = |point: [f64; 2]| stated(Obstacle::plane(point, normal, 0.3, None).unwrap()).build().unwrap();
        let [from, to] = [&struck, &moved].map(|problem| *problem.obstacles()[0].as_plane().unwrap().point());
        assert_eq!((at(to).obstacles(), at(to).surface()), (moved.obstacles(), moved.surface()));
        let distance = (0..2).map(|c| (from[c] - to[c]) * normal[c]).sum::<f64>();
        // Rounding of coordinates of centimetres, over micrometres.
        assert!((distance / told.distance - 1.0).abs() < 1e-10, "seed {seed}: {distance} {told:?}");
        let nearer = at(std::array::from_fn(|c| from[c] + 0.995 * (to[c] - from[c])));
        let nearer = simulate(&nearer, &times, &mut Discard, &mut Unobserved);
        assert!(matches!(nearer, Err(SimulationError::StartsTooNear { .. })), "seed {seed}");
    }
}

/// Who rests on a plane, or leaves it, stays on it.
#[test]
fn a_plane_that_is_not_struck_stays() {
    for speed in [0.0, 3.0] {
        let bar = Problem::<1>::builder(Mesh::uniform_bar(0.1, 10).unwrap())
            .material(Elastic::bar(70e9, 2700.0, 0.02).unwrap())
            .initial_velocity(Initial::Uniform([speed]))
            .obstacle(Obstacle::plane([0.0], [1.0], 0.0, None).unwrap());
        let bar = bar.planes_to_be_moved().build().unwrap();
        assert!(bar.with_planes_moved(1e-6).is_none() && bar.initial_gap(0) == 0.0);
    }
}

/// A step is done when it was handed on: what an interrupted run hands on is the beginning of the
/// whole run, bit by bit.
#[test]
fn an_interrupted_run_ends_with_a_whole_step() {
    let problem = shaken_block();
    let times = TimeGrid::uniform(20.0 * 0.9 * critical_time_step(&problem), 20).unwrap();
    let whole = run(&problem, &times);
    assert!(!whole.simulation.interrupted);
    for stop in [1, 7, 20] {
        let mut calls = 0;
        let mut observer = |progress: Progress| {
            calls += 1;
            assert_eq!(progress.total, 20);
            if calls == stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let mut history = History::new(&times);
        let ended = simulate(&problem, &times, &mut history, &mut observer).unwrap();
        assert!(ended.interrupted);
        // Steps 0 to stop − 1 were handed on.
        assert_eq!((ended.steps, history.len()), (stop - 1, stop));
        for n in 0..history.len() {
            assert_eq!(history.step(n), whole.history.step(n), "step {n}");
        }
    }
}

/// Refuses one step.
struct Full {
    at: usize,
    taken: usize,
}

impl StateSink for Full {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        if state.step().index == self.at {
            return Err("no room left".into());
        }
        self.taken += 1;
        Ok(())
    }
}

#[test]
fn a_sink_that_fails_stops_the_run_at_its_step() {
    let problem = shaken_block();
    let times = TimeGrid::uniform(1e-6, 10).unwrap();
    let mut sink = Full { at: 4, taken: 0 };
    let error = simulate(&problem, &times, &mut sink, &mut Unobserved).unwrap_err();
    assert!(
        matches!(&error, SimulationError::Sink { step: 4, cause } if cause.to_string() == "no room left"),
        "{error}"
    );
    assert_eq!(sink.taken, 4);
}
