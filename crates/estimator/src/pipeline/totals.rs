//! Sums over elements and time, in a fixed order.

use super::near::NearElement;
use super::prepare::{Impulse, Preparation};
use super::sampled_interval::{SampledInterval, estimate_middles, samples};
use super::separation::separation;
use crate::estimate::{ErrorMeasures, Estimate, Parts, Sample};
use crate::map::ElementMap;
use crate::residual::Residuals;
use percute_core::problem::Problem;
use percute_core::ratio;
use percute_core::time::TimeGrid;

/// The results of all windows.
pub(super) struct Worked<const D: usize, const N: usize> {
    pub(super) intervals: Vec<SampledInterval>,
    pub(super) near: Vec<NearElement<D, N>>,
    /// ∫η_E dt of far elements (J s).
    pub(super) integrals: Vec<f64>,
    pub(super) residuals: Residuals,
    pub(super) maps: Vec<ElementMap<D>>,
}

/// The estimate, from everything that was summed.
pub(super) fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    preparation: &Preparation<'_, D, N>,
    worked: Worked<D, N>,
) -> Estimate<D> {
    let Worked { mut intervals, near, integrals: mut integral, mut residuals, mut maps } = worked;
    let mut beside = vec![0.0; problem.surface().sliding().len()];
    // The last step taken in, unless work was stopped before.
    let last = intervals[intervals.len() - 1].levels[1];
    let end = times.instants()[last];
    for element in &near {
        integral[element.element.index()] = element.course.integral;
        residuals.merge(&element.residuals);
        if let Some(index) = element.sliding(problem) {
            beside[index] += element.beside.integral;
        }
    }
    let whole = integral.iter().sum::<f64>();
    let mut surfaces = preparation.tracks().surfaces();
    surfaces.iter_mut().zip(beside).for_each(|(surface, part)| surface.stress = ratio(part, whole));
    preparation.tracks().report(&mut residuals);
    residuals.merge(&preparation.residuals);
    preparation.reconstruction().concentration().into_iter().for_each(|stars| stars.add_residuals(&mut residuals));

    if preparation.estimates_middles() {
        let factor = estimate_middles(&mut intervals);
        let accumulated = maps.iter_mut().flat_map(|map| &mut map.accumulated);
        integral.iter_mut().chain(accumulated).for_each(|integral| *integral *= factor);
    }
    let over_time = samples(&intervals);
    let worst = over_time.iter().fold(over_time[0], |a, b| if b.parts.total() > a.parts.total() { *b } else { a });
    let Impulse { kept, simulated } = preparation.impulse;
    let differences = preparation.reconstruction().differences();
    Estimate {
        sources: differences.map(|differences| separation(&intervals, differences, (worst.time, end))),
        error: measures(&intervals, &over_time, worst.parts.total().sqrt(), end),
        time_of_sup: worst.time,
        parts: worst.parts,
        over_time,
        by_element: integral.into_iter().map(|i| (i / end).sqrt()).collect(),
        maps,
        residuals,
        kept_impulse: (!problem.obstacles().is_empty() && simulated > 0.0).then(|| kept / simulated),
        own_contacts: preparation.reconstruction().own_contacts(),
        auxiliary_contact_energy: preparation.reconstruction().auxiliary_contact_energy(),
        surfaces,
        given: preparation.given(),
        steps: last,
        end,
    }
}

/// The measures of a run up to `end` (s), of which √sup η is known.
fn measures(intervals: &[SampledInterval], over_time: &[Sample], sup: f64, end: f64) -> ErrorMeasures {
    let root_mean = |value: &dyn Fn(&(Parts, f64)) -> f64| {
        let each = |i: &SampledInterval| i.integral(|k| value(&i.samples[k]));
        (intervals.iter().map(each).sum::<f64>() / end).sqrt()
    };
    let mean = root_mean(&|s| s.0.total());
    let reference_sup = over_time.iter().fold(0.0_f64, |m, s| m.max(s.reference)).sqrt();
    let reference_mean = root_mean(&|s| s.1);
    ErrorMeasures {
        sup,
        mean,
        relative_sup: ratio(sup, reference_sup),
        relative_mean: ratio(mean, reference_mean),
        reference_sup,
        reference_mean,
    }
}
