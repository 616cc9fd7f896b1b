//! All elements with a candidate node of contact, and their intervals that wait.
//!
//! The motion at a node is known when its next contact is, or at the end of the run. All near elements wait for the
//! node of which it is known last: their samples can then be summed at once, in the order of the elements. Work is done
//! in groups of blocks, in parallel within a group, so that memory holds one group at a time.

use super::backlog::{self, Backlog};
use super::maps::Maps;
use super::near::{ContactSampling, NearElement, near_count, near_elements};
use super::sampled_interval::SampledInterval;
use super::sampled_levels::SampledLevels;
use super::sampling::{ElementSample, SharedData};
use super::waiting;
use crate::kinematic::ContactMotions;
use crate::numbers::Reader;
use crate::scratch_file::{ScratchError, ScratchFile};
use crate::stress::ElementForm;
use percute_core::problem::Problem;
use percute_core::simd::lanes::LANES;
use rayon::prelude::*;
use std::ops::Range;

/// Elements of a block, and blocks of a group.
const BLOCK: usize = 16;
const GROUP: usize = 16;

/// The most bytes that near elements and their intervals take in memory, at so many samples, each so many steps after
/// the one before.
pub(super) fn memory<const D: usize, const N: usize>(problem: &Problem<D>, samples: usize, spacing: usize) -> usize {
    let (nodes, elements) = (problem.surface().nodes().len(), near_count(problem));
    let interval = bytes_of_interval::<D, N>(spacing);
    let (all, most) = (samples.saturating_mul(elements).saturating_mul(interval), backlog::most_bytes(nodes));
    // The memory of a group has room for more; what is in the file is read into another.
    let groups = (2 + usize::from(all > most)) * elements.min(BLOCK * GROUP) * LANES * interval;
    elements * (size_of::<NearElement<D, N>>() + ElementForm::memory::<D>())
        + all.min(most)
        + groups
        + ContactMotions::memory(problem, span(spacing))
}

/// Whether the intervals of a flight over the whole run have no room in memory.
pub(super) fn may_need_a_file<const D: usize, const N: usize>(
    problem: &Problem<D>,
    samples: usize,
    spacing: usize,
) -> bool {
    let all = samples.saturating_mul(near_count(problem)).saturating_mul(bytes_of_interval::<D, N>(spacing));
    all > backlog::most_bytes(problem.surface().nodes().len())
}

/// Numbers of an interval of so many steps, in bytes; the middle of a single step is sampled too.
fn bytes_of_interval<const D: usize, const N: usize>(spacing: usize) -> usize {
    size_of::<f64>() * (waiting::shortest::<D, N>() + usize::from(spacing == 1) * waiting::sample::<D, N>())
}

/// Half-step instants of the intervals that wait together.
pub(super) fn span(spacing: usize) -> usize {
    spacing.saturating_mul(2 * LANES)
}

/// All near elements.
#[derive(Debug)]
pub(super) struct NearElements<const D: usize, const N: usize> {
    pub(super) all: Vec<NearElement<D, N>>,
    backlog: Backlog,
    /// Memory for the numbers of the blocks of a group.
    buffers: Vec<Vec<f64>>,
}

impl<const D: usize, const N: usize> NearElements<D, N> {
    /// Those of a problem, of which no interval waits.
    pub(super) fn new(problem: &Problem<D>, file: ScratchFile) -> Self {
        let backlog = Backlog::new(problem.surface().nodes().len(), file);
        Self { all: near_elements(problem), backlog, buffers: vec![Vec::new(); GROUP] }
    }

    /// Takes in the intervals between consecutive levels, which have these numbers.
    pub(super) fn append(
        &mut self,
        shared: &SharedData<'_, '_, D, N>,
        levels: &SampledLevels<'_, D>,
        intervals: Range<usize>,
    ) -> Result<(), ScratchError> {
        if self.all.is_empty() || (intervals.is_empty() && levels.before.is_some()) {
            return Ok(());
        }
        self.backlog.begin(intervals);
        for group in self.all.chunks_mut(BLOCK * GROUP) {
            let blocks = group.par_chunks_mut(BLOCK).zip(&mut self.buffers);
            blocks.for_each(|(block, numbers)| {
                numbers.clear();
                block.iter_mut().for_each(|near| near.append(shared, levels, numbers));
            });
            let blocks = group.len().div_ceil(BLOCK);
            self.buffers[..blocks].iter_mut().try_for_each(|block| self.backlog.push(block))?;
        }
        Ok(())
    }

    /// The first intervals that wait together, if the motion of all nodes is known at their end.
    pub(super) fn first_known(&self, tracks: &ContactMotions, intervals: &[SampledInterval]) -> Option<Range<usize>> {
        let first = self.backlog.first()?;
        let stop = first.clone().last().map_or(0, |k| 2 * intervals[k].levels[1]);
        tracks.known().is_some_and(|known| stop < known).then_some(first)
    }

    /// Samples these intervals, the first that wait together, and adds the samples to them.
    pub(super) fn sample(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        intervals: &mut [SampledInterval],
    ) -> Result<(), ScratchError> {
        for (k, group) in self.all.chunks_mut(BLOCK * GROUP).enumerate() {
            let blocks = k * GROUP..k * GROUP + group.len().div_ceil(BLOCK);
            let numbers = self.backlog.blocks(blocks)?;
            let steps: Vec<_> = intervals.iter().map(|interval| interval.levels).collect();
            let sample = |(block, numbers): (&mut [NearElement<D, N>], &[f64])| -> Vec<[ElementSample; 3]> {
                let mut numbers = Reader::new(numbers);
                let mut samples = Vec::with_capacity(block.len() * steps.len());
                for near in block {
                    samples.extend(steps.iter().map(|&steps| near.sample(context, steps, &mut numbers)));
                }
                samples
            };
            let samples: Vec<_> = group.par_chunks_mut(BLOCK).zip(numbers).map(sample).collect();
            for element in samples.iter().flat_map(|samples| samples.chunks(steps.len().max(1))) {
                intervals.iter_mut().zip(element).for_each(|(interval, samples)| interval.add(samples));
            }
        }
        intervals.iter_mut().for_each(SampledInterval::complete);
        self.backlog.pop();
        Ok(())
    }

    /// The elements, of which no interval waits any more.
    pub(super) fn into_elements(self) -> Vec<NearElement<D, N>> {
        self.all
    }

    /// Puts the contributions to maps in their places.
    pub(super) fn put(&mut self, maps: &mut Maps) {
        self.all.iter_mut().for_each(|near| maps.put(&std::mem::take(&mut near.kept)));
    }

    /// The intervals that wait, for tests.
    #[cfg(test)]
    pub(super) fn backlog_mut(&mut self) -> &mut Backlog {
        &mut self.backlog
    }

    /// Bytes in memory that wait.
    #[cfg(test)]
    pub(super) fn held(&self) -> usize {
        let buffers: usize = self.buffers.iter().map(Vec::capacity).sum();
        self.backlog.held() + buffers * size_of::<f64>()
    }
}
