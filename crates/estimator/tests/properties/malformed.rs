//! Steps that do not fit: an error that says what is wrong, never a panic.

use crate::properties::bodies::{plane_below, steps, thrown};
use crate::properties::estimating::{Evaluated, cause, history};
use percute_core::history::{Step, StepError};
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{
    Acceleration, EstimateError, Estimator, MOST_THREADS, Options, Reconstruction, Sampling, UnsuitableAcceleration,
};
use percute_testkit::random_rectangle;

/// A step that can be spoilt.
struct Raw {
    index: usize,
    time: f64,
    displacement: Vec<f64>,
    reaction: Vec<f64>,
    touching: Vec<bool>,
}

impl Raw {
    fn of(step: &Step<'_>) -> Self {
        let (displacement, reaction) = (step.displacement.to_vec(), step.reaction.to_vec());
        let (index, time, touching) = (step.index, step.time, step.touching.to_vec());
        Self { index, time, displacement, reaction, touching }
    }

    fn step(&self) -> Step<'_> {
        let Self { index, time, displacement, reaction, touching } = self;
        let (index, time) = (*index, *time);
        Step { index, time, displacement, reaction, touching, internal: &[], velocity: None, acceleration: None }
    }
}

fn impact() -> Problem<2> {
    let mesh = random_rectangle(0.05, 0.04, 5, 1).unwrap();
    let plane = plane_below(&mesh, 0.0, 6e-4, 0.2, None);
    thrown(mesh, [100.0, -300.0], plane).build().unwrap()
}

type Spoil = fn(&mut Raw);

/// Feeds the steps of a run up to number `at`, which is spoilt.
fn fed(at: usize, spoil: impl Fn(&mut Raw)) -> EstimateError {
    let problem = impact();
    let times = steps(&problem, 0.9, 10);
    let history = history(&problem, &times);
    let mut estimator = Evaluated::new(&problem, &times, Options::default());
    for n in 0..at {
        estimator.push(&history.step(n).unwrap()).unwrap();
    }
    let mut raw = Raw::of(&history.step(at.min(10)).unwrap());
    spoil(&mut raw);
    let error = cause(estimator.push(&raw.step()).unwrap_err());
    // What was right before can still be summed up.
    assert_eq!(estimator.estimator.finish().is_ok(), at >= 2);
    error
}

#[test]
fn wrong_lengths() {
    for at in [0, 1, 5] {
        let fields: [(&str, Spoil); 3] = [
            ("displacement", |raw| raw.displacement.truncate(3)),
            ("reaction", |raw| raw.reaction.push(0.0)),
            ("touching", |raw| raw.touching.clear()),
        ];
        for (name, spoil) in fields {
            let error = fed(at, spoil);
            let EstimateError::Step(StepError::Length { step, field, .. }) = error else { panic!("{error}") };
            assert_eq!((step, field), (at, name));
        }
    }
}

#[test]
fn values_that_are_no_numbers() {
    for value in [f64::NAN, f64::INFINITY] {
        let error = fed(3, |raw| raw.displacement[2 * 7 + 1] = value);
        assert_eq!(error, EstimateError::Step(StepError::NotFinite { step: 3, field: "displacement", position: 7 }));
        let error = fed(0, |raw| raw.reaction[2 * 2] = value);
        assert_eq!(error, EstimateError::Step(StepError::NotFinite { step: 0, field: "reaction", position: 2 }));
    }
}

#[test]
fn steps_out_of_order() {
    assert_eq!(fed(3, |raw| raw.index = 5), EstimateError::Step(StepError::Order { given: 5, expected: 3, last: 10 }));
    assert_eq!(fed(3, |raw| raw.index = 2), EstimateError::Step(StepError::Order { given: 2, expected: 3, last: 10 }));
    assert_eq!(fed(0, |raw| raw.index = 1), EstimateError::Step(StepError::Order { given: 1, expected: 0, last: 10 }));
    // One step too many.
    assert_eq!(
        fed(11, |raw| raw.index = 11),
        EstimateError::Step(StepError::Order { given: 11, expected: 11, last: 10 })
    );
}

/// From another program may come what this integrator refuses: a node that touches at step 1 from a gap
/// below |v_n|Δt₀/4, here 300 m/s · Δt/4.
#[test]
fn a_start_too_near() {
    let problem = impact();
    let (far, near) = (4.0 * 6e-4 / 300.0 * 0.999, 4.0 * 6e-4 / 300.0 * 1.001);
    for (step, refused) in [(far, false), (near, true)] {
        let times = TimeGrid::uniform(3.0 * step, 3).unwrap();
        let surface = problem.surface().nodes().len();
        let mut estimator = Evaluated::new(&problem, &times, Options::default());
        let nodes = problem.mesh().node_count();
        let mut raw = Raw {
            index: 0,
            time: 0.0,
            displacement: vec![0.0; 2 * nodes],
            reaction: vec![0.0; 2 * surface],
            touching: vec![false; surface],
        };
        estimator.push(&raw.step()).unwrap();
        (raw.index, raw.time) = (1, times.instants()[1]);
        raw.touching[0] = true;
        match estimator.push(&raw.step()) {
            Ok(()) => assert!(!refused),
            Err(error) => {
                let node = problem.surface().nodes()[0].node.index();
                let EstimateError::StartsTooNear { node: found, gap, smallest_gap } = cause(error) else { panic!() };
                assert_eq!((found, refused), (node, true));
                // The gap of a mesh of 0.05 m to rounding.
                assert!((gap - 6e-4).abs() < 1e-15 && (smallest_gap - 6.006e-4).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn too_few_steps_and_impossible_options() {
    let problem = impact();
    let times = steps(&problem, 0.9, 10);
    let history = history(&problem, &times);
    for count in 0..2 {
        let mut estimator = Evaluated::new(&problem, &times, Options::default());
        (0..count).for_each(|n| estimator.push(&history.step(n).unwrap()).unwrap());
        assert_eq!(estimator.estimator.finish(), Err(EstimateError::TooFewSteps { count }));
    }
    for options in [
        Options { every: Sampling::Every(0), ..Options::default() },
        Options { window: Some(0), ..Options::default() },
        Options { threads: Some(0), ..Options::default() },
    ] {
        let made = Estimator::new(&problem, &times, options);
        assert!(matches!(made.err(), Some(EstimateError::Zero { .. })), "{options:?}");
    }
    let options = Options { threads: Some(MOST_THREADS + 1), ..Options::default() };
    let refused = Estimator::new(&problem, &times, options).err();
    assert_eq!(refused, Some(EstimateError::TooManyThreads { threads: 1025 }));
    for reconstruction in [Reconstruction::Consistent, Reconstruction::Published] {
        let options = Options { reconstruction, acceleration: Some(Acceleration::Split), ..Options::default() };
        let refused = Estimator::new(&problem, &times, options).err();
        let expected = UnsuitableAcceleration { acceleration: Acceleration::Split, reconstruction };
        assert_eq!(refused, Some(EstimateError::Acceleration(expected)));
    }
}

/// Finite, but too large for what is made of it: the estimate must not look sound.
#[test]
fn overflow_shows() {
    let problem = impact();
    let times = steps(&problem, 0.9, 10);
    let history = history(&problem, &times);
    let mut estimator = Evaluated::new(&problem, &times, Options::default());
    for n in 0..history.len() {
        let mut raw = Raw::of(&history.step(n).unwrap());
        if n == 4 {
            raw.displacement[14..16].copy_from_slice(&[1e305, -1e305]);
        }
        estimator.push(&raw.step()).unwrap();
    }
    assert_eq!(estimator.estimator.finish(), Err(EstimateError::Overflow));
}

/// Times of another grid, a first step that is not the initial state, contact where there is none.
#[test]
fn steps_of_another_problem() {
    let problem = impact();
    let end = steps(&problem, 0.9, 10).end();
    let found = fed(3, |raw| raw.time += 1e-3 * end);
    assert!(
        matches!(found, EstimateError::Step(StepError::Time { step: 3, given, expected }) if given > expected),
        "{found:?}"
    );
    assert!(matches!(fed(3, |raw| raw.time = f64::NAN), EstimateError::Step(StepError::Time { step: 3, .. })));
    assert_eq!(fed(0, |raw| raw.displacement[8] = 1e-6), EstimateError::Start { node: 4 });
    let found = fed(0, |raw| raw.touching[1] = true);
    let node = problem.surface().nodes()[1].node.index();
    assert!(
        matches!(found, EstimateError::StartsTouching { node: n, gap, .. } if n == node && gap > 1e-4),
        "{found:?}"
    );
}

/// A history of which only every third instant was kept, as another scheme might take them: too long for the auxiliary
/// solution of `corrected`, which says so, and no hindrance to `consistent`.
#[test]
fn steps_too_long_for_the_auxiliary_solution() {
    let problem = impact();
    let times = steps(&problem, 0.9, 240);
    let history = history(&problem, &times);
    let instants: Vec<f64> = times.instants().iter().copied().step_by(3).collect();
    let longest = instants[1];
    let thinned = TimeGrid::from_instants(instants).unwrap();
    for reconstruction in [Reconstruction::Corrected, Reconstruction::Consistent] {
        let options = Options { reconstruction, ..Options::default() };
        let mut estimator = Evaluated::new(&problem, &thinned, options);
        let mut refused = None;
        for n in 0..=thinned.step_count() {
            let mut raw = Raw::of(&history.step(3 * n).unwrap());
            (raw.index, raw.time) = (n, thinned.instants()[n]);
            if let Err(error) = estimator.push(&raw.step()) {
                refused = Some(cause(error));
                break;
            }
        }
        let told = refused.as_ref().map(ToString::to_string).unwrap_or_default();
        match refused {
            Some(EstimateError::AuxiliarySolution { longest_step, step, .. }) => {
                assert_eq!(reconstruction, Reconstruction::Corrected);
                // The shortest waves grow by some 20 in each step, their energy by 400: soon a million times what there
                // is.
                assert!(step < 20, "told at step {step}");
                assert!(
                    (longest_step / longest - 1.0).abs() < 1e-9 && told.contains("reconstruction = \"consistent\""),
                    "{told}"
                );
            }
            other => assert!(other.is_none() && reconstruction == Reconstruction::Consistent, "{other:?}"),
        }
        // What was right before can still be summed up.
        assert!(estimator.estimator.finish().is_ok());
    }
}
