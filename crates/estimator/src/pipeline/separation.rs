//! The sources of η over the intervals of a run.

use super::sampled_interval::SampledInterval;
use crate::difference::Difference;
use crate::sources::{Separation, Sources, halved_elements};

/// The sources of a run whose η is largest at one time and that ends at another (s), with the differences at all
/// levels.
pub(super) fn separation(
    intervals: &[SampledInterval],
    differences: &[Difference],
    (time_of_sup, end): (f64, f64),
) -> Separation {
    let (mut over_time, mut at_sup) = (Vec::new(), Sources::default());
    let (mut mean, mut mean_difference) = (Sources::default(), Difference::default());
    for (i, interval) in intervals.iter().enumerate() {
        let [first, last] = interval.levels.map(|n| differences[n]);
        let differences = [first, first.mean(&last), last];
        let sources: [Sources; 3] = std::array::from_fn(|k| {
            let (parts, _) = &interval.samples[k];
            Sources::new(
                [parts.kinetic + parts.elastic + parts.dissipation, parts.contact],
                &interval.near[k],
                &differences[k],
            )
        });
        let (times, weights) = (interval.instants(), interval.weights());
        for k in 0..3 {
            mean.add(weights[k] / end, &sources[k]);
            mean_difference.add(weights[k] / end, &differences[k]);
            // With an auxiliary solution, η does not jump: an interval begins where the one before ends.
            if (k != 0 || i == 0) && (k != 1 || interval.is_single()) {
                over_time.push(sources[k]);
                if times[k] == time_of_sup {
                    at_sup = sources[k];
                }
            }
        }
    }
    let halved_elements = halved_elements(&mean, &mean_difference);
    Separation {
        at_sup,
        mean,
        halved_elements,
        halved_step: mean_difference.halved_step - mean_difference.energy,
        over_time,
    }
}
