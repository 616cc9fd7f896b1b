//! Sums over elements and time, in a fixed order.

use super::near::{NearElement, NearInterval};
use super::prepare::Preparation;
use crate::estimate::{ErrorMeasures, Estimate, Parts, Sample};
use crate::measure::ElementError;
use crate::residual::Residuals;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// Sums over far elements at the levels and at the knots between them.
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

/// Trapezoidal integral over an interval, with or without a sample in its middle.
#[inline]
pub(crate) fn trapezoid(length: f64, start: f64, middle: Option<f64>, end: f64) -> f64 {
    match middle {
        Some(middle) => 0.25 * length * (start + 2.0 * middle + end),
        None => 0.5 * length * (start + end),
    }
}

/// One interval between sampled levels.
struct Interval {
    /// Times of its beginning and end (s).
    times: [f64; 2],
    /// Whether its middle is sampled.
    single: bool,
    /// Parts and d at beginning, middle, end.
    samples: [(Parts, f64); 3],
}

/// The estimate, from everything that was summed.
pub(crate) fn estimate<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    times: &TimeGrid,
    preparation: Preparation<'_, D, N>,
    far: FarSums,
    near: &[NearElement<D, N>],
    progress: &[(f64, f64)],
    mut residuals: Residuals,
) -> Estimate {
    let last = preparation.count() - 1;
    let end = times.instants()[last];
    let intervals = intervals(times, preparation.every(), last, &far, near);
    let mut integral = progress.iter().map(|p| p.0).collect::<Vec<_>>();
    for element in near {
        integral[element.element.index()] = near_integral(&intervals, &element.intervals);
        residuals.merge(&element.residuals);
    }
    preparation.tracks().iter().for_each(|track| track.report(&mut residuals));
    residuals.merge(&preparation.residuals);

    let over_time = samples(&intervals);
    let worst = over_time.iter().fold(over_time[0], |a, b| if b.parts.total() > a.parts.total() { *b } else { a });
    let mean = |value: &dyn Fn(&(Parts, f64)) -> f64| {
        let each = |i: &Interval| {
            let [a, m, b] = &i.samples;
            trapezoid(i.times[1] - i.times[0], value(a), i.single.then(|| value(m)), value(b))
        };
        (intervals.iter().map(each).sum::<f64>() / end).sqrt()
    };
    let (sup, mean_error) = (worst.parts.total().sqrt(), mean(&|s| s.0.total()));
    let reference_sup = over_time.iter().fold(0.0_f64, |m, s| m.max(s.reference)).sqrt();
    let reference_mean = mean(&|s| s.1);
    let (kept, whole) = preparation.impulse;
    Estimate {
        error: ErrorMeasures {
            sup,
            mean: mean_error,
            relative_sup: ratio(sup, reference_sup),
            relative_mean: ratio(mean_error, reference_mean),
            reference_sup,
            reference_mean,
        },
        time_of_sup: worst.time,
        parts: worst.parts,
        over_time,
        by_element: integral.into_iter().map(|i| (i / end).sqrt()).collect(),
        residuals,
        kept_impulse: (!problem.obstacles().is_empty() && whole > 0.0).then(|| kept / whole),
        given: preparation.given(),
        steps: last,
        end,
    }
}

/// All intervals, far and near elements together.
fn intervals<const D: usize, const N: usize>(
    times: &TimeGrid,
    every: usize,
    last: usize,
    far: &FarSums,
    near: &[NearElement<D, N>],
) -> Vec<Interval> {
    let mut levels: Vec<usize> = (0..=last).step_by(every).collect();
    if levels[levels.len() - 1] != last {
        levels.push(last);
    }
    let interval = |k: usize| {
        let mut samples = [far.levels[k], far.mids[k], far.levels[k + 1]].map(|far| (far, 0.0));
        for element in near {
            let NearInterval { errors, contact } = &element.intervals[k];
            for ((sum, error), contact) in samples.iter_mut().zip(errors).zip(contact) {
                sum.0.add(error);
                sum.1 += contact;
            }
        }
        let parts = |(error, contact): (ElementError, f64)| {
            (Parts { kinetic: error.kinetic, elastic: error.elastic, contact }, error.reference + contact)
        };
        Interval {
            times: [times.instants()[levels[k]], times.instants()[levels[k + 1]]],
            single: levels[k + 1] == levels[k] + 1,
            samples: samples.map(parts),
        }
    };
    (0..levels.len() - 1).map(interval).collect()
}

/// ∫η_E dt of a near element.
fn near_integral(intervals: &[Interval], own: &[NearInterval]) -> f64 {
    let each = |(interval, near): (&Interval, &NearInterval)| {
        let value = |k: usize| near.errors[k].total() + near.contact[k];
        let length = interval.times[1] - interval.times[0];
        trapezoid(length, value(0), interval.single.then(|| value(1)), value(2))
    };
    intervals.iter().zip(own).map(each).sum()
}

/// All samples in order of time; an instant appears twice where its two sides differ.
fn samples(intervals: &[Interval]) -> Vec<Sample> {
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

fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}
