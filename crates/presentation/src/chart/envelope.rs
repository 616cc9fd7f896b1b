//! Curves that alternate from sample to sample: their range and their mean. As lines they are solid blocks.

/// A curve that turns more often is shown by its range.
const TURNS: usize = 250;
/// Range and mean are those of so many pieces of the samples, at most.
const PIECES: usize = 300;
/// Fewest samples of a piece: two periods of an alternation from sample to sample.
const SHORTEST: usize = 4;

/// The least value, the mean and the largest value around an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub(super) time: f64,
    pub(super) low: f64,
    pub(super) mean: f64,
    pub(super) high: f64,
}

/// The ranges of a curve that turns often, at the borders of its pieces; none of other curves, and where a value is not
/// finite.
pub(super) fn envelope(time: &[f64], values: &[f64]) -> Option<Vec<Range>> {
    let slopes: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|slope| *slope != 0.0).collect();
    let turns = slopes.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    if turns <= TURNS || time.len() != values.len() || !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    // An even number, so that a mean has as many samples from above as from below.
    let length = SHORTEST.max(2 * values.len().div_ceil(2 * PIECES));
    let starts: Vec<usize> = (0..=values.len() - length).step_by(length).collect();
    let piece = |k: usize| &values[starts[k]..starts.get(k + 1).copied().unwrap_or(values.len())];
    let at = |border: usize| {
        // Between two pieces, both count: the band then holds all samples, and neighbours share their ends.
        let [before, after] = [border.max(1) - 1, border.min(starts.len() - 1)].map(piece);
        let both = || before.iter().chain(after);
        Range {
            time: starts.get(border).map_or(time[time.len() - 1], |&start| time[start]),
            low: both().copied().fold(f64::INFINITY, f64::min),
            mean: both().sum::<f64>() / (before.len() + after.len()) as f64,
            high: both().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    };
    Some((0..=starts.len()).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_alternating_curve_has_its_range_and_its_mean() {
        let time: Vec<f64> = (0..10_001).map(f64::from).collect();
        // ±1 about a line that rises to 2.
        let values: Vec<f64> =
            (0..10_001).map(|n| f64::from(n) / 5000.0 + if n % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let found = envelope(&time, &values).unwrap();
        assert!(found.len() <= PIECES + 1 && found[0].time == 0.0 && found[found.len() - 1].time == 10_000.0);
        for range in &found {
            // A piece has 34 samples, over which the line rises by 0.0068, the last one up to 67: of an odd number, one
            // is without its opposite.
            let line = range.time / 5000.0;
            assert!((range.mean - line).abs() < 0.03, "{range:?}");
            assert!(range.low > line - 1.02 && range.low < line - 0.98 && range.high < line + 1.02, "{range:?}");
        }
        let inside = |n: usize| {
            let k = found.iter().position(|range| range.time > n as f64).unwrap_or(found.len() - 1);
            values[n] <= found[k - 1].high.max(found[k].high) && values[n] >= found[k - 1].low.min(found[k].low)
        };
        assert!((0..values.len()).all(inside));
    }

    #[test]
    fn smooth_curves_stay_lines() {
        let time: Vec<f64> = (0..1000).map(f64::from).collect();
        let values: Vec<f64> = time.iter().map(|t| (0.1 * t).sin()).collect();
        assert_eq!(envelope(&time, &values), None);
        assert_eq!((envelope(&[], &[]), envelope(&[0.0], &[1.0])), (None, None));
    }
}
