//! Estimates of histories under all choices.

use percute_core::dynamics::{Evaluation, replay, simulate};
use percute_core::history::{History, SinkError, StateSink, Step, StepError, StepSource};
use percute_core::observer::Unobserved;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::{Acceleration, Estimate, EstimateError, Estimator, Options, Reconstruction, Request, Sampling};

/// All reconstructions of the contact force under each of the Γ_DA.
pub(crate) fn all_choices() -> impl Iterator<Item = Options> {
    Reconstruction::ALL.iter().flat_map(|&reconstruction| {
        Acceleration::of(reconstruction).iter().map(move |&acceleration| Options {
            reconstruction,
            acceleration: Some(acceleration),
            threads: Some(1),
            ..Options::default()
        })
    })
}

/// The steps of a problem that must run to its end.
pub(crate) fn history<const D: usize>(problem: &Problem<D>, times: &TimeGrid) -> History {
    let mut history = History::new(times);
    simulate(problem, times, &mut history, &mut Unobserved).unwrap();
    history
}

/// An estimator of bare steps.
pub(crate) struct Evaluated<'p> {
    evaluation: Evaluation<'p>,
    pub(crate) estimator: Estimator<'p>,
}

impl<'p> Evaluated<'p> {
    pub(crate) fn new(problem: &'p Problem<2>, times: &'p TimeGrid, options: Options) -> Self {
        let estimator = Estimator::new(problem, times, options).unwrap();
        Self { evaluation: Evaluation::new(problem, times), estimator }
    }

    pub(crate) fn push(&mut self, step: &Step<'_>) -> Result<(), SinkError> {
        self.estimator.accept(&self.evaluation.advance(step)?)
    }
}

/// The reason why a step was refused.
pub(crate) fn cause(error: SinkError) -> EstimateError {
    match error.downcast::<StepError>() {
        Ok(error) => EstimateError::Step(*error),
        Err(error) => *error.downcast().unwrap(),
    }
}

/// The estimate of a stored history.
pub(crate) fn estimate<const D: usize>(problem: &Problem<D>, history: &History, options: Options) -> Estimate {
    estimate_with_maps(problem, history, options, &Request::default())
}

/// The same with maps.
pub(crate) fn estimate_with_maps<const D: usize>(
    problem: &Problem<D>,
    history: &History,
    options: Options,
    request: &Request,
) -> Estimate {
    let mut estimator = Estimator::new(problem, history.times(), options).unwrap().keeping(request).unwrap();
    replay(problem, history, &mut estimator).unwrap();
    estimator.finish().unwrap()
}

/// Every residual is a number and at most 1e-10, the bound of the method: rounding of the longest
/// sums here leaves some 1e-13.
pub(crate) fn assert_admissible(what: &str, estimate: &Estimate) {
    for (name, value) in estimate.residuals.entries() {
        assert!(value <= 1e-10, "{what}: the residual of {name} is {value:e}");
    }
    assert!(estimate.error.sup.is_finite() && estimate.error.mean.is_finite(), "{what}: {:?}", estimate.error);
}

/// Runs a problem and checks the residuals of its estimate under all choices and with samples at
/// every, every second and every fifth step. Returns the number of reactions, so that a case in
/// which nothing happens can be seen.
pub(crate) fn check<const D: usize>(what: &str, problem: &Problem<D>, times: &TimeGrid) -> usize {
    let history = history(problem, times);
    for (k, options) in all_choices().enumerate() {
        // Each `every` meets each reconstruction; all 20 combinations would cost three times as much.
        for every in if k % 3 == 0 { vec![1, 2, 5] } else { vec![1] } {
            let options = Options { every: Sampling::Every(every), ..options };
            let what = format!("{what}, {}, {}, every {every}", options.reconstruction, options.acceleration(D));
            let estimate = estimate(problem, &history, options);
            assert_admissible(&what, &estimate);
        }
    }
    reactions::<D>(&history)
}

/// Number of reactions, over all steps and nodes.
pub(crate) fn reactions<const D: usize>(history: &History) -> usize {
    let count = |n: usize| history.step(n).unwrap().reaction().iter().filter(|r| **r != [0.0; D]).count();
    (0..history.len()).map(count).sum()
}
