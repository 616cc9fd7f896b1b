//! Bodies that turn and strain by any amount: momenta, objectivity, the limit of small strains, and the steps.

use crate::solution::run::{Run, run};
use percute_core::contact::Obstacle;
use percute_core::dynamics::{SimulationError, critical_time_step, simulate, simulate_threaded, stable_times};
use percute_core::history::{Discard, History};
use percute_core::material::{Elastic, HyperelasticLaw, Kinematics};
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{Initial, Problem};
use percute_core::time::TimeGrid;

const LAWS: [HyperelasticLaw; 3] =
    [HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff, HyperelasticLaw::Hencky];

fn rubber(law: HyperelasticLaw) -> Elastic {
    Elastic::plane_strain(10e6, 0.4, 1100.0, 1.0).unwrap().with_kinematics(Kinematics::Finite(law)).unwrap()
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

/// A block that moves at this velocity towards a plane with friction below its lower left corner, placed and thrown as
/// a whole turned by an angle about the origin, which the plane is, too.
fn thrown(law: Elastic, cells: [usize; 2], velocity: [f64; 2], placed: f64, gap: f64) -> Problem<2> {
    let mesh = Mesh::rectangle(0.05, 0.04, cells[0], cells[1]).unwrap();
    // A tilt of 20° in the frame of the plane, so that the corner strikes first.
    let angle = 0.35 + placed;
    let moved = |p: &[f64; 2]| {
        let [x, y] = turned(*p, angle);
        [x - p[0], y - p[1]]
    };
    let displacement = mesh.points_in::<2>().iter().map(moved).collect();
    let plane = Obstacle::plane(turned([0.0, -gap], placed), turned([0.0, 1.0], placed), 0.2, None).unwrap();
    Problem::builder(mesh)
        .material(law)
        .initial_displacement(Initial::Nodal(displacement))
        .initial_velocity(Initial::Uniform(turned(velocity, placed)))
        .obstacle(plane)
        .build()
        .unwrap()
}

fn steps_of(problem: &Problem<2>, end: f64, courant: f64) -> TimeGrid {
    stable_times(problem, [end, courant], Some(1), &mut Discard, &mut Unobserved).unwrap().times
}

/// Place of a node at t_n, x = X + u (m).
fn place(run: &Run<'_, 2>, n: usize, node: usize) -> [f64; 2] {
    let (x, u) = (run.problem.mesh().points_in::<2>()[node], run.displacement(n)[node]);
    [x[0] + u[0], x[1] + u[1]]
}

/// Σ m x_n × v_{n+½}: the scheme keeps it, as the internal forces have no moment about the places at t_n.
#[test]
fn a_spinning_square_keeps_its_momenta_and_its_energy() {
    for law in LAWS {
        let mesh = Mesh::rectangle(0.04, 0.04, 6, 6).unwrap();
        // 3 % of the wave speed at the rim, and 1.5 turns.
        let rate = 0.03 * 140.0 / 0.02;
        let spin = mesh.points_in::<2>().iter().map(|p| [3.0 - rate * (p[1] - 0.02), 5.0 + rate * (p[0] - 0.02)]);
        let spin = spin.collect();
        let problem = Problem::<2>::builder(mesh).material(rubber(law)).initial_velocity(Initial::Nodal(spin));
        let problem = problem.build().unwrap();
        let times = steps_of(&problem, 1.5 * std::f64::consts::TAU / rate, 0.9);
        let run = run(&problem, &times);
        let angular = |n: usize| -> f64 {
            let velocity = run.half_velocity(n);
            let moment = |node: usize| {
                let (x, v) = (place(&run, n, node), velocity[node]);
                problem.mass()[node] * (x[0] * v[1] - x[1] * v[0])
            };
            (0..velocity.len()).map(moment).sum()
        };
        let (linear, spin) = (run.momentum(0), angular(0));
        for n in (0..run.last()).step_by(20) {
            for c in 0..2 {
                assert!((run.momentum(n)[c] - linear[c]).abs() < 1e-12 * linear[1], "{law:?} at {n}");
            }
            // v_{n+½} is a difference of displacements over a step: digits are lost as it moves away.
            assert!((angular(n) / spin - 1.0).abs() < 1e-11, "{law:?} at {n}: {} against {spin}", angular(n));
        }
        // Measured: 0.02 %.
        let drift = run.simulation.balance.energy_drift;
        assert!(drift.abs() < 1e-3, "{law:?}: {drift}");
    }
}

/// The same impact, placed at other angles: displacements and reactions turn with it. 1e-12 of the largest, after some
/// 100 steps in which rounding grows with the motion.
#[test]
fn a_turned_impact_is_the_same() {
    for law in LAWS {
        let base = thrown(rubber(law), [5, 4], [3.0, -12.0], 0.0, 1e-3);
        let times = steps_of(&base, 1e-3, 0.8);
        let reference = run(&base, &times);
        let touched = reference.history.reaction().iter().fold(0.0_f64, |most, r| most.max(r.abs()));
        assert!(touched > 0.0);
        for angle in [0.7, std::f64::consts::FRAC_PI_2, 2.5] {
            let problem = thrown(rubber(law), [5, 4], [3.0, -12.0], angle, 1e-3);
            let other = run(&problem, &times);
            for n in 0..=reference.last() {
                for node in 0..problem.mesh().node_count() {
                    let (expected, found) = (turned(place(&reference, n, node), angle), place(&other, n, node));
                    let miss = (expected[0] - found[0]).hypot(expected[1] - found[1]);
                    assert!(miss < 1e-12 * 0.05, "{law:?}, {angle} rad, step {n}: {miss} m");
                }
                let [mine, its] = [&other, &reference].map(|run| run.history.step(n).unwrap().reaction::<2>().to_vec());
                // Nodes of the contact surface are in an order of their own.
                let of = |run: &Run<'_, 2>, forces: &[[f64; 2]], node: usize| {
                    run.contact_nodes().iter().position(|c| *c == node).map_or([0.0; 2], |at| forces[at])
                };
                for node in 0..problem.mesh().node_count() {
                    let (expected, found) = (turned(of(&reference, &its, node), angle), of(&other, &mine, node));
                    let miss = (expected[0] - found[0]).hypot(expected[1] - found[1]);
                    assert!(miss < 1e-11 * touched, "{law:?}, {angle} rad, step {n}: {miss} N");
                }
            }
        }
    }
}

/// Displacements over the speed tend to those of the linear code: their difference falls tenfold with the speed.
#[test]
fn small_impacts_are_those_of_small_strains() {
    let aluminium = Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0).unwrap();
    for law in LAWS {
        let difference = |speed: f64| {
            let mesh = || Mesh::rectangle(0.05, 0.04, 10, 8).unwrap();
            let body = |law: Elastic| {
                let plane = Obstacle::plane([0.0, -speed * 1e-7], [0.0, 1.0], 0.2, None).unwrap();
                let start = Initial::Uniform([0.25 * speed, -speed]);
                Problem::<2>::builder(mesh()).material(law).initial_velocity(start).obstacle(plane).build().unwrap()
            };
            let finite = body(aluminium.with_kinematics(Kinematics::Finite(law)).unwrap());
            let (small, times) = (body(aluminium), TimeGrid::with_step(3e-5, 3e-7).unwrap());
            let (small, finite) = (run(&small, &times), run(&finite, &times));
            let last = small.last();
            let pairs = small.displacement(last).iter().zip(finite.displacement(last));
            let miss = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).hypot(a[1] - b[1]);
            pairs.map(miss).fold(0.0, f64::max) / (speed * 3e-5)
        };
        let differences = [40.0, 4.0, 0.4].map(difference);
        for pair in differences.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((8.0..12.0).contains(&ratio), "{law:?}: {differences:?}");
        }
        assert!(differences[2] < 1e-4, "{law:?}: {differences:?}");
    }
}

/// Rubber at 20 m/s and 40 m/s: no step is above the stable one, none is longer than the one before, and energy is kept
/// to 2 % though the body strains by a third.
#[test]
fn steps_follow_the_stiffness() {
    for (speed, least) in [(20.0, 0.9), (40.0, 0.8)] {
        let problem = thrown(rubber(HyperelasticLaw::NeoHookean), [10, 8], [5.0, -speed], 0.0, 1e-3);
        let times = steps_of(&problem, 1.2e-3, 0.9);
        let lengths: Vec<f64> = (0..times.step_count()).map(|n| times.step(n)).collect();
        assert!(lengths.is_sorted_by(|a, b| *b <= a * (1.0 + 1e-9)), "{lengths:?}");
        let fall = lengths[lengths.len() - 1] / lengths[0];
        assert!(fall < least, "at {speed} m/s the step falls to {fall} of the first");
        let done = run(&problem, &times);
        assert!(done.simulation.balance.energy_drift.abs() < 0.02, "{}", done.simulation.balance.energy_drift);
    }
}

#[test]
fn a_step_above_the_stable_one_is_refused() {
    let problem = thrown(rubber(HyperelasticLaw::NeoHookean), [10, 8], [5.0, -40.0], 0.0, 1e-3);
    let times = TimeGrid::with_step(1.2e-3, 0.95 * critical_time_step(&problem)).unwrap();
    let error = simulate(&problem, &times, &mut Discard, &mut Unobserved).unwrap_err();
    let SimulationError::StepTooLong { step, stable, .. } = error else { panic!("{error}") };
    assert!(stable < step && stable > 0.5 * step, "{stable} of {step}");
}

/// A corner of Saint Venant–Kirchhoff rubber, which softens in compression: 40 m/s are too fast for it. The steps
/// before are with the sink.
#[test]
fn an_element_that_is_turned_inside_out_ends_the_run() {
    let problem = thrown(rubber(HyperelasticLaw::SaintVenantKirchhoff), [10, 8], [5.0, -40.0], 0.0, 1e-3);
    let times = steps_of(&problem, 1.2e-3, 0.9);
    let mut history = History::new(&times);
    let error = simulate(&problem, &times, &mut history, &mut Unobserved).unwrap_err();
    let SimulationError::InsideOut { step, element, ratio, .. } = error else { panic!("{error}") };
    assert!(ratio <= 0.0 && element < problem.mesh().element_count());
    assert_eq!(history.len(), step);
}

#[test]
fn threads_change_no_bit() {
    let problem = thrown(rubber(HyperelasticLaw::NeoHookean), [110, 100], [3.0, -12.0], 0.0, 2e-5);
    let times = TimeGrid::uniform(20.0 * 1e-6, 20).unwrap();
    let of = |threads: usize| {
        let mut history = History::new(&times);
        simulate_threaded(&problem, &times, Some(threads), &mut history, &mut Unobserved).unwrap();
        history
    };
    let one = of(1);
    assert!(one.reaction().iter().any(|r| *r != 0.0));
    assert!([2, 3, 8].map(of).iter().all(|other| *other == one));
}
