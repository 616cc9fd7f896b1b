//! Far and near elements together, interval by interval.

use super::sampling::{ElementSample, trapezoid};
use crate::estimate::{Parts, Sample};
use crate::measure::ElementError;
use crate::sources::NearParts;
use percute_core::time::TimeGrid;

/// One interval between sampled levels.
#[derive(Debug)]
pub(super) struct SampledInterval {
    /// Times of its beginning and end (s).
    pub(super) times: [f64; 2],
    /// Steps there.
    pub(super) levels: [usize; 2],
    /// Whether its middle has values: it is a single step, or they were estimated.
    has_middle: bool,
    /// Parts and d at beginning, middle, end; d without the contact part until the interval is complete.
    pub(super) samples: [(Parts, f64); 3],
    /// The near elements there.
    pub(super) near: [NearParts; 3],
}

impl SampledInterval {
    /// An interval between these steps, with the sums over far elements at its beginning, middle and end.
    pub(super) fn new(times: &TimeGrid, levels: [usize; 2], far: [ElementError; 3]) -> Self {
        let parts = |far: ElementError| Parts {
            kinetic: far.kinetic,
            elastic: far.elastic,
            dissipation: far.plastic,
            contact: 0.0,
        };
        Self {
            times: levels.map(|n| times.instants()[n]),
            levels,
            has_middle: levels[1] == levels[0] + 1,
            samples: far.map(|far| (parts(far), far.reference)),
            near: [NearParts::default(); 3],
        }
    }

    /// Adds a near element.
    pub(super) fn add(&mut self, samples: &[ElementSample; 3]) {
        for (((parts, reference), near), sample) in self.samples.iter_mut().zip(&mut self.near).zip(samples) {
            parts.kinetic += sample.error.kinetic;
            parts.elastic += sample.error.elastic;
            parts.dissipation += sample.error.plastic;
            *reference += sample.error.reference;
            parts.contact += sample.contact.total;
            near.misfit += sample.error.total();
            near.front += sample.contact.normal_work;
        }
    }

    /// Takes in that there are no more near elements.
    pub(super) fn complete(&mut self) {
        self.samples.iter_mut().for_each(|(parts, reference)| *reference += parts.contact);
    }

    /// Whether its middle is sampled.
    pub(super) fn is_single(&self) -> bool {
        self.levels[1] == self.levels[0] + 1
    }

    /// Times of its beginning, middle and end (s).
    pub(super) fn instants(&self) -> [f64; 3] {
        let [start, end] = self.times;
        [start, 0.5 * (start + end), end]
    }

    /// The trapezoidal integral of a number over it.
    pub(super) fn integral(&self, value: impl Fn(usize) -> f64) -> f64 {
        let middle = self.has_middle.then(|| value(1));
        trapezoid(self.times[1] - self.times[0], value(0), middle, value(2))
    }

    /// The weights of the three samples in this integral (s).
    pub(super) fn weights(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.integral(|at| f64::from(u8::from(at == k))))
    }
}

/// η in the middle of a step differs from the mean of both ends by at most this part of it: where only the steps of an
/// onset are intervals of their own, they stand for no others.
const MOST_DEVIATION: f64 = 0.03;

/// Gives the middles of longer intervals values, where some steps are intervals of their own: the mean of both ends,
/// less or more by the part by which η in the middle of these steps differs from it on average. Returns the factor by
/// which this changes ∫η dt.
///
/// Half way between two instants the stress is the mean of both, and η is smaller by the energy of half their
/// difference. Without this, the mean of a body that arrives gradually is up to 1 % larger.
pub(super) fn estimate_middles(intervals: &mut [SampledInterval]) -> f64 {
    let total = |interval: &SampledInterval, k: usize| interval.samples[k].0.total();
    let sum = |intervals: &[SampledInterval]| -> f64 { intervals.iter().map(|i| i.integral(|k| total(i, k))).sum() };
    let plain = sum(intervals);
    let [mut deviation, mut whole] = [0.0; 2];
    for interval in intervals.iter().filter(|interval| interval.is_single()) {
        let mean = 0.5 * (total(interval, 0) + total(interval, 2));
        let length = interval.times[1] - interval.times[0];
        let limit = MOST_DEVIATION * mean;
        // Without `clamp`, which refuses the numbers of an overflow.
        deviation += length * (total(interval, 1) - mean).min(limit).max(-limit);
        whole += length * mean;
    }
    if !(plain > 0.0 && whole > 0.0) {
        return 1.0;
    }
    let factor = 1.0 + deviation / whole;
    for interval in intervals.iter_mut().filter(|interval| !interval.is_single()) {
        let ([(start, d_start), _, (end, d_end)], [near_start, _, near_end]) = (interval.samples, interval.near);
        interval.samples[1] = (Parts::mean(&start, &end).scaled(factor), 0.5 * (d_start + d_end));
        interval.near[1] = NearParts::mean(&near_start, &near_end).scaled(factor);
        interval.has_middle = true;
    }
    sum(intervals) / plain
}

/// All samples in order of time; an instant appears twice where its two sides differ.
pub(super) fn samples(intervals: &[SampledInterval]) -> Vec<Sample> {
    let mut samples: Vec<Sample> = Vec::with_capacity(2 * intervals.len() + 1);
    for interval in intervals {
        for (k, (time, &(parts, reference))) in interval.instants().into_iter().zip(&interval.samples).enumerate() {
            let sample = Sample { time, parts, reference };
            let repeated = k == 0 && samples.last() == Some(&sample);
            if !repeated && (k != 1 || interval.is_single()) {
                samples.push(sample);
            }
        }
    }
    samples
}
