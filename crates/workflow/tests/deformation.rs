//! Strains, rotations and stresses beside the estimate, runs without contact, and elements to repair.

use percute_core::contact::Obstacle;
use percute_core::dynamics::critical_time_step;
use percute_core::history::History;
use percute_core::material::Elastic;
use percute_core::mesh::Mesh;
use percute_core::observer::Unobserved;
use percute_core::problem::{AnyProblem, Initial, Problem, plausibility_warnings};
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_workflow::report::{Report, Subject, Trust, summary};
use percute_workflow::run::{Analysis, Storage, estimate, run};
use proptest::prelude::*;

/// Young's modulus (Pa) and speed of waves in a bar (m/s).
pub(crate) const YOUNG: f64 = 70e9;
const WAVES: f64 = 5091.750772173156;

fn aluminium() -> Elastic {
    Elastic::plane_stress(YOUNG, 0.3, 2700.0, 1.0).unwrap()
}

/// The report of a run of so many steps of 0.9 Δt_c.
pub(crate) fn report(problem: &AnyProblem, steps: usize) -> Report {
    let critical_step = critical_time_step(problem);
    let times = TimeGrid::uniform(0.9 * critical_step * steps as f64, steps).unwrap();
    let (options, storage) = (Options::default(), Storage { file: None, memory: None, open: None });
    let results = run(problem, &times, &Analysis::default(), storage, &mut Unobserved).unwrap().results;
    let subject = Subject { name: "", problem, times: &times, critical_step, held: None, checked: None, unended: None };
    Report::new(&subject, options, results.findings(), 0.0)
}

fn named(report: &Report, name: &str) -> Option<String> {
    report.warnings.iter().find(|warning| warning.name == name).map(|warning| warning.message.clone())
}

/// A bar that strikes a wall at once; its strain is −v/c until the wave comes back.
pub(crate) fn bar(speed: f64, law: Elastic) -> AnyProblem {
    let mesh = Mesh::uniform_bar(0.1, 50).unwrap();
    let wall = Obstacle::plane([-1e-7 * speed], [1.0], 0.0, None).unwrap();
    let builder = Problem::<1>::builder(mesh).material(law).initial_velocity(Initial::Uniform([-speed]));
    builder.obstacle(wall).build().unwrap().into()
}

pub(crate) fn of_bar() -> Elastic {
    Elastic::bar(YOUNG, 2700.0, 1e-4).unwrap()
}

/// A rectangle that spins (rad/s) about its centre and flies, over a plane that it does not reach.
fn spinning(spin: f64, velocity: [f64; 2]) -> AnyProblem {
    let mesh = Mesh::rectangle(0.05, 0.04, 5, 4).unwrap();
    let motion = |x: &[f64; 2]| [velocity[0] - spin * (x[1] - 0.02), velocity[1] + spin * (x[0] - 0.025)];
    let velocity = mesh.points_in::<2>().iter().map(motion).collect();
    let plane = Obstacle::plane([0.0, -1.0], [0.0, 1.0], 0.0, None).unwrap();
    let builder = Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Nodal(velocity));
    builder.obstacle(plane).build().unwrap().into()
}

/// The strain of a bar is that of the exact solution: oscillations behind a front of lumped elements have a tenth of it
/// and a little more.
#[test]
fn strains_limit_trust() {
    for (part, trust) in [(0.01, Trust::High), (0.05, Trust::Limited), (0.2, Trust::Low)] {
        let found = report(&bar(part * WAVES, of_bar()), 40);
        let strain = found.deformation.strain();
        assert!(strain.value < -part && strain.value > -1.3 * part, "{strain:?}");
        assert_eq!(found.deformation.materials[0].von_mises.value, YOUNG * -strain.value);
        let told = named(&found, "large_strain");
        assert_eq!(told.is_some(), part > 0.02, "{told:?}");
        // A bar at 0.2 of the wave speed is not in the evidence, either: what counts is the reason.
        assert!(
            found.verdict.trust == trust || (part < 0.02 && !found.verdict.not_small.is_empty()),
            "{:?}",
            found.verdict
        );
        if let Some(told) = told {
            assert!(told.contains(&format!("element {} has", strain.element)) && told.contains('−'), "{told}");
            assert!(found.verdict.not_small[0].starts_with("strains of up to "), "{:?}", found.verdict);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    /// A body that spins freely turns evenly, by ωt, without strain; where this is far, before the run, too.
    #[test]
    fn a_body_that_turns_is_named(spin in -8000.0..8000.0_f64, steps in 60..140_usize) {
        let problem = spinning(spin, [3.0, 7.0]);
        let times = TimeGrid::uniform(0.9 * critical_time_step(&problem) * steps as f64, steps).unwrap();
        let foreseen = plausibility_warnings(&problem, &times).iter().any(|warning| warning.name == "spin");
        let found = report(&problem, steps);
        let (turned, body) = (spin * times.end(), &found.deformation.bodies[0]);
        prop_assert!((body.rotation / turned - 1.0).abs() < 1e-9, "{body:?} {turned}");
        prop_assert_eq!(body.time_of_rotation, times.end());
        prop_assert_eq!(foreseen, turned.abs() > 0.05);
        let told = named(&found, "rotation");
        // Nothing strains the body: each rotation that counts at all is too far.
        prop_assert_eq!(told.is_some(), turned.abs() > 1e-3, "{:?}", told);
        let trust = if turned.abs() > 0.1 { Trust::Low } else { Trust::Limited };
        prop_assert!(told.is_none() || found.verdict.trust == trust, "{:?}", found.verdict);
    }
}

/// Of two bodies the one that turns is named, in the order of the user although the solver has another one.
#[test]
fn one_of_two_bodies_turns() {
    let (left, right) = (Mesh::rectangle(0.03, 0.02, 6, 4).unwrap(), Mesh::rectangle(0.02, 0.02, 4, 4));
    let right = right.unwrap().placed(&[0.1, 0.0], 0.0).unwrap();
    let mesh = Mesh::joined(&[("left", &left), ("right", &right)]).unwrap();
    let motion = |x: &[f64; 2]| if x[0] < 0.05 { [0.0; 2] } else { [-3000.0 * (x[1] - 0.01), 3000.0 * (x[0] - 0.11)] };
    let velocity = mesh.points_in::<2>().iter().map(motion).collect();
    let builder = Problem::<2>::builder(mesh).material(aluminium()).initial_velocity(Initial::Nodal(velocity));
    let found = report(&builder.build().unwrap().into(), 100);
    let [left, right] = &found.deformation.bodies[..] else { panic!("two bodies") };
    assert_eq!([&left.name[..], &right.name[..]], ["left", "right"]);
    assert!(left.rotation == 0.0 && right.rotation > 0.05, "{left:?} {right:?}");
    let told = named(&found, "rotation").unwrap();
    assert!(told.starts_with("\"right\" turns by"), "{told}");
}

/// Without contact this comes first, with the gap that is left and the instant at which it would close.
#[test]
fn nothing_touched_comes_first() {
    let speed = 5.0;
    let mesh = Mesh::rectangle(0.05, 0.04, 5, 4).unwrap();
    let plane = Obstacle::plane([0.0, -1e-3], [0.0, 1.0], 0.2, None).unwrap();
    let builder = Problem::<2>::builder(mesh).material(aluminium()).obstacle(plane);
    let found = report(&builder.clone().initial_velocity(Initial::Uniform([0.0, -speed])).build().unwrap().into(), 100);
    let nearest = found.contact.as_ref().and_then(|contact| contact.nearest).unwrap();
    // Displacements of 1e-4 m have rounding of 1e-20 m; a speed from two of them 1e-13 of it.
    assert!((nearest.gap - (1e-3 - speed * found.end)).abs() < 1e-15, "{nearest:?}");
    assert!((nearest.touch.unwrap() - 1e-3 / speed).abs() < 1e-9 * 1e-3 / speed, "{nearest:?}");
    assert!(found.verdict.text[0].starts_with("Nothing touched: "), "{:?}", found.verdict.text);
    assert!(found.verdict.text[0].contains("a gap would first close at 2e-4 s"), "{:?}", found.verdict.text);
    assert!(summary(&found).starts_with("CONTACT   NOTHING TOUCHED"), "{}", summary(&found));
    let json: serde_json::Value = serde_json::from_str(&found.verdict_to_json().unwrap()).unwrap();
    assert_eq!(json["contact"]["nearest"]["gap"], nearest.gap);

    let away = report(&builder.clone().initial_velocity(Initial::Uniform([0.0, speed])).build().unwrap().into(), 100);
    assert!(away.verdict.text[0].contains("no node approaches"), "{:?}", away.verdict.text);
    // Without planes nothing can touch, and after a touch nothing is left.
    let free = Problem::<2>::builder(Mesh::rectangle(0.05, 0.04, 5, 4).unwrap()).material(aluminium());
    let free = report(&free.initial_velocity(Initial::Uniform([0.0, -speed])).build().unwrap().into(), 20);
    let touched = report(&bar(10.0, of_bar()), 60);
    for found in [free, touched] {
        assert!(!found.verdict.text[0].contains("Nothing touched"), "{:?}", found.verdict.text);
        assert!(found.contact.is_none_or(|contact| contact.nearest.is_none()));
    }
}

/// The blunt wedge whose error is that of a few needles beside its tip: they are named, with their shares.
#[test]
fn needles_are_named() {
    let square = Mesh::rectangle(1.0, 1.0, 8, 8).unwrap();
    let place = |p: &[f64; 2]| [(p[0] - 0.5) * (4.0 + 50.0 * p[1]) * 1e-3, 0.04 * p[1]];
    let points = square.points_in().iter().map(place).collect();
    let cells: Vec<_> = square.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
    let mesh = Mesh::new(points, &cells, &Default::default(), &Default::default()).unwrap();
    let plane = Obstacle::plane([0.0, -1e-6], [0.0, 1.0], 0.2, None).unwrap();
    let builder = Problem::<2>::builder(mesh.clone()).material(aluminium()).obstacle(plane);
    let found = report(&builder.initial_velocity(Initial::Uniform([0.0, -25.0])).build().unwrap().into(), 200);
    let (poor, total) = (&found.verdict.poor_elements, found.by_element.iter().map(|error| error * error).sum::<f64>());
    assert!(poor.len() == 3 && poor.iter().map(|one| one.share).sum::<f64>() > 0.2, "{poor:?}");
    for one in poor {
        let share = found.by_element[one.element].powi(2) / total;
        assert!((share / one.share - 1.0).abs() < 1e-12 && one.aspect > 3.0, "{one:?}");
        assert!((0.0..30.0).contains(&one.smallest_angle) && one.largest_angle < 150.0, "{one:?}");
    }
    let told = found.verdict.text.iter().find(|line| line.starts_with("Repair first")).unwrap();
    assert!(told.contains(&format!("element {} (", poor[0].element)) && told.contains("edges 1 to"), "{told}");
    assert!(report(&spinning(1.0, [0.0, -5.0]), 20).verdict.poor_elements.is_empty());
}

/// From a history, strains and rotations are those of its run.
#[test]
fn a_history_has_the_same() {
    let problem = bar(100.0, of_bar());
    let times = TimeGrid::uniform(0.9 * critical_time_step(&problem) * 50.0, 50).unwrap();
    let mut history = History::new(&times);
    percute_core::dynamics::simulate(&problem, &times, &mut history, &mut Unobserved).unwrap();
    let again = estimate(&problem, &history, &Analysis::default(), &mut Unobserved).unwrap();
    let storage = Storage { file: None, memory: None, open: None };
    let beside = run(&problem, &times, &Analysis::default(), storage, &mut Unobserved).unwrap().results;
    assert_eq!(again.deformation, beside.deformation);
    assert_eq!(again.contact, beside.contact);
}
