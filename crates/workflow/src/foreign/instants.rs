//! Instants that are missing or doubled: the residual is at two or three instants alone.

use super::attempt::Attempt;
use super::diagnosis::Diagnosis;
use super::holding::{MOST, holding};
use crate::message::{times, trimmed};
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::time::TimeGrid;

/// Instants around a wrong step that have a residual.
const FEW: usize = 3;

/// The body rests in a step if it moves by less than this share of what it moves in the steps beside it.
const REST: f64 = 0.1;

/// A history with other instants, and perhaps without one of its own.
struct Retimed<'s> {
    source: &'s dyn StepSource,
    times: TimeGrid,
    left_out: Option<usize>,
}

impl StepSource for Retimed<'_> {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn count(&self) -> usize {
        self.source.count() - usize::from(self.left_out.is_some())
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        self.source.replay(&mut |step| {
            let index = match self.left_out {
                Some(out) if step.index == out => return Ok(()),
                Some(out) if step.index > out => step.index - 1,
                _ => step.index,
            };
            take(&Step { index, time: self.times.instants()[index], ..*step })
        })
    }
}

/// The step at which the residual is, with what the body moves in it over the mean of the steps beside it.
struct Jump {
    step: usize,
    way: f64,
}

/// An instant that is missing or doubled where the residual is.
pub(super) fn attempt(diagnosis: &Diagnosis<'_>) -> Result<Option<Attempt>, SinkError> {
    let (at, _) = holding(&diagnosis.evidence.residual.by_instant, MOST);
    let [Some(&first), Some(&last)] = [at.first(), at.last()] else { return Ok(None) };
    if last + 1 > first + FEW {
        return Ok(None);
    }
    let Some(Jump { step, way }) = jump(diagnosis.source, first, last)? else { return Ok(None) };
    let instants = diagnosis.source.times().instants();
    let told = |n: usize| format!("instant {n} ({} s)", trimmed(instants[n], 5));
    let (whole, place) = (way.round(), format!("between {} and {}", told(step), told(step + 1)));
    if way.abs() < REST {
        let text =
            format!("{} repeats the one before it: leave it out of all arrays but the last of `time`", told(step + 1));
        return retimed(diagnosis, instants[..instants.len() - 1].to_vec(), Some(step + 1), text).map(Some);
    }
    if whole >= 2.0 && (way - whole).abs() < 0.5 {
        let text = format!(
            "an instant is missing {place}: the body moves {} as far there as in the steps beside it",
            times(whole)
        );
        let longer = (whole - 1.0) * (instants[step + 1] - instants[step]);
        let later = instants.iter().enumerate().map(|(n, t)| if n > step { t + longer } else { *t });
        return retimed(diagnosis, later.collect(), None, text).map(Some);
    }
    Ok(None)
}

fn retimed(
    diagnosis: &Diagnosis<'_>,
    instants: Vec<f64>,
    left_out: Option<usize>,
    text: String,
) -> Result<Attempt, SinkError> {
    let times = TimeGrid::from_instants(instants)?;
    diagnosis.attempt(&Retimed { source: diagnosis.source, times, left_out }, 0, text)
}

/// The step whose motion differs most from that of the steps beside it, among those that change the balance at some
/// instants.
fn jump(source: &dyn StepSource, first: usize, last: usize) -> Result<Option<Jump>, SinkError> {
    let start = first.saturating_sub(2);
    let mut held: Vec<Vec<f64>> = Vec::new();
    source.replay(&mut |step| {
        if (start..=last + 2).contains(&step.index) {
            held.push(step.displacement.to_vec());
        }
        Ok(())
    })?;
    let times = source.times();
    let rates: Vec<Vec<f64>> = held
        .windows(2)
        .enumerate()
        .map(|(k, pair)| pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a) / times.step(start + k)).collect())
        .collect();
    let of = |(k, beside): (usize, &[Vec<f64>])| {
        let [along, own] = (0..beside[1].len()).fold([0.0; 2], |[along, own], at| {
            let mean = 0.5 * (beside[0][at] + beside[2][at]);
            [along + beside[1][at] * mean, own + mean * mean]
        });
        let step = start + k + 1;
        Jump { step, way: along / own }
    };
    let jumps = rates.windows(3).enumerate().map(of).filter(|jump| jump.way.is_finite());
    // Beside a step of rest, the others are twice as far as the mean of their neighbours.
    let odd = |jump: &Jump| jump.way.max(REST).ln().abs();
    Ok(jumps.max_by(|a, b| odd(a).total_cmp(&odd(b))))
}
