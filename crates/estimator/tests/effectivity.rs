//! Effectivity in 2D: the estimated error over the true one, against a finer run.

// Clippy allows this in test functions only; what they share is a test as well.
#![allow(clippy::unwrap_used)]

mod common;

use common::{MESHES, assert_close, block};
use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::observer::Unobserved;
use percute_core::problem::TriangleProblem;
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion, Recorder};
use percute_estimator::{ContactForce, ErrorMeasures, Estimator, Options};

/// Gap (m) and the least T (s): a run takes steps of exactly 0.9 Δt_c and ends with the first at or
/// past it. (13 µs in equal, slightly shorter steps would give 1.74 instead of 1.80 for the first.)
const GAP: f64 = 0.2e-3;
const END: f64 = 13e-6;
/// Number of steps on the four meshes.
const STEPS: [usize; 4] = [12, 23, 45, 89];

/// An effectivity for each of the four meshes.
type Row = [f64; 4];
/// e_sup/e_ref and e_mean/e_ref of a computation independent of this program: plane stress,
/// μ = 0.2, v = (400, −400) m/s, against 160×128 cells, Γ_DA `closest`.
const INDEPENDENT: [(ContactForce, Row, Row); 2] = [
    (ContactForce::Sharp, [1.50, 1.26, 1.18, 1.16], [1.51, 1.26, 1.20, 1.23]),
    (ContactForce::Paper, [1.80, 1.78, 2.02, 2.52], [1.83, 1.65, 1.78, 2.08]),
];

/// Steps of exactly 0.9 Δt_c that reach an instant.
fn grid(problem: &TriangleProblem, reach: f64) -> TimeGrid {
    let step = 0.9 * critical_time_step(problem);
    let count = (reach / step).ceil();
    TimeGrid::uniform(count * step, count as usize).unwrap()
}

/// Motion and estimates of one run, in the order of [`INDEPENDENT`].
fn run(problem: &TriangleProblem, times: &TimeGrid) -> (Motion<2>, [ErrorMeasures; 2]) {
    let estimator = |which: usize| {
        let options = Options { contact_force: INDEPENDENT[which].0, ..Options::default() };
        Estimator::new(problem, times, options).unwrap()
    };
    let mut sink = (Recorder::new(problem, times), (estimator(0), estimator(1)));
    simulate(problem, times, &mut sink, &mut Unobserved).unwrap();
    let (recorder, (sharp, paper)) = sink;
    (recorder.finish(), [sharp, paper].map(|e| e.finish().unwrap().error))
}

/// All sixteen in one test: they share the reference.
#[test]
fn effectivities_against_a_fine_mesh() {
    let problems = MESHES.map(|cells| block(cells, GAP));
    let grids: Vec<_> = problems.iter().map(|problem| grid(problem, END)).collect();
    let runs: Vec<_> = problems.iter().zip(&grids).map(|(problem, times)| run(problem, times)).collect();

    let fine = block([160, 128], GAP);
    let end = grids.iter().map(TimeGrid::end).fold(0.0, f64::max);
    let times = grid(&fine, end);
    let mut comparison = Comparison::new(&fine, &times);
    for (problem, (motion, _)) in problems.iter().zip(&runs) {
        comparison.add(problem, motion).unwrap();
    }
    simulate(&fine, &times, &mut comparison, &mut Unobserved).unwrap();
    let exact = comparison.finish().unwrap();

    for (k, cells) in MESHES.into_iter().enumerate() {
        assert_eq!(grids[k].step_count(), STEPS[k], "steps on {cells:?}");
        for (which, (reading, sup, mean)) in INDEPENDENT.iter().enumerate() {
            let error = &runs[k].1[which];
            // 3 %: the values are rounded to 0.01, 0.9 % of the smallest, and both programs have a
            // critical step of their own, good to 1e-3, which moves the instants of impact.
            assert_close(error.sup / exact[k].sup, sup[k], 0.03, &format!("{reading}, sup, {cells:?}"));
            assert_close(error.mean / exact[k].mean, mean[k], 0.03, &format!("{reading}, mean, {cells:?}"));
        }
    }
}

/// A run is no error to itself, and the reference must reach its end.
#[test]
fn a_run_against_itself() {
    let problem = block([5, 4], GAP);
    let times = grid(&problem, END);
    let motion = run(&problem, &times).0;
    let mut comparison = Comparison::new(&problem, &times);
    comparison.add(&problem, &motion).unwrap();
    simulate(&problem, &times, &mut comparison, &mut Unobserved).unwrap();
    let error = comparison.finish().unwrap().remove(0);
    // Rounding of the transfer, 1e-16 of the fields, against the 2 900 J^½ of the flight.
    assert!(error.sup < 1e-11, "{}", error.sup);

    let short = TimeGrid::uniform(0.5 * times.end(), times.step_count()).unwrap();
    let mut comparison = Comparison::new(&problem, &short);
    comparison.add(&problem, &motion).unwrap();
    simulate(&problem, &short, &mut comparison, &mut Unobserved).unwrap();
    assert!(comparison.finish().is_err());
}
