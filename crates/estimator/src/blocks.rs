//! Blocks of elements or stars that are worked on at a time, each with the nodes and elements that it needs under
//! numbers of its own.
//!
//! The fields of these nodes at some levels then lie side by side in a small part of the cache. Blocks do not depend on
//! the number of threads.

use percute_core::ids::{ElementId, NodeId};
use percute_core::mesh::{Mesh, Strips};
use std::ops::Range;

/// Elements or stars in a block: small enough for the cache, large enough to be worth a task.
pub(crate) const BLOCK: usize = 256;

/// Not in the block.
const ABSENT: u32 = u32::MAX;

/// Blocks of consecutive elements.
#[derive(Clone, Debug)]
pub(crate) struct ElementBlocks<const N: usize> {
    count: usize,
    nodes: Lists,
    /// Place of each node of each element among the nodes of its block.
    local: Vec<[u32; N]>,
}

/// Blocks of the stars of consecutive nodes.
#[derive(Clone, Debug)]
pub(crate) struct StarBlocks<const N: usize> {
    count: usize,
    elements: Lists,
    nodes: Lists,
    /// For each of these elements the places of its nodes among those of the block.
    local: Vec<[u32; N]>,
    /// For each element of each star its place among those of the block.
    around: Vec<u32>,
    /// Where the elements of each star begin there.
    first: Vec<u32>,
}

/// A part of a mesh that goes through the stages of the work together, while its moments are in the cache.
#[derive(Clone, Debug)]
pub(crate) struct MeshPart {
    /// Blocks of stars: with those of the parts before, they hold all nodes of the elements of this part.
    pub(crate) stars: Range<usize>,
    /// Blocks of elements.
    pub(crate) elements: Range<usize>,
    /// Strips of elements; the blocks lack some of the last elements, which belong to the next part.
    pub(crate) strips: Range<usize>,
}

/// Elements of a part, at least: few enough for the cache.
const PART: usize = 8192;

/// Strips of a part, at least: those of a parity are worked on at the same time.
const STRIPS: usize = 4;

/// The parts of a mesh with these strips, in order.
pub(crate) fn parts(mesh: &Mesh, strips: &Strips) -> Vec<MeshPart> {
    let all = [mesh.node_count().div_ceil(BLOCK), mesh.element_count().div_ceil(BLOCK)];
    let ends = |strip: usize| match strip {
        0 => [0, 0],
        _ if strip == strips.count() => all,
        _ => [strips.nodes(strip - 1).end.div_ceil(BLOCK), strips.elements(strip).start / BLOCK],
    };
    let (mut parts, mut first) = (Vec::new(), 0);
    for next in 1..=strips.count() {
        let elements = strips.elements(next - 1).end - strips.elements(first).start;
        if next == strips.count() || (next - first >= STRIPS && elements >= PART) {
            let ([stars, blocks], [stars_end, blocks_end]) = (ends(first), ends(next));
            parts.push(MeshPart { stars: stars..stars_end, elements: blocks..blocks_end, strips: first..next });
            first = next;
        }
    }
    parts
}

/// The numbers that belong to each block, one block after the other.
#[derive(Clone, Debug)]
struct Lists {
    starts: Vec<usize>,
    all: Vec<u32>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementBlock<'a, const N: usize> {
    pub(crate) nodes: &'a [u32],
    pub(crate) local: &'a [[u32; N]],
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StarBlock<'a, const N: usize> {
    pub(crate) elements: &'a [u32],
    pub(crate) nodes: &'a [u32],
    pub(crate) local: &'a [[u32; N]],
}

impl Lists {
    fn new() -> Self {
        Self { starts: vec![0], all: Vec::new() }
    }

    fn range(&self, block: usize) -> Range<usize> {
        self.starts[block]..self.starts[block + 1]
    }

    fn of(&self, block: usize) -> &[u32] {
        &self.all[self.range(block)]
    }

    /// Ends a block and forgets the places of its numbers.
    fn close(&mut self, places: &mut [u32]) {
        let start = self.starts[self.starts.len() - 1];
        self.all[start..].iter().for_each(|&number| places[number as usize] = ABSENT);
        self.starts.push(self.all.len());
    }

    /// The place of a number in the block that is being made; it is added if it is not there.
    fn place(&mut self, number: usize, places: &mut [u32]) -> u32 {
        if places[number] == ABSENT {
            places[number] = (self.all.len() - self.starts[self.starts.len() - 1]) as u32;
            self.all.push(number as u32);
        }
        places[number]
    }
}

impl<const N: usize> ElementBlocks<N> {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let mut places = vec![ABSENT; mesh.node_count()];
        let (mut nodes, mut local) = (Lists::new(), Vec::with_capacity(mesh.element_count()));
        for cells in mesh.nodes_of::<N>().chunks(BLOCK) {
            local.extend(cells.iter().map(|cell| cell.map(|node| nodes.place(node.index(), &mut places))));
            nodes.close(&mut places);
        }
        Self { count: mesh.element_count(), nodes, local }
    }

    /// The elements of a block.
    pub(crate) fn elements(&self, block: usize) -> Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.count)
    }

    pub(crate) fn block(&self, block: usize) -> ElementBlock<'_, N> {
        ElementBlock { nodes: self.nodes.of(block), local: &self.local[self.elements(block)] }
    }
}

impl<const N: usize> StarBlocks<N> {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let (mut node_places, mut element_places) =
            (vec![ABSENT; mesh.node_count()], vec![ABSENT; mesh.element_count()]);
        let mut blocks = Self {
            count: mesh.node_count(),
            elements: Lists::new(),
            nodes: Lists::new(),
            local: Vec::new(),
            around: Vec::with_capacity(N * mesh.element_count()),
            first: vec![0],
        };
        for start in (0..blocks.count).step_by(BLOCK) {
            for node in start..(start + BLOCK).min(blocks.count) {
                for element in mesh.stars().star(NodeId::new(node)).elements {
                    blocks.around.push(blocks.elements.place(element.index(), &mut element_places));
                }
                blocks.first.push(blocks.around.len() as u32);
            }
            blocks.elements.close(&mut element_places);
            for &element in blocks.elements.of(start / BLOCK) {
                let cell = &mesh.nodes_of::<N>()[element as usize];
                blocks.local.push(cell.map(|node| blocks.nodes.place(node.index(), &mut node_places)));
            }
            blocks.nodes.close(&mut node_places);
        }
        blocks
    }

    /// The nodes whose stars make up a block.
    pub(crate) fn centres(&self, block: usize) -> Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.count)
    }

    pub(crate) fn block(&self, block: usize) -> StarBlock<'_, N> {
        let local = &self.local[self.elements.range(block)];
        StarBlock { elements: self.elements.of(block), nodes: self.nodes.of(block), local }
    }

    /// The places of the elements of a star in its block.
    #[inline(always)]
    pub(crate) fn around(&self, node: NodeId) -> &[u32] {
        let i = node.index();
        &self.around[self.first[i] as usize..self.first[i + 1] as usize]
    }
}

impl<const N: usize> StarBlock<'_, N> {
    /// The elements with their nodes by their places.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (ElementId, &[u32; N])> {
        self.elements.iter().map(|&e| ElementId::new(e as usize)).zip(self.local)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;
    use percute_testkit::random_rectangle;

    /// Parts hold all blocks and strips once, in order, and the stars that their elements need come with them or
    /// before.
    fn check(mesh: &Mesh, fewest: usize) -> usize {
        let strips = Strips::with_fewest(mesh, fewest);
        let parts = parts(mesh, &strips);
        let (mut stars, mut elements, mut strip) = (0, 0, 0);
        for part in &parts {
            assert_eq!((part.stars.start, part.elements.start, part.strips.start), (stars, elements, strip));
            (stars, elements, strip) = (part.stars.end, part.elements.end, part.strips.end);
            let of_blocks = part.elements.start * BLOCK..(part.elements.end * BLOCK).min(mesh.element_count());
            let of_strips = part.strips.clone().flat_map(|strip| strips.elements(strip));
            for e in of_blocks.chain(of_strips) {
                assert!(mesh.nodes_of::<3>()[e].iter().all(|node| node.index() < stars * BLOCK), "element {e}");
            }
        }
        let all = [mesh.node_count().div_ceil(BLOCK), mesh.element_count().div_ceil(BLOCK), strips.count()];
        assert_eq!([stars, elements, strip], all);
        parts.len()
    }

    #[test]
    fn parts_have_the_stars_of_their_elements() {
        let mesh = Mesh::rectangle(1.0, 80.0, 12, 1200).unwrap();
        assert_eq!((check(&mesh, 64), check(&mesh, 2100), check(&mesh, 20_000)), (4, 4, 1));
        // Without locality there is one strip.
        assert_eq!(check(&random_rectangle(1.0, 1.0, 12, 3).unwrap(), 16), 1);
    }
}
