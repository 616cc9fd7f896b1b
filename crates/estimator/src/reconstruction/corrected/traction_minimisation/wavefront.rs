//! The order of the work: stages follow each other through the mesh, so that each finds its numbers in the cache.
//!
//! A block of nodes may go through a stage once the blocks around it have gone through the one before. The order of the
//! stages is then as free as the mesh permits, and the numbers do not depend on it. Each thread has a segment of the
//! blocks, in which it works as far as the blocks of its own permit; the rest, around the ends of segments, comes last.

use super::chebyshev::{Arrays, ChebyshevSteps, STAGES};
use super::modes::Numbers;
use super::operator::{Block, Operator};
use percute_core::ids::NodeId;
use percute_core::mesh::Mesh;
use percute_core::observer::StopFlag;
use std::ops::Range;

/// Nodes of a block.
const BLOCK: usize = 48;

/// Blocks of a segment: in a smaller one, little work would be apart from others.
const SEGMENT: usize = 64;

/// The blocks of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Wavefront {
    /// Number of nodes.
    nodes: usize,
    /// The first block around each block and all after it, and the end of those around it and all before it.
    around: Vec<[u32; 2]>,
}

/// The work that blocks have to go through.
#[derive(Clone, Copy, Debug)]
pub(super) struct Work<'a> {
    pub(super) numbers: &'a Numbers,
    pub(super) operator: &'a Operator,
    pub(super) steps: &'a ChebyshevSteps,
    /// Once it is up, blocks are left as they are.
    pub(super) stop: &'a StopFlag,
}

impl Work<'_> {
    /// Takes block `k` through a stage; the arrays begin with block `first`.
    fn on_block(&self, stage: usize, k: usize, first: usize, arrays: &mut Arrays<'_>) {
        if self.stop.is_up() {
            return;
        }
        let nodes = k * BLOCK..((k + 1) * BLOCK).min(self.numbers.nodes());
        self.operator.work(stage, self.steps, &Block::new(self.numbers, nodes, first * BLOCK), arrays);
    }
}

/// Which blocks of a segment have gone through each stage.
type Done = [Range<usize>; STAGES];

impl Wavefront {
    pub(super) fn new<const N: usize>(mesh: &Mesh) -> Self {
        let count = mesh.node_count().div_ceil(BLOCK);
        let mut around: Vec<[u32; 2]> = (0..count as u32).map(|k| [k, k + 1]).collect();
        for cell in mesh.nodes_of::<N>() {
            let blocks = cell.map(|node| (node.index() / BLOCK) as u32);
            for block in blocks {
                let [first, end] = &mut around[block as usize];
                blocks.iter().for_each(|k| (*first, *end) = ((*first).min(*k), (*end).max(k + 1)));
            }
        }
        for k in 1..count {
            around[k][1] = around[k][1].max(around[k - 1][1]);
            let back = count - 1 - k;
            around[back][0] = around[back][0].min(around[back + 1][0]);
        }
        Self { nodes: mesh.node_count(), around }
    }

    /// Takes all blocks through all stages.
    pub(super) fn run(&self, work: Work<'_>, arrays: &mut Arrays<'_>) {
        let count = self.around.len();
        let segments = rayon::current_num_threads().min(count / SEGMENT).max(1);
        let ends: Vec<usize> = (0..=segments).map(|s| s * count / segments).collect();
        let done = self.segments(work, &ends, arrays.reborrow());
        for stage in 0..STAGES {
            let mut next = 0;
            for done in &done {
                (next..done[stage].start).for_each(|k| work.on_block(stage, k, 0, arrays));
                next = done[stage].end;
            }
            (next..count).for_each(|k| work.on_block(stage, k, 0, arrays));
        }
    }

    /// Works on the segments between these ends at the same time.
    fn segments(&self, work: Work<'_>, ends: &[usize], arrays: Arrays<'_>) -> Vec<Done> {
        if ends.len() == 2 {
            return vec![self.segment(work, ends[0]..ends[1], arrays)];
        }
        let middle = ends.len() / 2;
        let (left, right) = arrays.split(work.numbers, NodeId::new(ends[middle] * BLOCK));
        let (mut left, right) =
            rayon::join(|| self.segments(work, &ends[..=middle], left), || self.segments(work, &ends[middle..], right));
        left.extend(right);
        left
    }

    /// Takes the blocks of a segment through the stages, as far as they depend on no others.
    fn segment(&self, work: Work<'_>, blocks: Range<usize>, mut arrays: Arrays<'_>) -> Done {
        let first = blocks.start;
        self.follow(blocks, |stage, k| work.on_block(stage, k, first, &mut arrays))
    }

    /// Takes all blocks through some stages, here. Each stage meets them in order.
    pub(super) fn all<const S: usize>(&self, mut on_nodes: impl FnMut(usize, Range<usize>)) {
        let nodes = |k: usize| k * BLOCK..((k + 1) * BLOCK).min(self.nodes);
        self.follow::<S>(0..self.around.len(), |stage, k| on_nodes(stage, nodes(k)));
    }

    /// Hands out stages and blocks of a segment, as far as they depend on no others. Gives those that have gone through
    /// each stage.
    fn follow<const S: usize>(
        &self,
        blocks: Range<usize>,
        mut on_block: impl FnMut(usize, usize),
    ) -> [Range<usize>; S] {
        let mut done: [Range<usize>; S] = std::array::from_fn(|_| blocks.start..blocks.start);
        // The blocks before these depend on another segment.
        for stage in 1..S {
            let from = done[stage - 1].start as u32;
            let start = blocks.clone().find(|k| self.around[*k][0] >= from).unwrap_or(blocks.end);
            done[stage] = start..start;
        }
        for front in blocks.clone() {
            on_block(0, front);
            done[0].end = front + 1;
            for stage in 1..S {
                while done[stage].end < blocks.end && self.around[done[stage].end][1] as usize <= done[stage - 1].end {
                    on_block(stage, done[stage].end);
                    done[stage].end += 1;
                }
            }
        }
        done
    }
}
