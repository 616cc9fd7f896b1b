//! The gap that is left where nothing has touched.

use super::{ContactPoint, ContactSteps, NodeSummary};

/// The node of the contact surface that is nearest to its obstacle at the last instant of a run without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its place among the nodes of the contact surface.
    pub at: usize,
    /// Its gap (m), eq. \[3\].
    pub gap: f64,
    /// The first instant at which a gap would close at the speed of the last step (s); none if no node approaches.
    pub touch: Option<f64>,
}

impl Nearest {
    /// From the gaps (m) of all nodes at the last instant (s), and at the one before; none if no node faces anything.
    fn new((time, gaps): (f64, &[f64]), before: Option<(f64, &[f64])>) -> Option<Self> {
        let facing = gaps.iter().copied().enumerate().filter(|(_, gap)| gap.is_finite());
        let (at, gap) = facing.clone().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let closing = |(at, gap): (usize, f64)| {
            let (earlier, wider) = before?;
            let speed = (wider[at] - gap) / (time - earlier);
            // NaN, of a node that faced nothing before, is no speed.
            (speed > 0.0 && speed.is_finite()).then(|| time + gap.max(0.0) / speed)
        };
        Some(Self { at, gap, touch: facing.filter_map(closing).min_by(f64::total_cmp) })
    }

    /// From stored results; none if anything touched.
    #[must_use]
    pub fn of_steps(
        instants: &[f64],
        nodes: &[ContactPoint],
        summary: &[NodeSummary],
        steps: &ContactSteps,
    ) -> Option<Self> {
        let touched = summary.iter().any(|summary| summary.first_touch.is_some())
            || steps.force.iter().any(|force| *force != 0.0);
        let row = |back: usize| {
            let n = instants.len().checked_sub(back)?;
            Some((instants[n], &steps.gap[n * nodes.len()..(n + 1) * nodes.len()]))
        };
        Self::new(row(1)?, row(2)).filter(|_| !touched)
    }
}

/// The gaps of the last two instants, as long as nothing has touched.
#[derive(Clone, Debug, Default)]
pub(super) struct LastGaps {
    touched: bool,
    now: Option<(f64, Vec<f64>)>,
    before: Option<(f64, Vec<f64>)>,
}

impl LastGaps {
    /// Takes in the gaps (m) at an instant (s), unless something touches then or has touched before.
    pub(super) fn advance(&mut self, time: f64, touches: bool, gaps: impl Iterator<Item = f64>) {
        self.touched |= touches;
        if self.touched {
            (self.now, self.before) = (None, None);
            return;
        }
        let (_, mut row) = self.before.take().unwrap_or_default();
        row.clear();
        row.extend(gaps);
        self.before = self.now.replace((time, row));
    }

    /// The nearest node at the last instant.
    pub(super) fn nearest(&self) -> Option<Nearest> {
        let [now, before] = [&self.now, &self.before].map(|row| row.as_ref().map(|(time, gaps)| (*time, &gaps[..])));
        Nearest::new(now?, before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_gap_to_close_need_not_be_the_least() {
        let mut gaps = LastGaps::default();
        gaps.advance(0.0, false, [3.0, 8.0, f64::INFINITY].into_iter());
        assert_eq!(gaps.nearest(), Some(Nearest { at: 0, gap: 3.0, touch: None }));
        gaps.advance(1.0, false, [2.5, 4.0, 0.5].into_iter());
        // At 0.5 and 4 m/s, after 5 and after 1 s; the third node faced nothing before.
        assert_eq!(gaps.nearest(), Some(Nearest { at: 2, gap: 0.5, touch: Some(2.0) }));
        gaps.advance(2.0, false, [3.0, 5.0, f64::INFINITY].into_iter());
        assert_eq!(gaps.nearest(), Some(Nearest { at: 0, gap: 3.0, touch: None }));
        gaps.advance(3.0, true, [0.0, 5.0, 1.0].into_iter());
        gaps.advance(4.0, false, [1.0, 5.0, 1.0].into_iter());
        assert_eq!(gaps.nearest(), None);
    }
}
