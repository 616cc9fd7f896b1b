//! What near elements keep of intervals until the motion of all contact nodes is known, in order of time.
//!
//! Memory takes a limited part of it. The rest waits in a temporary file, written and read once and in order.

use crate::scratch_file::{ScratchError, ScratchFile};
use std::collections::VecDeque;
use std::ops::Range;

/// Memory (bytes) that may always be taken, and for each contact node.
const HELD: usize = 64 << 20;
const HELD_PER_NODE: usize = 8 << 10;

/// Intervals of all elements, block after block.
#[derive(Debug)]
struct Batch {
    intervals: Range<usize>,
    /// Numbers of each block.
    lengths: Vec<u32>,
    place: BacklogPlace,
}

#[derive(Debug)]
enum BacklogPlace {
    /// Block after block.
    Memory(Vec<Vec<f64>>),
    /// From this number of the file on.
    File(u64),
}

/// Batches in order of time.
#[derive(Debug)]
pub(super) struct Backlog {
    batches: VecDeque<Batch>,
    /// Numbers that may be in memory, and those that are.
    most: usize,
    held: usize,
    /// Numbers of the last batch: about those of the next one.
    last: usize,
    /// Where the file ends.
    end: u64,
    file: ScratchFile,
    /// Memory of blocks that are gone.
    spare: Vec<Vec<f64>>,
    /// Numbers that were read.
    read: Vec<f64>,
}

/// The most bytes in memory, with so many contact nodes.
pub(super) fn most_bytes(nodes: usize) -> usize {
    HELD.max(nodes.saturating_mul(HELD_PER_NODE))
}

impl Backlog {
    /// An empty one, for so many contact nodes.
    pub(super) fn new(nodes: usize, file: ScratchFile) -> Self {
        Self {
            batches: VecDeque::new(),
            most: most_bytes(nodes) / size_of::<f64>(),
            held: 0,
            last: 0,
            end: 0,
            file,
            spare: Vec::new(),
            read: Vec::new(),
        }
    }

    /// Begins a batch of these intervals.
    pub(super) fn begin(&mut self, intervals: Range<usize>) {
        let place = if self.held + self.last <= self.most {
            BacklogPlace::Memory(Vec::new())
        } else {
            self.spare = Vec::new();
            if !self.batches.iter().rev().any(|batch| matches!(batch.place, BacklogPlace::File(_))) {
                self.end = 0;
            }
            BacklogPlace::File(self.end)
        };
        self.last = 0;
        self.batches.push_back(Batch { intervals, lengths: Vec::new(), place });
    }

    /// Appends a block to the last batch, and leaves other memory in its place.
    pub(super) fn push(&mut self, block: &mut Vec<f64>) -> Result<(), ScratchError> {
        let Some(batch) = self.batches.back_mut() else { return Ok(()) };
        batch.lengths.push(block.len() as u32);
        self.last += block.len();
        match &mut batch.place {
            BacklogPlace::Memory(blocks) => {
                self.held += block.len();
                // Later blocks may be a little longer.
                let other = self.spare.pop().unwrap_or_else(|| Vec::with_capacity(block.len() + block.len() / 16));
                blocks.push(std::mem::replace(block, other));
                Ok(())
            }
            BacklogPlace::File(_) => {
                let place = self.end;
                self.end += block.len() as u64;
                self.file.write(place, block)
            }
        }
    }

    /// The intervals of the first batch.
    pub(super) fn first(&self) -> Option<Range<usize>> {
        self.batches.front().map(|batch| batch.intervals.clone())
    }

    /// Some blocks of the first batch.
    pub(super) fn blocks(&mut self, blocks: Range<usize>) -> Result<Vec<&[f64]>, ScratchError> {
        let Some(batch) = self.batches.front() else { return Ok(Vec::new()) };
        let place = match &batch.place {
            BacklogPlace::Memory(held) => return Ok(held[blocks].iter().map(Vec::as_slice).collect()),
            BacklogPlace::File(place) => *place,
        };
        let numbers = |lengths: &[u32]| lengths.iter().map(|&length| length as usize).sum::<usize>();
        let (start, count) = (numbers(&batch.lengths[..blocks.start]), numbers(&batch.lengths[blocks.clone()]));
        self.read.resize(count, 0.0);
        self.file.read(place + start as u64, &mut self.read)?;
        let mut left = &self.read[..];
        let next = |length: &u32| {
            let (block, rest) = left.split_at(*length as usize);
            left = rest;
            block
        };
        Ok(batch.lengths[blocks].iter().map(next).collect())
    }

    /// Forgets the first batch.
    pub(super) fn pop(&mut self) {
        if let Some(Batch { place: BacklogPlace::Memory(blocks), .. }) = self.batches.pop_front() {
            self.held -= blocks.iter().map(Vec::len).sum::<usize>();
            self.spare = blocks;
        }
    }

    /// Bytes in memory.
    #[cfg(test)]
    pub(super) fn held(&self) -> usize {
        let spare: usize = self.spare.iter().map(Vec::capacity).sum();
        (self.held + spare + self.read.capacity()) * size_of::<f64>()
    }

    /// Takes this memory at most (bytes).
    #[cfg(test)]
    pub(super) fn limit(&mut self, bytes: usize) {
        self.most = bytes / size_of::<f64>();
    }

    /// Waits in this file.
    #[cfg(test)]
    pub(super) fn wait_in(&mut self, file: ScratchFile) {
        self.file = file;
    }

    /// Whether some of it has been in the file.
    #[cfg(test)]
    pub(super) fn has_been_in_file(&self) -> bool {
        self.file.is_used()
    }
}
