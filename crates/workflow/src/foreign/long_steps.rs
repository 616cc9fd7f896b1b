//! Steps that are longer than those beside them, and the residual at their ends.

use percute_core::time::TimeGrid;

/// A long step is so many times as long as each of those beside it.
const LONG: f64 = 1.5;
/// The balance fails at the ends of a step if the residual there is so many times that of all other instants. Rounding
/// makes a smaller residual there.
const STANDS_OUT: f64 = 10.0;

/// The ends of long steps among some instants.
pub(super) struct LongSteps {
    /// The steps, with their length over that of the longer step beside them.
    pub(super) steps: Vec<(usize, f64)>,
    /// Whether each instant is at the end of one.
    ends: Vec<bool>,
}

impl LongSteps {
    /// Of the first instants, so many; none if most of them are ends of long steps.
    pub(super) fn of(grid: &TimeGrid, count: usize) -> Self {
        let length = |n: usize| {
            let beside = [n.checked_sub(1), Some(n + 1).filter(|&n| n + 1 < count)];
            grid.step(n) / beside.into_iter().flatten().map(|n| grid.step(n)).fold(0.0, f64::max)
        };
        let steps = (0..count.saturating_sub(1)).map(|n| (n, length(n)));
        let steps: Vec<_> = steps.filter(|(_, length)| length.is_finite() && *length >= LONG).collect();
        let mut ends = vec![false; count];
        steps.iter().for_each(|&(n, _)| ends[n..n + 2].fill(true));
        if 2 * ends.iter().filter(|end| **end).count() > count {
            return Self { steps: Vec::new(), ends: vec![false; count] };
        }
        Self { steps, ends }
    }

    /// What stands out at each instant of a residual (N).
    pub(super) fn level(&self, residual: &[f64]) -> f64 {
        let others = residual.iter().zip(&self.ends).filter(|(_, end)| !**end);
        STANDS_OUT * others.map(|(size, _)| *size).fold(0.0, f64::max)
    }
}

/// The largest residual at the ends of long steps, less ten times that of all other instants (N).
pub(super) fn at_long_steps(grid: &TimeGrid, residual: &[f64]) -> f64 {
    let long = LongSteps::of(grid, residual.len());
    let ends = residual.iter().zip(&long.ends).filter(|(_, end)| **end);
    (ends.map(|(size, _)| *size).fold(0.0, f64::max) - long.level(residual)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The figure of steps (s) with a residual of 1 N at these instants, and of 0.01 N at all others.
    fn figure(steps: &[f64], at: &[usize]) -> f64 {
        let grid = TimeGrid::from_steps(steps).unwrap();
        let residual: Vec<f64> = (0..=steps.len()).map(|n| if at.contains(&n) { 1.0 } else { 0.01 }).collect();
        at_long_steps(&grid, &residual)
    }

    #[test]
    fn residuals_at_the_ends_of_long_steps_stand_out() {
        let steps = |long: &[usize], length: f64| -> Vec<f64> {
            (0..20).map(|n| if long.contains(&n) { length } else { 1.0 }).collect()
        };
        // 1 N less ten times 0.01 N.
        for (long, at) in
            [(&[7][..], &[7][..]), (&[7], &[8]), (&[3, 12], &[3, 4, 12, 13]), (&[0], &[1]), (&[19], &[19])]
        {
            assert!((figure(&steps(long, 2.0), at) - 0.9).abs() < 1e-12, "{long:?}");
        }
        // Elsewhere, at a step that is hardly longer, at a change of the step, and where most steps are long.
        for (steps, at) in [
            (steps(&[7], 2.0), &[7, 10][..]),
            (steps(&[7], 1.4), &[7]),
            ((0..20).map(|n| if n < 10 { 1.0 } else { 2.0 }).collect(), &[10]),
            ((0..20).map(|n| 1.0 + (n % 2) as f64).collect(), &[10]),
        ] {
            assert_eq!(figure(&steps, at), 0.0, "{steps:?}");
        }
    }
}
