//! Parts of the mesh that threads work on at the same time.
//!
//! The turns of a mesh are cut into chunks. First all chunks are worked on, each as far as it does not need the others.
//! Then the places where they meet are completed. The plan depends on the mesh alone, and one thread follows it as
//! well.

use super::blocks::Blocks;
use super::lanes::{FirstPair, Nodal};
use super::{AuxiliaryLevel, Fields};
use std::ops::Range;

/// A chunk has at least so many turns: two meetings reach over five turns each way …
const FEWEST: usize = 10;
/// … and there are at most so many chunks.
const MOST: usize = 16;

/// The turns of the sweeps of a pass in one part. A turn of the second sweep comes after the next turn of the first
/// one, and a turn of the third sweep after the next turn of the second one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// Even blocks of the first sweep.
    pub(super) even: Range<usize>,
    /// Odd blocks of the first sweep; their turns are then finished.
    pub(super) odd: Range<usize>,
    /// Blocks of the second sweep.
    pub(super) second: Range<usize>,
    /// Turns that are finished by it.
    pub(super) second_done: Range<usize>,
    /// Blocks of the third sweep.
    pub(super) third: Range<usize>,
    /// Turns that are finished by it.
    pub(super) third_done: Range<usize>,
    /// The nodes that it touches.
    pub(super) nodes: Range<usize>,
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
                even: start..end,
                odd: from(1)..end,
                second: from(1)..to(1),
                second_done: from(2)..to(1),
                third: from(2)..to(2),
                third_done: from(3)..to(2),
                nodes: blocks.begun(start).start..blocks.begun(end - 1).end,
            }
        };
        let meeting = |k: usize| {
            let turn = cut(k);
            Part {
                even: turn..turn,
                odd: turn..turn + 1,
                second: turn - 1..turn + 1,
                second_done: turn - 1..turn + 2,
                third: turn - 2..turn + 2,
                third_done: turn - 2..turn + 3,
                nodes: blocks.finished(turn - 2).start..blocks.finished(turn + 2).end,
            }
        };
        Self { chunks: (0..count).map(chunk).collect(), meetings: (1..count).map(meeting).collect() }
    }
}

/// All nodal fields on consecutive nodes from `start` on.
#[derive(Debug)]
pub(super) struct View<'a, const D: usize> {
    pub(super) start: usize,
    pub(super) displacement: &'a mut [Nodal],
    pub(super) half_step: &'a mut [Nodal],
    pub(super) rate: &'a mut [Nodal],
    pub(super) internal: &'a mut [Nodal],
    pub(super) once: &'a mut [FirstPair],
    pub(super) twice: &'a mut [FirstPair],
    /// The fields of the auxiliary solution that are handed out.
    pub(super) level: AuxiliaryLevel<'a, D>,
}

impl<'a, const D: usize> View<'a, D> {
    /// That of all nodes.
    pub(super) fn new(fields: &'a mut Fields, level: AuxiliaryLevel<'a, D>) -> Self {
        let Fields { displacement, half_step, rate, internal, once, twice, .. } = fields;
        Self { start: 0, displacement, half_step, rate, internal, once, twice, level }
    }

    /// The same for a shorter time.
    fn again(&mut self) -> View<'_, D> {
        View {
            start: self.start,
            displacement: self.displacement,
            half_step: self.half_step,
            rate: self.rate,
            internal: self.internal,
            once: self.once,
            twice: self.twice,
            level: self.level.again(),
        }
    }

    /// Cuts before a node.
    fn split(self, node: usize) -> (Self, Self) {
        let at = node - self.start;
        let (displacement, half_step) = (self.displacement.split_at_mut(at), self.half_step.split_at_mut(at));
        let (rate, internal) = (self.rate.split_at_mut(at), self.internal.split_at_mut(at));
        let (once, twice) = (self.once.split_at_mut(at), self.twice.split_at_mut(at));
        let level = self.level.split(at);
        (
            View {
                start: self.start,
                displacement: displacement.0,
                half_step: half_step.0,
                rate: rate.0,
                internal: internal.0,
                once: once.0,
                twice: twice.0,
                level: level.0,
            },
            View {
                start: node,
                displacement: displacement.1,
                half_step: half_step.1,
                rate: rate.1,
                internal: internal.1,
                once: once.1,
                twice: twice.1,
                level: level.1,
            },
        )
    }

    /// Where these nodes are.
    #[inline(always)]
    pub(super) fn local(&self, nodes: &Range<usize>) -> Range<usize> {
        nodes.start - self.start..nodes.end - self.start
    }
}

/// Does the work of all chunks and then of all meetings, at the same time in a pool of threads. Gives one sum for each
/// part.
pub(super) fn for_all<S: Send + Default + Clone, const D: usize>(
    plan: &Plan,
    mut view: View<'_, D>,
    work: &(impl Fn(&Part, View<'_, D>) -> S + Sync),
) -> Vec<S> {
    let mut sums = vec![S::default(); plan.chunks.len() + plan.meetings.len()];
    let (chunks, meetings) = sums.split_at_mut(plan.chunks.len());
    for_each(&plan.chunks, view.again(), chunks, work);
    for_each(&plan.meetings, view, meetings, work);
    sums
}

fn for_each<S: Send, const D: usize>(
    parts: &[Part],
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
            let (left, right) = view.split(after[0].nodes.start);
            let (first, last) = sums.split_at_mut(middle);
            let (first, last) = (|| for_each(before, left, first, work), || for_each(after, right, last, work));
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
    use percute_core::mesh::TriangleMesh;

    /// Chunks and meetings do every turn of every sweep once, and none before those that it needs.
    #[test]
    fn a_plan_does_all_turns() {
        let mesh = TriangleMesh::rectangle(1.0, 1.0, 2, 400).unwrap();
        let blocks = Blocks::with_fewest(mesh.cells(), mesh.node_count(), 1);
        let turns = blocks.turns();
        for fewest in [10, 13, 40, 1000] {
            let plan = Plan::with_fewest(&blocks, fewest);
            assert!(plan.chunks.len().is_power_of_two() && plan.meetings.len() + 1 == plan.chunks.len());
            let nodes = |parts: &[Part]| parts.windows(2).all(|two| two[0].nodes.end <= two[1].nodes.start);
            assert!(nodes(&plan.chunks) && nodes(&plan.meetings));
            let mut done = vec![[0; 6]; turns];
            for part in plan.chunks.iter().chain(&plan.meetings) {
                let at_once = done.clone();
                let all = [&part.even, &part.odd, &part.second, &part.second_done, &part.third, &part.third_done];
                for (stage, range) in all.into_iter().enumerate() {
                    range.clone().for_each(|turn| done[turn][stage] += 1);
                }
                // A turn of a stage needs those turns of the stages before that its blocks share nodes with.
                for (stage, needs, range) in [(2, 1, &part.second), (4, 3, &part.third)] {
                    for turn in range.clone() {
                        let needed = turn..(turn + 2).min(turns);
                        assert!(needed.into_iter().all(|k| done[k][needs] == 1), "{stage} of {turn}");
                    }
                }
                for (stage, needs) in [(3, 2), (5, 4)] {
                    for turn in (0..turns).filter(|&k| done[k][stage] > at_once[k][stage]) {
                        assert!((turn.saturating_sub(1)..=turn).all(|k| done[k][needs] == 1), "{stage} of {turn}");
                    }
                }
            }
            assert!(done.iter().flatten().all(|&count| count == 1), "{done:?}");
        }
    }
}
