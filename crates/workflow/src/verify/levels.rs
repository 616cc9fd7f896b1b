//! The levels of a verification and what they show together.

use super::criterion::{Settled, order};
use crate::info::memory;
use crate::report::Report;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_core::units::Units;
use percute_estimator::Options;
use percute_estimator::reference::TrueError;
use serde::Serialize;

/// One mesh of a verification.
#[derive(Clone, Debug, Serialize)]
pub struct Level {
    /// Number of elements.
    pub elements: usize,
    /// Number of steps.
    pub steps: usize,
    /// Estimated error: the largest \[15\] and the mean \[16\] (J^½).
    pub estimate: Measures,
    /// The same relative to the fields.
    pub relative: Measures,
    /// True error against the finest mesh (J^½); none for that itself.
    pub error: Option<Measures>,
    /// Estimate over true error; none where that is zero.
    pub effectivity: Option<Measures>,
    /// Range of this index that the verdict states, if it states one.
    pub expected: Option<[f64; 2]>,
    /// Largest normal force of all nodes together (N), averaged over the time in which a wave crosses the struck
    /// element.
    pub averaged_peak_force: Option<f64>,
    /// Normal impulse of all planes (N s).
    pub impulse: Option<f64>,
    /// Normal velocity of the centre of mass after contact (m/s); none without a coefficient of restitution.
    pub rebound: Option<f64>,
    /// Whether the estimate is zero to rounding.
    #[serde(skip)]
    pub(super) exact: bool,
    /// Whether forces and energies are per metre of thickness.
    #[serde(skip)]
    per_metre: bool,
}

/// The largest error and the mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// The largest over time.
    pub sup: f64,
    /// The mean over time.
    pub mean: f64,
}

/// Orders p with which quantities fall or converge like h^p on the finest meshes; none where there are too few, or no
/// convergence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Orders {
    /// Of the mean estimate: from the two finest meshes.
    pub estimate: Option<f64>,
    /// Of the largest force: from the differences of the three finest meshes, like the rest.
    pub averaged_peak_force: Option<f64>,
    /// Of the impulse.
    pub impulse: Option<f64>,
    /// Of the velocity after contact.
    pub rebound: Option<f64>,
}

/// A problem on nested meshes.
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// From the mesh of the problem to the finest that was done.
    pub levels: Vec<Level>,
    /// Orders of convergence.
    pub orders: Orders,
    /// Whether the finest mesh is fine enough; none with fewer than two refinements, or without an error.
    pub settled: Option<Settled>,
    /// Whether the work was stopped before all levels were done.
    pub interrupted: bool,
    /// Whether forces and energies are per metre of thickness.
    pub per_metre: bool,
}

/// The work of a verification.
#[derive(Clone, Debug, Serialize)]
pub struct Cost {
    /// One for each level.
    pub levels: Vec<Work>,
    /// Memory of the motions that are kept, and of the largest run (bytes).
    pub bytes: u64,
    /// About how many times the work of the first level.
    pub times_the_first: f64,
}

/// The work of one level.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Work {
    /// Number of elements.
    pub elements: usize,
    /// Number of steps.
    pub steps: usize,
    /// Bytes of its run.
    #[serde(skip)]
    run: u64,
    /// Bytes of its steps.
    #[serde(skip)]
    history: u64,
}

impl Work {
    pub(super) fn new<const D: usize, const N: usize>(
        problem: &Problem<D, N>,
        times: &TimeGrid,
        options: &Options,
    ) -> Self {
        let run = memory::of_run(problem, times) + percute_estimator::memory(problem, times, options) as u64;
        let (elements, steps) = (problem.mesh().element_count(), times.step_count());
        Self { elements, steps, run, history: memory::of_history(problem, times) }
    }

    fn element_steps(&self) -> f64 {
        self.elements as f64 * self.steps as f64
    }
}

impl Cost {
    pub(super) fn new(levels: Vec<Work>) -> Self {
        // Displacement and velocity of each step, of all but the finest.
        let kept: u64 = levels.iter().rev().skip(1).map(|level| 2 * level.history).sum();
        let bytes = kept + levels.iter().map(|level| level.run).max().unwrap_or(0);
        let work: f64 = levels.iter().map(Work::element_steps).sum();
        let times_the_first = levels.first().map_or(0.0, |first| work / first.element_steps());
        Self { levels, bytes, times_the_first }
    }
}

impl Level {
    pub(super) fn new(report: &Report) -> Self {
        let (e, contact) = (&report.error, report.contact.as_ref().filter(|contact| contact.first_touch.is_some()));
        let impulse = |plane: (&crate::report::ContactResultants, &crate::report::ObstacleSummary)| -> f64 {
            let all: f64 =
                plane.0.impulse.last().map_or(0.0, |l| l.iter().zip(&plane.1.normal).map(|(a, b)| a * b).sum());
            // Two surfaces that touch are two obstacles with one impulse.
            if plane.1.point.is_some() { all } else { 0.5 * all }
        };
        Self {
            elements: report.problem.elements,
            steps: report.steps,
            estimate: Measures { sup: e.sup, mean: e.mean },
            relative: Measures { sup: e.relative_sup, mean: e.relative_mean },
            error: None,
            effectivity: None,
            expected: report.verdict.effectivity,
            averaged_peak_force: contact.and_then(|contact| Some(contact.averaged_peak?.force)),
            impulse: contact.map(|contact| contact.obstacles.iter().zip(&report.problem.obstacles).map(impulse).sum()),
            rebound: report
                .rebound
                .as_ref()
                .filter(|found| found.restitution.is_some())
                .and_then(|found| found.normal_after),
            exact: e.is_zero(),
            per_metre: report.problem.per_metre,
        }
    }

    pub(super) fn compare(&mut self, error: &TrueError) {
        let Measures { sup, mean } = self.estimate;
        self.error = Some(Measures { sup: error.sup, mean: error.mean });
        // The quotient of two roundings says nothing.
        let quotient = Measures { sup: sup / error.sup, mean: mean / error.mean };
        self.effectivity = (!self.exact && error.mean > 0.0).then_some(quotient);
    }
}

impl Verification {
    pub(super) fn new(levels: Vec<Level>, settled: Option<Settled>, interrupted: bool) -> Self {
        let of = |quantity: fn(&Level) -> Option<f64>| converging(&levels, quantity);
        let estimates = levels.iter().rev().map(|level| level.estimate.mean);
        let estimates: Vec<f64> = estimates.take(2).collect();
        let orders = Orders {
            estimate: estimates.get(1).and_then(|coarse| order(*coarse, estimates[0])),
            averaged_peak_force: of(|level| level.averaged_peak_force),
            impulse: of(|level| level.impulse),
            rebound: of(|level| level.rebound),
        };
        let per_metre = levels.first().is_some_and(|level| level.per_metre);
        Self { levels, orders, settled, interrupted, per_metre }
    }
}

impl Verification {
    /// Units of forces and energies.
    #[must_use]
    pub fn units(&self) -> Units {
        Units { per_metre: self.per_metre }
    }

    /// The verification as a JSON document.
    ///
    /// # Errors
    /// None that is known; whatever the serialiser reports.
    pub fn to_json(&self) -> Result<String, std::io::Error> {
        serde_json::to_string(self).map_err(std::io::Error::from)
    }
}

/// The order of the differences between the three finest meshes.
fn converging(levels: &[Level], quantity: fn(&Level) -> Option<f64>) -> Option<f64> {
    let last: Option<Vec<f64>> = levels.iter().rev().take(3).map(quantity).collect();
    let [fine, middle, coarse] = last?.try_into().ok()?;
    order(coarse - middle, middle - fine)
}
