//! Sampled levels that are worked on together, and the intervals between them.

use crate::traction::{EquilibratedLevel, EquilibratedLevels};

/// Some consecutive sampled levels of a run.
pub(super) struct SampledLevels<'a, const D: usize> {
    /// The level before them, unless they are the first.
    pub(super) before: Option<EquilibratedLevel<'a, D>>,
    pub(super) levels: &'a EquilibratedLevels<D>,
}

impl<'a, const D: usize> SampledLevels<'a, D> {
    /// The level before one of them.
    pub(super) fn before(&self, lane: usize) -> Option<EquilibratedLevel<'a, D>> {
        lane.checked_sub(1).map_or(self.before, |k| Some(self.levels.level(k)))
    }

    /// Whether one of them ends an interval of a single step, whose middle is sampled.
    pub(super) fn is_single(&self, lane: usize) -> bool {
        let end = &self.levels.forces()[lane];
        end.mid_velocity.is_some() && self.before(lane).is_some_and(|before| end.level.index == before.index() + 1)
    }

    /// The intervals: both levels of each.
    pub(super) fn intervals(&self) -> impl Iterator<Item = [EquilibratedLevel<'a, D>; 2]> {
        (0..self.levels.len()).filter_map(|lane| self.before(lane).map(|before| [before, self.levels.level(lane)]))
    }
}
