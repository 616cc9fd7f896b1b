//! Effectivity indices against a finer run.

use percute_core::dynamics::{critical_time_step, simulate};
use percute_core::observer::Unobserved;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion};
use percute_estimator::{Estimator, Options, Sampling};

/// e_sup/e_ref and e_mean/e_ref of problems on different meshes up to an instant (s), with steps of 0.9 Δt_c.
pub(crate) fn indices(problems: &[Problem<2>], fine: &Problem<2>, end: f64) -> Vec<[f64; 2]> {
    let mut reach = end;
    let run = |problem: &Problem<2>| {
        let times = grid(problem, end);
        let options = Options { every: Sampling::Every(1), ..Options::default() };
        let mut sink = (Motion::default(), Estimator::new(problem, &times, options).unwrap());
        simulate(problem, &times, &mut sink, &mut Unobserved).unwrap();
        reach = reach.max(times.end());
        let (motion, estimator) = sink;
        (motion, estimator.finish().unwrap().error)
    };
    let runs: Vec<_> = problems.iter().map(run).collect();
    let mut comparison = Comparison::new(fine);
    for (problem, (motion, _)) in problems.iter().zip(&runs) {
        comparison.add(problem, motion).unwrap();
    }
    simulate(fine, &grid(fine, reach), &mut comparison, &mut Unobserved).unwrap();
    let exact = comparison.finish().unwrap();
    runs.iter().zip(&exact).map(|((_, found), exact)| [found.sup / exact.sup, found.mean / exact.mean]).collect()
}

fn grid(problem: &Problem<2>, reach: f64) -> TimeGrid {
    let step = 0.9 * critical_time_step(problem);
    let count = (reach / step).ceil();
    TimeGrid::uniform(count * step, count as usize).unwrap()
}
