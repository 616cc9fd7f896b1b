//! Which maps an estimate keeps.

use percute_core::time::TimeGrid;
use thiserror::Error;

/// Which maps an estimate keeps besides its sums. The default keeps none and costs nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Request {
    /// Steps at whose instants the contribution of every element is kept: increasing, and each one
    /// sampled: a multiple of [`Sampling::stride`](crate::Sampling::stride), or the last step of the time
    /// grid.
    pub steps: Vec<usize>,
    /// Whether the admissible fields are kept there too.
    pub fields: bool,
}

/// Why maps cannot be kept as requested.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[allow(missing_docs, reason = "the messages explain the fields")]
pub enum RequestError {
    /// A step beyond the last.
    #[error("a map was requested at step {step}, but the run has the steps 0 to {last}")]
    Beyond { step: usize, last: usize },
    /// Steps that do not increase.
    #[error("a map was requested at step {step} after one at step {before}; name each step once, in increasing order")]
    Order { step: usize, before: usize },
    /// A step at which the error is not sampled.
    #[error(
        "a map was requested at step {step}, but the error is sampled at every {every}th step and at the last only; \
         request one of these, or sample every step"
    )]
    NotSampled { step: usize, every: usize },
    /// More than memory can hold.
    #[error("{bytes} bytes for maps at {steps} steps cannot be allocated in memory; request fewer steps, or no fields")]
    Memory { bytes: usize, steps: usize },
}

impl Request {
    /// Maps without fields at no more than `count` sampled steps, spread evenly over the time from t_0 to T;
    /// `every` is the stride of the options. Fewer come where fewer are sampled, or where two of the
    /// times wanted have the same sampled step nearest to them. A single one is that at T.
    #[must_use]
    pub fn evenly(times: &TimeGrid, count: usize, every: usize) -> Self {
        let (instants, last) = (times.instants(), times.step_count());
        let sampled: Vec<usize> = (0..last).step_by(every.max(1)).chain([last]).collect();
        let nearest = |t: f64| {
            let after = sampled.partition_point(|&n| instants[n] < t).min(sampled.len() - 1);
            let before = after.saturating_sub(1);
            let closer = t - instants[sampled[before]] < instants[sampled[after]] - t;
            sampled[if closer { before } else { after }]
        };
        let mut steps: Vec<usize> = match count {
            0 => Vec::new(),
            1 => vec![last],
            _ if count >= sampled.len() => sampled,
            _ => (0..count).map(|k| nearest(times.end() * (k as f64 / (count - 1) as f64))).collect(),
        };
        steps.dedup();
        Self { steps, fields: false }
    }

    /// Refuses steps that no map can be kept at.
    pub(crate) fn check(&self, times: &TimeGrid, every: usize) -> Result<(), RequestError> {
        let last = times.step_count();
        for (k, &step) in self.steps.iter().enumerate() {
            if step > last {
                return Err(RequestError::Beyond { step, last });
            }
            if let Some(&before) = k.checked_sub(1).and_then(|k| self.steps.get(k)).filter(|&&before| before >= step) {
                return Err(RequestError::Order { step, before });
            }
            if step % every != 0 && step != last {
                return Err(RequestError::NotSampled { step, every });
            }
        }
        Ok(())
    }
}
