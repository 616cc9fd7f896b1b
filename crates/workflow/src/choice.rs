//! A choice of steps out of those of a run or a history.

use crate::message::trimmed;

/// A choice of steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum StepChoice {
    /// All steps.
    #[default]
    All,
    /// These steps, counted from 0; negative ones from the end, -1 is the last.
    Steps(Vec<i64>),
    /// Every k-th step, and the last.
    Every(usize),
    /// The steps nearest to these times (s).
    Times(Vec<f64>),
}

impl StepChoice {
    /// The chosen steps of these instants (s), ascending.
    ///
    /// # Errors
    /// A step or a time after the last.
    pub fn of(&self, instants: &[f64]) -> Result<Vec<usize>, String> {
        let last = instants.len().saturating_sub(1);
        let mut steps: Vec<usize> = match self {
            Self::All => return Ok((0..=last).collect()),
            Self::Every(k) => (0..last).step_by((*k).max(1)).chain([last]).collect(),
            Self::Steps(steps) => {
                let place = |step: &i64| {
                    let from_the_start = if *step < 0 { *step + instants.len() as i64 } else { *step };
                    let found = usize::try_from(from_the_start).ok().filter(|found| *found <= last);
                    let told = || {
                        format!(
                            "step {step} is not there: the last is step {last}; count from 0, or from the end with -1"
                        )
                    };
                    found.ok_or_else(told)
                };
                steps.iter().map(place).collect::<Result<_, _>>()?
            }
            Self::Times(times) => {
                let end = instants.last().copied().unwrap_or(0.0);
                if let Some(time) = times.iter().find(|time| late(**time, end)) {
                    return Err(format!("a time {}", too_late(*time, end)));
                }
                let all: Vec<usize> = (0..=last).collect();
                times.iter().map(|&t| nearest(instants, &all, t)).collect()
            }
        };
        steps.sort_unstable();
        steps.dedup();
        Ok(steps)
    }
}

/// The step nearest to an instant (s) among some steps, the earlier of two.
pub(crate) fn nearest(instants: &[f64], steps: &[usize], t: f64) -> usize {
    let after = steps.partition_point(|&n| instants[n] < t).min(steps.len() - 1);
    let before = after.saturating_sub(1);
    let distance = |i: usize| (instants[steps[i]] - t).abs();
    steps[if distance(before) <= distance(after) { before } else { after }]
}

/// Whether an instant comes after the end (s), beyond the digits that a printed end lacks.
pub(crate) fn late(time: f64, end: f64) -> bool {
    time > end * (1.0 + 1e-3)
}

/// The fault of an instant after the end (s).
pub(crate) fn too_late(time: f64, end: f64) -> String {
    format!("is {time} s, but the run ends at {} s; give instants before that, in seconds", trimmed(end, 5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_chosen_once_in_order() {
        let instants = [0.0, 1.0, 2.5, 3.0, 4.0];
        let of = |choice: StepChoice| choice.of(&instants);
        assert_eq!(of(StepChoice::All), Ok(vec![0, 1, 2, 3, 4]));
        assert_eq!(of(StepChoice::Every(3)), Ok(vec![0, 3, 4]));
        assert_eq!(of(StepChoice::Every(9)), Ok(vec![0, 4]));
        assert_eq!(of(StepChoice::Steps(vec![4, 1, 4])), Ok(vec![1, 4]));
        assert_eq!(of(StepChoice::Steps(vec![-1, 0, -5])), Ok(vec![0, 4]));
        assert!(of(StepChoice::Steps(vec![-6])).is_err_and(|told| told.contains("step -6 is not there")));
        assert_eq!(of(StepChoice::Times(vec![2.0, 1.7, 4.001])), Ok(vec![1, 2, 4]));
        assert!(of(StepChoice::Steps(vec![5])).is_err_and(|told| told.contains("last is step 4")));
        assert!(of(StepChoice::Times(vec![5.0])).is_err_and(|told| told.contains("ends at 4 s")));
    }
}
