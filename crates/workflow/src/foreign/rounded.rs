//! Displacements that are rounded to a few digits, as in a text file.

use super::diagnosis::Diagnosis;
use crate::message::percent;
use percute_core::dynamics::critical_time_step;
use percute_core::history::SinkError;

/// With more digits, the second differences of displacements are good enough.
const MOST_DIGITS: usize = 8;
/// Displacements that are looked at, at some instants spread over the history.
const INSTANTS: usize = 16;
const VALUES: usize = 2000;

/// The number of digits, if their rounding is as large as the residual.
pub(super) fn rounded(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    let (mut digits, mut largest) = (1, 0.0_f64);
    let every = diagnosis.source.count().div_ceil(INSTANTS).max(1);
    diagnosis.source.replay(&mut |step| {
        if step.index.is_multiple_of(every) && digits <= MOST_DIGITS {
            for &value in step.displacement.iter().take(VALUES) {
                largest = largest.max(value.abs());
                while digits <= MOST_DIGITS && !has(value, digits) {
                    digits += 1;
                }
            }
        }
        Ok(())
    })?;
    if digits > MOST_DIGITS || largest == 0.0 {
        return Ok(None);
    }
    let (times, critical) = (diagnosis.source.times(), critical_time_step(diagnosis.problem));
    let shortest = (0..times.step_count()).map(|n| times.step(n)).fold(f64::INFINITY, f64::min);
    // Half of the last digit of the largest displacement, in the second difference and in the forces inside.
    let half = 0.5 * 10f64.powi(largest.log10().floor() as i32 + 1 - digits as i32);
    let mass = diagnosis.problem.mass().iter().fold(0.0_f64, |most, mass| most.max(*mass));
    let force = 4.0 * half * mass * (1.0 / (shortest * shortest) + 1.0 / (critical * critical));
    let residual = &diagnosis.evidence.residual;
    let effect = residual.relative() * force / residual.worst.size;
    Ok((force >= residual.worst.size).then(|| {
        format!(
            "the displacements are rounded to about {digits} digits, which alone can make a residual of {}: write \
             them with {} digits or more",
            percent(effect.min(1.0)),
            MOST_DIGITS + 1
        )
    }))
}

/// Whether a number has no more significant decimal digits.
fn has(value: f64, digits: usize) -> bool {
    format!("{value:.*e}", digits - 1).parse() == Ok(value)
}

#[cfg(test)]
mod tests {
    use super::has;

    #[test]
    fn digits_are_counted() {
        assert!(has(1.2345e-6, 5) && !has(1.2345e-6, 4) && has(0.0, 1) && has(-400.0, 1) && !has(1.0 / 3.0, 8));
    }
}
