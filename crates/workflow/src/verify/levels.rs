//! The levels of a verification and what they show together.

use super::criterion::{Settled, order};
use crate::memory;
use crate::quantity::{Judgement, Obstruction, Probe, Quantity, judge};
use crate::report::Report;
use percute_core::problem::AnyProblem;
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
    /// The probes.
    pub probes: Vec<ProbeValue>,
    /// Whether the estimate is zero to rounding.
    #[serde(skip)]
    pub(super) exact: bool,
    /// All quantities, the probes last.
    #[serde(skip)]
    followed: Vec<Followed>,
    /// Whether forces and energies are per metre of thickness.
    #[serde(skip)]
    per_metre: bool,
}

/// A quantity on a mesh.
#[derive(Clone, Debug)]
pub(super) struct Followed {
    pub(super) quantity: Quantity,
    pub(super) value: Option<f64>,
    /// What may keep it from converging.
    pub(super) obstruction: Option<Obstruction>,
}

/// A probe on a mesh.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbeValue {
    /// The probe as it is written, such as `0.01,0.02:von_mises`.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Its largest value over time, without its sign.
    pub value: f64,
}

/// How a quantity changes on the finest meshes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// The name of the quantity in [`Level`], of a probe as it is written.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Its change, order and limit.
    #[serde(flatten)]
    pub judgement: Judgement,
    /// A sentence, if it does not converge, with the reason and the way out.
    pub warning: Option<String>,
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
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Orders {
    /// Of the mean estimate: from the two finest meshes.
    pub estimate: Option<f64>,
    /// Of the largest force: from the differences of the three finest meshes, like the rest.
    pub averaged_peak_force: Option<f64>,
    /// Of the impulse.
    pub impulse: Option<f64>,
    /// Of the velocity after contact.
    pub rebound: Option<f64>,
    /// Of the probes.
    pub probes: Vec<Option<f64>>,
}

/// A problem on nested meshes.
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// From the mesh of the problem to the finest that was done.
    pub levels: Vec<Level>,
    /// Orders of convergence.
    pub orders: Orders,
    /// How peak force, impulse, rebound and the probes change on the finest meshes.
    pub convergence: Vec<Convergence>,
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
    pub(super) fn new(problem: &AnyProblem, times: &TimeGrid, options: &Options) -> Self {
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

/// The quantities of a level, the probes last.
pub(super) fn quantities(probes: &[Probe]) -> Vec<Quantity> {
    let contact = [Quantity::PeakForce, Quantity::Impulse, Quantity::Rebound];
    contact.into_iter().chain(probes.iter().cloned().map(Quantity::Probe)).collect()
}

impl Level {
    pub(super) fn new(report: &Report, followed: Vec<Followed>) -> Self {
        let e = &report.error;
        let of = |wanted: &Quantity| followed.iter().find(|each| each.quantity == *wanted)?.value;
        let probe = |each: &Followed| match &each.quantity {
            Quantity::Probe(probe) => {
                Some(ProbeValue { name: probe.to_string(), unit: probe.field().unit(), value: each.value? })
            }
            _ => None,
        };
        Self {
            elements: report.problem.elements,
            steps: report.steps,
            estimate: Measures { sup: e.sup, mean: e.mean },
            relative: Measures { sup: e.relative_sup, mean: e.relative_mean },
            error: None,
            effectivity: None,
            expected: report.verdict.effectivity,
            averaged_peak_force: of(&Quantity::PeakForce),
            impulse: of(&Quantity::Impulse),
            rebound: of(&Quantity::Rebound),
            probes: followed.iter().filter_map(probe).collect(),
            exact: e.is_zero(),
            followed,
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
        let per_metre = levels.first().is_some_and(|level| level.per_metre);
        let convergence = Convergence::of(&levels, Units { per_metre });
        let estimates = levels.iter().rev().map(|level| level.estimate.mean);
        let estimates: Vec<f64> = estimates.take(2).collect();
        let estimate = estimates.get(1).and_then(|coarse| order(*coarse, estimates[0]));
        let of = |at: usize| convergence.get(at).and_then(Convergence::order);
        let probes = convergence.iter().skip(3).map(Convergence::order).collect();
        let orders = Orders { estimate, averaged_peak_force: of(0), impulse: of(1), rebound: of(2), probes };
        Self { levels, orders, convergence, settled, interrupted, per_metre }
    }
}

impl Convergence {
    /// Those of all quantities.
    fn of(levels: &[Level], units: Units) -> Vec<Self> {
        let Some(finest) = levels.last() else { return Vec::new() };
        let each = |(at, Followed { quantity, obstruction, .. }): (usize, &Followed)| {
            let values: Option<Vec<f64>> = levels.iter().rev().take(3).map(|level| level.followed[at].value).collect();
            let values: Vec<f64> = values.unwrap_or_default().into_iter().rev().collect();
            let sizes: Vec<f64> = (0..values.len()).map(|k| 0.5_f64.powi(k as i32)).collect();
            let judgement = judge(&values, &sizes);
            Self {
                quantity: match quantity {
                    Quantity::PeakForce => "averaged_peak_force".to_string(),
                    Quantity::Probe(probe) => probe.to_string(),
                    other => other.to_string(),
                },
                unit: quantity.unit(units).to_string(),
                judgement,
                warning: quantity.warning(&judgement, obstruction.as_ref()),
            }
        };
        finest.followed.iter().enumerate().map(each).collect()
    }

    /// The order, if the values converge.
    pub(super) fn order(&self) -> Option<f64> {
        self.judgement.order.filter(|_| self.judgement.converges == Some(true))
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
