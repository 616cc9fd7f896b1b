//! Parts of the mesh that threads work on at the same time.
//!
//! The turns of a mesh are cut into chunks. First all chunks are worked on, each as far as it does not need the others.
//! Then the places where they meet are completed. The plan depends on the mesh alone, and one thread follows it as
//! well.

use super::blocks::Blocks;
use super::lanes::{FirstPair, Gradient, Nodal};
use super::{AuxiliaryLevel, MotionFields};
use std::array::from_fn;
use std::ops::Range;

/// The sweeps of a pass.
pub(super) const SWEEPS: usize = 5;
/// A chunk has at least so many turns: two meetings reach over `SWEEPS` turns each way …
const FEWEST: usize = 2 * SWEEPS;
/// … and there are at most so many chunks.
const MOST: usize = 16;

/// The turns of the sweeps of a pass in one part. A turn of a sweep comes after the next turn of the sweep before it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// The turns of each sweep over elements; of the first sweep those of even blocks.
    pub(super) sweeps: [Range<usize>; SWEEPS],
    /// The turns whose nodes are then finished; in the first sweep their odd blocks come before.
    pub(super) done: [Range<usize>; SWEEPS],
    /// The nodes that it touches.
    pub(super) nodes: Range<usize>,
    /// The blocks whose elements it touches.
    pub(super) blocks: Range<usize>,
}

impl Part {
    /// The turns of the first sweep at which a turn of any sweep is made, each sweep a turn behind the one before.
    pub(super) fn turns(&self) -> Range<usize> {
        let first = (0..SWEEPS).map(|k| self.sweeps[k].start.min(self.done[k].start) + k).min();
        first.unwrap_or(0)..self.done[SWEEPS - 1].end + SWEEPS - 1
    }
}

/// The parts of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// In order, without a common node.
    pub(super) chunks: Vec<Part>,
    /// The same, one fewer.
    pub(super) meetings: Vec<Part>,
}

impl Plan {
    pub(super) fn new(blocks: &Blocks) -> Self {
        Self::with_fewest(blocks, FEWEST)
    }

    /// That of chunks with at least so many turns, 10 or more.
    fn with_fewest(blocks: &Blocks, fewest: usize) -> Self {
        let turns = blocks.turns();
        // A power of two, so that threads have as many each.
        let count = 1 << (turns / fewest).clamp(1, MOST).ilog2();
        let cut = |k: usize| turns * k / count;
        let chunk = |k: usize| {
            let (start, end) = (cut(k), cut(k + 1));
            let from = |late: usize| if k == 0 { start } else { start + late };
            let to = |early: usize| if k + 1 == count { end } else { end - early };
            Part {
                sweeps: from_fn(|sweep| from(sweep)..to(sweep)),
                done: from_fn(|sweep| from(sweep + 1)..to(sweep)),
                nodes: blocks.begun(start).start..blocks.begun(end - 1).end,
                blocks: 2 * start..if k + 1 == count { blocks.count() } else { 2 * end - 1 },
            }
        };
        let meeting = |k: usize| {
            let (turn, last) = (cut(k), SWEEPS - 1);
            Part {
                sweeps: from_fn(|sweep| turn - sweep..turn + sweep),
                done: from_fn(|sweep| turn - sweep..turn + sweep + 1),
                nodes: blocks.finished(turn - last).start..blocks.finished(turn + last).end,
                blocks: 2 * (turn - last) - 1..(2 * (turn + last) + 1).min(blocks.count()),
            }
        };
        Self { chunks: (0..count).map(chunk).collect(), meetings: (1..count).map(meeting).collect() }
    }
}

/// All fields on consecutive nodes and elements.
#[derive(Debug)]
pub(super) struct View<'a, const D: usize> {
    pub(super) start: Start,
    pub(super) displacement: &'a mut [Nodal],
    pub(super) half_step: &'a mut [Nodal],
    pub(super) rate: &'a mut [Nodal],
    pub(super) internal: &'a mut [Nodal],
    /// The lumping difference once, twice and three times.
    pub(super) lumping: [&'a mut [FirstPair]; 3],
    pub(super) gradients: &'a mut [Gradient],
    pub(super) patches: &'a mut [Gradient],
    /// The fields of the auxiliary solution that are handed out.
    pub(super) level: AuxiliaryLevel<'a, D>,
}

/// The first node, the first place of a gradient and the first patch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Start {
    pub(super) node: usize,
    pub(super) gradient: usize,
    pub(super) patch: usize,
}

impl<'a, const D: usize> View<'a, D> {
    /// That of all nodes and elements.
    pub(super) fn new(fields: &'a mut MotionFields, level: AuxiliaryLevel<'a, D>) -> Self {
        let MotionFields { displacement, half_step, rate, internal, lumping, gradients, patches } = fields;
        let lumping = lumping.each_mut().map(|field| &mut field[..]);
        Self { start: Start::default(), displacement, half_step, rate, internal, lumping, gradients, patches, level }
    }

    /// The same for a shorter time.
    fn again(&mut self) -> View<'_, D> {
        View {
            start: self.start,
            displacement: self.displacement,
            half_step: self.half_step,
            rate: self.rate,
            internal: self.internal,
            lumping: self.lumping.each_mut().map(|field| &mut **field),
            gradients: self.gradients,
            patches: self.patches,
            level: self.level.again(),
        }
    }

    /// Cuts before another start.
    fn split(self, at: Start) -> (Self, Self) {
        let node = at.node - self.start.node;
        let (displacement, half_step) = (self.displacement.split_at_mut(node), self.half_step.split_at_mut(node));
        let (rate, internal) = (self.rate.split_at_mut(node), self.internal.split_at_mut(node));
        let [once, twice, thrice] = self.lumping.map(|field| field.split_at_mut(node));
        let gradients = self.gradients.split_at_mut(at.gradient - self.start.gradient);
        let patches = self.patches.split_at_mut(at.patch - self.start.patch);
        let level = self.level.split(node);
        (
            View {
                start: self.start,
                displacement: displacement.0,
                half_step: half_step.0,
                rate: rate.0,
                internal: internal.0,
                lumping: [once.0, twice.0, thrice.0],
                gradients: gradients.0,
                patches: patches.0,
                level: level.0,
            },
            View {
                start: at,
                displacement: displacement.1,
                half_step: half_step.1,
                rate: rate.1,
                internal: internal.1,
                lumping: [once.1, twice.1, thrice.1],
                gradients: gradients.1,
                patches: patches.1,
                level: level.1,
            },
        )
    }

    /// Where these nodes are.
    #[inline(always)]
    pub(super) fn local(&self, nodes: &Range<usize>) -> Range<usize> {
        nodes.start - self.start.node..nodes.end - self.start.node
    }
}

/// Where a part begins.
pub(super) type StartOf<'a> = &'a (dyn Fn(&Part) -> Start + Sync);

/// Does the work of all chunks and then of all meetings, at the same time in a pool of threads. Gives one sum for each
/// part.
pub(super) fn for_all<S: Send + Default + Clone, const D: usize>(
    (plan, start): (&Plan, StartOf<'_>),
    mut view: View<'_, D>,
    work: &(impl Fn(&Part, View<'_, D>) -> S + Sync),
) -> Vec<S> {
    let mut sums = vec![S::default(); plan.chunks.len() + plan.meetings.len()];
    let (chunks, meetings) = sums.split_at_mut(plan.chunks.len());
    for_each((&plan.chunks, start), view.again(), chunks, work);
    for_each((&plan.meetings, start), view, meetings, work);
    sums
}

fn for_each<S: Send, const D: usize>(
    (parts, start): (&[Part], StartOf<'_>),
    view: View<'_, D>,
    sums: &mut [S],
    work: &(impl Fn(&Part, View<'_, D>) -> S + Sync),
) {
    match parts {
        [] => (),
        [part] => sums[0] = work(part, view),
        _ => {
            let middle = parts.len() / 2;
            let (before, after) = parts.split_at(middle);
            let (left, right) = view.split(start(&after[0]));
            let (first, last) = sums.split_at_mut(middle);
            let first = || for_each((before, start), left, first, work);
            let last = || for_each((after, start), right, last, work);
            // Without a pool, rayon would start one of its own, with threads that a forked process does not have.
            if rayon::current_thread_index().is_some() {
                rayon::join(first, last);
            } else {
                first();
                last();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;

    /// Chunks and meetings do every turn of every sweep once, and none before those that it needs.
    #[test]
    fn a_plan_does_all_turns() {
        let mesh = Mesh::rectangle(1.0, 1.0, 2, 400).unwrap();
        let blocks = Blocks::with_fewest(&mesh, 1);
        let (turns, blocks_in_all) = (blocks.turns(), blocks.count());
        for fewest in [10, 13, 40, 1000] {
            let plan = Plan::with_fewest(&blocks, fewest);
            assert!(plan.chunks.len().is_power_of_two() && plan.meetings.len() + 1 == plan.chunks.len());
            let nodes = |parts: &[Part]| parts.windows(2).all(|two| two[0].nodes.end <= two[1].nodes.start);
            assert!(nodes(&plan.chunks) && nodes(&plan.meetings));
            let blocks = |parts: &[Part]| parts.windows(2).all(|two| two[0].blocks.end <= two[1].blocks.start);
            assert!(blocks(&plan.chunks) && blocks(&plan.meetings));
            let mut done = vec![[[0; 2]; SWEEPS]; turns];
            for part in plan.chunks.iter().chain(&plan.meetings) {
                let at_once = done.clone();
                for sweep in 0..SWEEPS {
                    part.sweeps[sweep].clone().for_each(|turn| done[turn][sweep][0] += 1);
                    part.done[sweep].clone().for_each(|turn| done[turn][sweep][1] += 1);
                }
                // A turn of a sweep needs those turns of the sweep before that its blocks share nodes with.
                for sweep in 1..SWEEPS {
                    for turn in part.sweeps[sweep].clone() {
                        let needed = turn..(turn + 2).min(turns);
                        assert!(needed.into_iter().all(|k| done[k][sweep - 1][1] == 1), "{sweep} of {turn}");
                    }
                    for turn in (0..turns).filter(|&k| done[k][sweep][1] > at_once[k][sweep][1]) {
                        assert!((turn.saturating_sub(1)..=turn).all(|k| done[k][sweep][0] == 1), "{sweep} of {turn}");
                    }
                }
                // Smoothed strains need the elements of the blocks beside, which belong to the part.
                let [first, .., last] = [part.sweeps[1].start, part.sweeps[1].end];
                if first < last {
                    let (first, last) = ((2 * first).saturating_sub(2), (2 * last).min(blocks_in_all));
                    assert!(part.blocks.start <= first && last <= part.blocks.end, "{part:?}");
                }
            }
            assert!(done.as_flattened().as_flattened().iter().all(|&count| count == 1), "{done:?}");
        }
    }
}
