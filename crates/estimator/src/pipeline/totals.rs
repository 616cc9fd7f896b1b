//! Sums over elements and time, in a fixed order.

use super::near::NearElement;
use super::prepare::{Impulse, Preparation};
use super::sampling::{Course, trapezoid};
use crate::estimate::{ErrorMeasures, Estimate, Parts, Sample};
use crate::map::ElementMap;
use crate::measure::ElementError;
use crate::residual::Residuals;
use percute_core::problem::Problem;
use percute_core::ratio;
use percute_core::time::TimeGrid;

/// Sums over far elements at the levels and in the middles between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarSums {
    pub(crate) levels: Vec<ElementError>,
    pub(crate) mids: Vec<ElementError>,
}

impl FarSums {
    pub(crate) fn new(levels: usize, mids: usize) -> Self {
        Self { levels: vec![ElementError::default(); levels], mids: vec![ElementError::default(); mids] }
    }

    /// Adds another block of elements.
    pub(crate) fn add(&mut self, other: &Self) {
        self.levels.iter_mut().zip(&other.levels).for_each(|(a, b)| a.add(b));
        self.mids.iter_mut().zip(&other.mids).for_each(|(a, b)| a.add(b));
    }

    /// Appends a later window.
    pub(crate) fn extend(&mut self, later: Self) {
        self.levels.extend(later.levels);
        self.mids.extend(later.mids);
    }
}

/// One interval between sampled levels.
struct SampledInterval {
    /// Times of its beginning and end (s).
    times: [f64; 2],
    /// Whether its middle is sampled.
    single: bool,
    /// Parts and d at beginning, middle, end.
    samples: [(Parts, f64); 3],
}

/// The results of all windows.
pub(crate) struct Worked<const D: usize, const N: usize> {
    pub(crate) far: FarSums,
    pub(crate) near: Vec<NearElement<D, N>>,
    /// η_E of far elements.
    pub(crate) courses: Vec<Course>,
    pub(crate) residuals: Residuals,
    pub(crate) maps: Vec<ElementMap<D>>,
}

/// The estimate, from everything that was summed.
pub(crate) fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    preparation: &Preparation<'_, D, N>,
    worked: Worked<D, N>,
) -> Estimate<D> {
    let Worked { far, near, courses, mut residuals, maps } = worked;
    let last = preparation.count() - 1;
    let end = times.instants()[last];
    let mut integral = courses.iter().map(|course| course.integral).collect::<Vec<_>>();
    for element in &near {
        integral[element.element.index()] = element.course.integral;
        residuals.merge(&element.residuals);
    }
    preparation.tracks().iter().for_each(|track| track.report(&mut residuals));
    residuals.merge(&preparation.residuals);
    preparation.reconstruction().concentration().into_iter().for_each(|stars| stars.add_residuals(&mut residuals));

    let intervals = intervals(times, preparation.every(), last, &far, &near);
    let over_time = samples(&intervals);
    let worst = over_time.iter().fold(over_time[0], |a, b| if b.parts.total() > a.parts.total() { *b } else { a });
    let Impulse { kept, simulated } = preparation.impulse;
    Estimate {
        error: measures(&intervals, &over_time, worst.parts.total().sqrt(), end),
        time_of_sup: worst.time,
        parts: worst.parts,
        over_time,
        by_element: integral.into_iter().map(|i| (i / end).sqrt()).collect(),
        maps,
        residuals,
        kept_impulse: (!problem.obstacles().is_empty() && simulated > 0.0).then(|| kept / simulated),
        own_contacts: preparation.reconstruction().own_contacts(),
        given: preparation.given(),
        steps: last,
        end,
    }
}

/// The measures of a run up to `end` (s), of which √sup η is known.
fn measures(intervals: &[SampledInterval], over_time: &[Sample], sup: f64, end: f64) -> ErrorMeasures {
    let root_mean = |value: &dyn Fn(&(Parts, f64)) -> f64| {
        let each = |i: &SampledInterval| {
            let [a, m, b] = &i.samples;
            trapezoid(i.times[1] - i.times[0], value(a), i.single.then(|| value(m)), value(b))
        };
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

/// All intervals, far and near elements together.
fn intervals<const D: usize, const N: usize>(
    times: &TimeGrid,
    every: usize,
    last: usize,
    far: &FarSums,
    near: &[NearElement<D, N>],
) -> Vec<SampledInterval> {
    let mut levels: Vec<usize> = (0..=last).step_by(every).collect();
    if levels[levels.len() - 1] != last {
        levels.push(last);
    }
    let interval = |k: usize| {
        let mut samples = [far.levels[k], far.mids[k], far.levels[k + 1]].map(|far| (far, 0.0));
        for element in near {
            for (sum, sample) in samples.iter_mut().zip(&element.samples[k]) {
                sum.0.add(&sample.error);
                sum.1 += sample.contact;
            }
        }
        let parts = |(error, contact): (ElementError, f64)| {
            (Parts { kinetic: error.kinetic, elastic: error.elastic, contact }, error.reference + contact)
        };
        SampledInterval {
            times: [times.instants()[levels[k]], times.instants()[levels[k + 1]]],
            single: levels[k + 1] == levels[k] + 1,
            samples: samples.map(parts),
        }
    };
    (0..levels.len() - 1).map(interval).collect()
}

/// All samples in order of time; an instant appears twice where its two sides differ.
fn samples(intervals: &[SampledInterval]) -> Vec<Sample> {
    let mut samples: Vec<Sample> = Vec::with_capacity(2 * intervals.len() + 1);
    for interval in intervals {
        let [start, end] = interval.times;
        let times = [start, 0.5 * (start + end), end];
        for (k, (time, &(parts, reference))) in times.into_iter().zip(&interval.samples).enumerate() {
            let sample = Sample { time, parts, reference };
            let repeated = k == 0 && samples.last() == Some(&sample);
            if !repeated && (k != 1 || interval.single) {
                samples.push(sample);
            }
        }
    }
    samples
}
