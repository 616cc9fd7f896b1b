//! Two numbers of each candidate node at each half-step instant, from the earliest that is needed to the last one.
//!
//! The instants between two contacts may be as many as those of the run. Memory holds some chunks of consecutive
//! instants; the others wait in a temporary file.

use crate::scratch_file::{ScratchError, ScratchFile};
use std::collections::VecDeque;
use std::ops::Range;

/// Instants of a chunk.
const CHUNK: usize = 128;

/// Memory (bytes) that full chunks may always take; on large contact surfaces a single chunk takes more.
const HELD: usize = 1 << 18;

/// Instants that may always be in memory if work needs them at a time.
const SPAN: usize = 512;

/// Two numbers of a node at an instant.
pub(crate) type Pair = [f64; 2];

/// Where the numbers of all nodes at some consecutive instants are, those of a node side by side.
#[derive(Debug)]
enum Chunk {
    Memory(Vec<Pair>),
    /// By the number of the place in the file.
    File(u64),
}

/// The numbers of all nodes.
#[derive(Debug)]
pub(crate) struct NormalMotions {
    nodes: usize,
    /// The number of the first chunk that is kept.
    first: usize,
    chunks: VecDeque<Chunk>,
    /// Instants so far.
    count: usize,
    /// Chunks that may be in memory beside the last one.
    most: usize,
    file: ScratchFile,
    /// Places in the file.
    places: u64,
    free: Vec<u64>,
    spare: Vec<Vec<Pair>>,
}

/// Bytes of a chunk of so many nodes.
fn bytes_of_chunk(nodes: usize) -> usize {
    nodes * CHUNK * size_of::<Pair>()
}

/// The most bytes that the numbers of so many nodes take in memory, where work needs so many instants at a time.
pub(super) fn most_bytes(nodes: usize, span: usize) -> usize {
    (1 + most_chunks(nodes, span)) * bytes_of_chunk(nodes)
}

/// Chunks that may be in memory beside the last one.
fn most_chunks(nodes: usize, span: usize) -> usize {
    HELD.checked_div(bytes_of_chunk(nodes)).unwrap_or(0).max(1 + span.min(SPAN) / CHUNK)
}

impl NormalMotions {
    /// Of so many nodes, at no instant yet; work needs so many instants at a time.
    pub(crate) fn new(nodes: usize, span: usize, file: ScratchFile) -> Self {
        Self {
            nodes,
            first: 0,
            chunks: VecDeque::new(),
            count: 0,
            most: most_chunks(nodes, span),
            file,
            places: 0,
            free: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// Number of instants so far.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Makes place for another instant.
    pub(crate) fn extend(&mut self) -> Result<(), ScratchError> {
        if self.count == (self.first + self.chunks.len()) * CHUNK {
            self.put_away()?;
            let mut chunk = self.spare.pop().unwrap_or_default();
            chunk.resize(self.nodes * CHUNK, [0.0; 2]);
            self.chunks.push_back(Chunk::Memory(chunk));
        }
        self.count += 1;
        Ok(())
    }

    /// Writes the last chunk to the file, if there are enough in memory.
    fn put_away(&mut self) -> Result<(), ScratchError> {
        let in_memory = self.chunks.iter().filter(|chunk| matches!(chunk, Chunk::Memory(_))).count();
        let Some(Chunk::Memory(chunk)) = self.chunks.back().filter(|_| in_memory > self.most) else { return Ok(()) };
        let place = self.free.pop().unwrap_or(self.places);
        self.file.write(place * (2 * self.nodes * CHUNK) as u64, chunk.as_flattened())?;
        self.places = self.places.max(place + 1);
        if let Some(Chunk::Memory(chunk)) = self.chunks.pop_back() {
            self.spare.push(chunk);
        }
        self.chunks.push_back(Chunk::File(place));
        Ok(())
    }

    /// Forgets instants before one of them, by chunks.
    pub(super) fn forget(&mut self, before: usize) {
        while self.first < before / CHUNK {
            match self.chunks.pop_front() {
                Some(Chunk::Memory(chunk)) => self.spare.push(chunk),
                Some(Chunk::File(place)) => self.free.push(place),
                None => return,
            }
            self.first += 1;
        }
        self.spare.truncate(1);
    }

    /// Appends the numbers of a node at some instants.
    pub(crate) fn read(
        &mut self,
        node: usize,
        instants: Range<usize>,
        numbers: &mut Vec<Pair>,
    ) -> Result<(), ScratchError> {
        for (chunk, within) in pieces(instants) {
            let start = node * CHUNK + within.start;
            match &self.chunks[chunk - self.first] {
                Chunk::Memory(chunk) => numbers.extend_from_slice(&chunk[start..][..within.len()]),
                Chunk::File(place) => {
                    let place = 2 * (place * (self.nodes * CHUNK) as u64 + start as u64);
                    let end = numbers.len();
                    numbers.resize(end + within.len(), [0.0; 2]);
                    self.file.read(place, numbers[end..].as_flattened_mut())?;
                }
            }
        }
        Ok(())
    }

    /// Writes the numbers of a node from an instant on.
    pub(crate) fn write(&mut self, node: usize, from: usize, mut numbers: &[Pair]) -> Result<(), ScratchError> {
        for (chunk, within) in pieces(from..from + numbers.len()) {
            let start = node * CHUNK + within.start;
            let (some, rest) = numbers.split_at(within.len());
            numbers = rest;
            match &mut self.chunks[chunk - self.first] {
                Chunk::Memory(chunk) => chunk[start..][..within.len()].copy_from_slice(some),
                Chunk::File(place) => {
                    let place = 2 * (*place * (self.nodes * CHUNK) as u64 + start as u64);
                    self.file.write(place, some.as_flattened())?;
                }
            }
        }
        Ok(())
    }

    /// Takes any memory.
    #[cfg(test)]
    pub(super) fn lift_limit(&mut self) {
        self.most = usize::MAX;
    }

    /// Bytes in memory.
    #[cfg(test)]
    pub(super) fn held(&self) -> usize {
        let chunks = self.chunks.iter().filter(|chunk| matches!(chunk, Chunk::Memory(_))).count();
        (chunks + self.spare.len()) * bytes_of_chunk(self.nodes)
    }
}

/// The chunks of some instants, with the instants in each.
fn pieces(instants: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
    let chunks = instants.start / CHUNK..instants.end.div_ceil(CHUNK);
    chunks.map(move |chunk| {
        let within = |instant: usize| instant.clamp(chunk * CHUNK, (chunk + 1) * CHUNK) - chunk * CHUNK;
        (chunk, within(instants.start)..within(instants.end))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Memory is limited, and numbers in the file are those that were written last.
    #[test]
    fn numbers_wait_in_the_file() {
        let (nodes, instants) = (300, 20 * CHUNK + 7);
        let mut motions = NormalMotions::new(nodes, 0, ScratchFile::default());
        let number = |node: usize, instant: usize| [node as f64, instant as f64];
        for instant in 0..instants {
            motions.extend().unwrap();
            for node in 0..nodes {
                motions.write(node, instant, &[number(node, instant)]).unwrap();
            }
            assert!(motions.held() <= most_bytes(nodes, 0));
        }
        assert!(motions.file.is_used());
        let changed: Vec<Pair> = (0..10 * CHUNK).map(|k| [-(k as f64), 0.5]).collect();
        motions.write(7, 50, &changed).unwrap();
        motions.forget(3 * CHUNK + 5);
        for node in [0, 7, nodes - 1] {
            let mut found = Vec::new();
            motions.read(node, 3 * CHUNK..instants, &mut found).unwrap();
            for (instant, found) in (3 * CHUNK..).zip(found) {
                let changed = changed.get(instant - 50).filter(|_| node == 7);
                assert_eq!(found, changed.copied().unwrap_or(number(node, instant)), "{node} {instant}");
            }
        }
    }

    /// Without an earliest instant that is needed, places in the file are used again.
    #[test]
    fn places_in_the_file_are_used_again() {
        let mut motions = NormalMotions::new(1000, 0, ScratchFile::default());
        for instant in 0..100 * CHUNK {
            motions.extend().unwrap();
            motions.forget(instant.saturating_sub(5 * CHUNK));
        }
        assert!(motions.file.is_used() && motions.places < 8, "{}", motions.places);
    }
}
