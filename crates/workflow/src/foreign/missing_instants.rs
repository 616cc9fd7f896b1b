//! Long steps at whose ends alone the balance fails: instants were lost there.

use super::attempt::Attempt;
use super::diagnosis::Diagnosis;
use super::long_steps::LongSteps;
use crate::message::{numbered, times, trimmed};

/// Instants that were lost in long steps.
pub(super) fn attempt(diagnosis: &Diagnosis<'_>) -> Option<Attempt> {
    let (grid, residual) = (diagnosis.source.times(), &diagnosis.evidence.residual);
    let (long, sizes) = (LongSteps::of(grid, residual.by_instant.len()), &residual.largest_at);
    let level = long.level(sizes);
    let (lost, lengths): (Vec<usize>, Vec<f64>) =
        long.steps.iter().filter(|&&(n, _)| sizes[n].max(sizes[n + 1]) > level).copied().unzip();
    let told = |n: usize| format!("instant {n} ({} s)", trimmed(grid.instants()[n], 5));
    let text = match (lost.as_slice(), lengths.as_slice()) {
        ([], _) => return None,
        (&[n], &[length, ..]) => format!(
            "an instant is missing between {} and {}: that step is {} as long as those beside it",
            told(n),
            told(n + 1),
            times(length)
        ),
        _ => format!(
            "instants are missing after {}: these steps are {} as long as those beside them, or longer",
            numbered("instant", &lost),
            times(lengths.iter().copied().fold(f64::INFINITY, f64::min))
        ),
    };
    let share = |of: &dyn Fn(usize) -> bool| -> f64 {
        residual.by_instant.iter().enumerate().filter(|(n, _)| of(*n)).map(|(_, square)| square).sum()
    };
    let (others, all) = (share(&|n| !lost.iter().any(|&step| n == step || n == step + 1)), share(&|_| true));
    let before = diagnosis.residual();
    Some(Attempt { text, before, left: before * (others / all).sqrt() })
}
