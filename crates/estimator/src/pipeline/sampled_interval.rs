//! Far and near elements together, interval by interval.

use super::far::FarSums;
use super::near::NearElement;
use super::sampling::trapezoid;
use crate::estimate::{Parts, Sample};
use crate::measure::ElementError;
use crate::sources::NearParts;
use percute_core::time::TimeGrid;

/// One interval between sampled levels.
pub(super) struct SampledInterval {
    /// Times of its beginning and end (s).
    pub(super) times: [f64; 2],
    /// Steps there.
    pub(super) levels: [usize; 2],
    /// Parts and d at beginning, middle, end.
    pub(super) samples: [(Parts, f64); 3],
    /// The near elements there.
    pub(super) near: [NearParts; 3],
}

impl SampledInterval {
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
        let middle = self.is_single().then(|| value(1));
        trapezoid(self.times[1] - self.times[0], value(0), middle, value(2))
    }

    /// The weights of the three samples in this integral (s).
    pub(super) fn weights(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.integral(|at| f64::from(u8::from(at == k))))
    }
}

/// All intervals, far and near elements together.
pub(super) fn intervals<const D: usize, const N: usize>(
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
        let mut parts_of_near = [NearParts::default(); 3];
        for element in near {
            for ((sum, near), sample) in samples.iter_mut().zip(&mut parts_of_near).zip(&element.samples[k]) {
                sum.0.add(&sample.error);
                sum.1 += sample.contact.total;
                near.misfit += sample.error.total();
                near.front += sample.contact.normal_work;
            }
        }
        let parts = |(error, contact): (ElementError, f64)| {
            (Parts { kinetic: error.kinetic, elastic: error.elastic, contact }, error.reference + contact)
        };
        SampledInterval {
            times: [times.instants()[levels[k]], times.instants()[levels[k + 1]]],
            levels: [levels[k], levels[k + 1]],
            samples: samples.map(parts),
            near: parts_of_near,
        }
    };
    (0..levels.len() - 1).map(interval).collect()
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
