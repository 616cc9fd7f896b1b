//! Histories that bring velocities and accelerations of their own.

use crate::properties::bodies::{fixed, gravity, plane_below, steps, swinging, thrown};
use crate::properties::estimating::{Evaluated, all_choices, assert_admissible, cause, estimate, history};
use percute_core::dynamics::Evaluation;
use percute_core::history::{History, Step, StepError};
use percute_core::load::{Support, Table};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{Estimate, EstimateError, Options, Reconstruction, Supplied};
use percute_testkit::random_rectangle;
use std::f64::consts::PI;

type Field = Vec<f64>;
/// Makes other velocities of those at a step.
type Change<'a> = &'a dyn Fn(usize, &Field) -> Field;

/// A body thrown on a plane with friction under gravity, and one driven on it with a roller at its side.
fn runs() -> Vec<(Problem<2>, TimeGrid)> {
    let mesh = random_rectangle(0.05, 0.04, 5, 1).unwrap();
    let plane = || plane_below(&mesh, 0.0, 3e-4, 0.3, Some("bottom"));
    let falling = thrown(mesh.clone(), [100.0, -300.0], plane()).body_force(gravity([0.0, -1e6])).build().unwrap();
    let velocity = Table::new(vec![0.0, 9e-6], vec![[0.0, -100.0], [0.0, 40.0]]).unwrap();
    let driven = thrown(mesh.clone(), [0.0, -100.0], plane())
        .support(Support { group: "top".to_string(), components: [false, true, false], velocity: Some(velocity) })
        .support(fixed("left", [true, false]))
        .build()
        .unwrap();
    let times = [swinging(&falling, 60, 3.0), steps(&driven, 0.8, 60)];
    [falling, driven].into_iter().zip(times).collect()
}

/// v_n and a_n of the scheme.
fn motion(problem: &Problem<2>, history: &History, times: &TimeGrid) -> Vec<(Field, Field)> {
    let mut evaluation = Evaluation::new(problem, times);
    let at = |n: usize| {
        let step = history.step(n).unwrap();
        let state = evaluation.advance(&step).unwrap();
        (state.velocity(), state.acceleration())
    };
    (0..history.len()).map(at).collect()
}

/// The same history with velocities, accelerations, or both.
fn with(
    history: &History,
    times: &TimeGrid,
    motion: &[(Field, Field)],
    [velocity, acceleration]: [bool; 2],
) -> History {
    let mut told = History::new(times);
    for (n, (v, a)) in motion.iter().enumerate() {
        let step = history.step(n).unwrap();
        let (velocity, acceleration) = (velocity.then_some(v.as_slice()), acceleration.then_some(a.as_slice()));
        told.push(&Step { velocity, acceleration, ..step }).unwrap();
    }
    told
}

/// How far two estimates are apart, relative to what they measure.
fn apart(one: &Estimate, other: &Estimate) -> f64 {
    let pairs = [(one.error.sup, other.error.sup), (one.error.mean, other.error.mean)];
    let measures = pairs.into_iter().chain([(one.error.reference_sup, other.error.reference_sup)]);
    let largest = measures.map(|(a, b)| (a - b).abs() / b).fold(0.0, f64::max);
    let elements = one.by_element.iter().zip(&other.by_element);
    elements.map(|(a, b)| (a - b).abs() / other.error.mean).fold(largest, f64::max)
}

/// The scheme's own a_n are what the estimate makes of u_n and R_n, bit by bit. From its own v_n the
/// half-step velocity is v_n − ½Δt a_n, back from v_n = v_{n−½} + ½Δt a_n: off by the rounding of a
/// velocity, 1e-16 of it at each step, while the errors are some percent of it. Measured: 2e-16.
#[test]
fn the_own_motion_of_the_scheme_changes_nothing() {
    for (problem, times) in runs() {
        let history = history(&problem, &times);
        let motion = motion(&problem, &history, &times);
        for options in all_choices() {
            let own = estimate(&problem, &history, options);
            assert!(own.supplied == Supplied::default());
            for given in [[true, false], [false, true], [true, true]] {
                let told = estimate(&problem, &with(&history, &times, &motion, given), options);
                let [velocity, acceleration] = given;
                assert_eq!(told.supplied, Supplied { velocity, acceleration });
                assert_admissible(&format!("{given:?}, {options:?}"), &told);
                let distance = apart(&told, &own);
                if velocity {
                    assert!(distance < 1e-14, "{given:?}, {options:?}: {distance:e}");
                } else {
                    assert_eq!((told.error, &told.by_element), (own.error, &own.by_element), "{options:?}");
                }
            }
        }
    }
}

/// Any velocities give admissible fields, and others than the scheme's a larger error: u_CA moves away
/// from what the stresses balance.
#[test]
fn other_velocities_are_admissible_and_worse() {
    for (problem, times) in runs() {
        let history = history(&problem, &times);
        let motion = motion(&problem, &history, &times);
        let scaled =
            |n: usize, v: &Field| -> Field { if n == 0 { v.clone() } else { v.iter().map(|v| 1.1 * v).collect() } };
        let shifted = |n: usize, v: &Field| -> Field {
            let wave = 30.0 * (PI * times.instants()[n] / times.end()).sin();
            let place = |p: &[f64; 2]| [wave * (60.0 * p[1]).cos(), wave * (60.0 * p[0]).sin()];
            v.iter().zip(problem.mesh().points_in::<2>().iter().flat_map(place)).map(|(v, place)| v + place).collect()
        };
        let changes: [(&str, Change<'_>); 2] = [("scaled", &scaled), ("shifted", &shifted)];
        for (what, change) in changes {
            let changed: Vec<_> = motion.iter().enumerate().map(|(n, (v, a))| (change(n, v), a.clone())).collect();
            for options in all_choices() {
                let own = estimate(&problem, &history, options);
                for given in [[true, false], [true, true]] {
                    let told = estimate(&problem, &with(&history, &times, &changed, given), options);
                    assert_admissible(&format!("{what}, {given:?}, {options:?}"), &told);
                    let errors = [told.error.sup, own.error.sup, told.error.mean, own.error.mean];
                    assert!(errors[0] > errors[1] && errors[2] > errors[3], "{what}, {options:?}: {errors:?}");
                }
            }
        }
    }
}

/// Pushes the steps with a velocity each, of which the given function makes what it wants, until one is
/// refused.
fn refused(change: impl Fn(usize, &mut Option<Field>)) -> EstimateError {
    let (problem, times) = runs().remove(0);
    let history = history(&problem, &times);
    let motion = motion(&problem, &history, &times);
    let mut estimator = Evaluated::new(&problem, &times, Options::default());
    for (n, (v, _)) in motion.into_iter().enumerate() {
        let mut velocity = Some(v);
        change(n, &mut velocity);
        let step = Step { velocity: velocity.as_deref(), ..history.step(n).unwrap() };
        if let Err(error) = estimator.push(&step) {
            return cause(error);
        }
    }
    panic!("nothing was refused")
}

#[test]
fn velocities_that_do_not_fit_are_refused() {
    let node = |n: usize, value: f64| {
        move |at: usize, v: &mut Option<Field>| {
            if at == n {
                v.as_mut().unwrap()[2 * 7 + 1] += value;
            }
        }
    };
    // 0.1 % of v₀.
    assert_eq!(refused(node(0, 0.3)), EstimateError::StartVelocity { node: 7 });
    let found = refused(node(4, f64::NAN));
    assert_eq!(found, EstimateError::Step(StepError::NotFinite { step: 4, field: "velocity", position: 7 }));
    let found = refused(|n, v| *v = v.take().filter(|_| n != 3));
    assert_eq!(found, EstimateError::Step(StepError::Partly { step: 3, field: "velocity", there: false }));
    let found = refused(|n, v| *v = v.take().filter(|_| n == 3));
    assert_eq!(found, EstimateError::Step(StepError::Partly { step: 3, field: "velocity", there: true }));
    let found = refused(|n, v| v.as_mut().unwrap().truncate(if n == 2 { 5 } else { usize::MAX }));
    assert!(
        matches!(found, EstimateError::Step(StepError::Length { step: 2, field: "velocity", given: 5, .. })),
        "{found}"
    );
}

/// Accelerations are checked alike.
#[test]
fn accelerations_that_do_not_fit_are_refused() {
    let (problem, times) = runs().remove(0);
    let history = history(&problem, &times);
    let zero = vec![0.0; 2 * problem.mesh().node_count()];
    let mut wrong = zero.clone();
    wrong[2 * 3] = f64::INFINITY;
    for (second, error) in [
        (Some(&wrong), StepError::NotFinite { step: 1, field: "acceleration", position: 3 }),
        (None, StepError::Partly { step: 1, field: "acceleration", there: false }),
    ] {
        let options = Options { reconstruction: Reconstruction::Published, ..Options::default() };
        let mut estimator = Evaluated::new(&problem, &times, options);
        estimator.push(&Step { acceleration: Some(&zero), ..history.step(0).unwrap() }).unwrap();
        let acceleration = second.map(Vec::as_slice);
        let found = estimator.push(&Step { acceleration, ..history.step(1).unwrap() }).unwrap_err();
        assert_eq!(cause(found), EstimateError::Step(error));
    }
}
