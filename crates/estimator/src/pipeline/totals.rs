//! Sums over elements and time, in a fixed order.

use super::near::NearElement;
use super::prepare::{Impulse, Preparation, Vibration};
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
    pub(super) maps: Vec<ElementMap>,
}

/// The estimate, from everything that was summed.
pub(super) fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D>,
    times: &TimeGrid,
    preparation: &Preparation<'_, D, N>,
    worked: Worked<D, N>,
) -> Estimate {
    let Worked { mut intervals, near, integrals: mut integral, mut residuals, mut maps } = worked;
    let mut residual = vec![0.0; problem.surface().non_matching().len()];
    // The last step taken in, unless work was stopped before.
    let last = intervals[intervals.len() - 1].levels[1];
    let end = times.instants()[last];
    for element in &near {
        integral[element.element.index()] = element.course.integral;
        residuals.merge(&element.residuals);
        if let Some(index) = element.non_matching(problem) {
            residual[index] += element.residual.integral;
        }
    }
    let whole = integral.iter().sum::<f64>();
    let mut surfaces = preparation.tracks().surfaces();
    surfaces.iter_mut().zip(residual).for_each(|(surface, part)| surface.stress = ratio(part, whole));
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
        error: measures(&intervals, &over_time, preparation, end),
        time_of_sup: worst.time,
        parts: worst.parts,
        over_time,
        by_element: integral.into_iter().map(|i| (i / end).sqrt()).collect(),
        maps,
        residuals,
        impulse_ratio: (!problem.obstacles().is_empty() && simulated > 0.0).then(|| kept / simulated),
        isolated_contact_nodes: preparation.reconstruction().isolated_contact_nodes(),
        auxiliary_contact_energy: preparation.reconstruction().auxiliary_contact_energy(),
        surfaces,
        supplied: preparation.supplied(),
        steps: last,
        end,
    }
}

/// The measures of a run up to `end` (s).
fn measures<const D: usize, const N: usize>(
    intervals: &[SampledInterval],
    over_time: &[Sample],
    preparation: &Preparation<'_, D, N>,
    end: f64,
) -> ErrorMeasures {
    let root_sup = |of: fn(&Parts) -> f64| over_time.iter().fold(0.0_f64, |most, s| most.max(of(&s.parts))).sqrt();
    let root_mean = |intervals: &[SampledInterval], length: f64, of: &dyn Fn(&(Parts, f64)) -> f64| {
        let each = |i: &SampledInterval| i.integral(|k| of(&i.samples[k]));
        (intervals.iter().map(each).sum::<f64>() / length).sqrt()
    };
    let touch = preparation.first_contact();
    let touched = &intervals[intervals.iter().rposition(|interval| interval.levels[0] <= touch).unwrap_or(0)..];
    let mean_from_touch = |of: fn(&Parts) -> f64| root_mean(touched, end - touched[0].times[0], &|s| of(&s.0));
    let Vibration { strain, kinetic, total, .. } = preparation.vibration();
    let mut measures = ErrorMeasures {
        sup: root_sup(Parts::total),
        mean: root_mean(intervals, end, &|s| s.0.total()),
        mean_from_touch: mean_from_touch(Parts::total),
        energy: *total,
        strain_energy: *strain,
        kinetic_energy: *kinetic,
        reference_sup: over_time.iter().fold(0.0_f64, |m, s| m.max(s.reference)).sqrt(),
        reference_mean: root_mean(intervals, end, &|s| s.1),
        ..ErrorMeasures::default()
    };
    measures.published_relative_sup = ratio(measures.sup, measures.reference_sup);
    measures.published_relative_mean = ratio(measures.mean, measures.reference_mean);
    // Where both are rounding, their ratio is nothing.
    if !measures.is_zero() {
        let [elastic, moving]: [fn(&Parts) -> f64; 2] = [|parts| parts.elastic, |parts| parts.kinetic];
        let over = |error: f64, energy: f64| ratio(error, energy.sqrt());
        measures.relative_sup = over(measures.sup, *total);
        measures.relative_mean = over(measures.mean_from_touch, *total);
        measures.relative_stress_sup = over(root_sup(elastic), *strain);
        measures.relative_stress_mean = over(mean_from_touch(elastic), *strain);
        measures.relative_velocity_sup = over(root_sup(moving), *kinetic);
        measures.relative_velocity_mean = over(mean_from_touch(moving), *kinetic);
    }
    measures
}
