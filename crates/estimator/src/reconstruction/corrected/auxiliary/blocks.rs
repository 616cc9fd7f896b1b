//! Consecutive elements in blocks, so that nodes are finished one block after the other.

use percute_core::mesh::{Mesh, Strips};
use std::ops::Range;

/// Fewest elements of a block: the nodes of six blocks are in work at a time and should stay in a cache.
const FEWEST: usize = 512;

/// Strips in the order of a pass: the even ones each before its odd neighbours. A turn is an even strip and the odd one
/// before it. Elements are thus summed up in the order of all even strips and then all odd ones.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    strips: Strips,
    node_count: usize,
}

impl Blocks {
    /// Those of a mesh, of at least so many elements each.
    pub(super) fn with_fewest(mesh: &Mesh, fewest: usize) -> Self {
        Self { strips: Strips::with_fewest(mesh, fewest), node_count: mesh.node_count() }
    }

    /// Those of the usual size.
    pub(super) fn new(mesh: &Mesh) -> Self {
        Self::with_fewest(mesh, FEWEST)
    }

    pub(super) fn count(&self) -> usize {
        self.strips.count()
    }

    /// The elements of a block.
    pub(super) fn elements(&self, block: usize) -> Range<usize> {
        self.strips.elements(block)
    }

    /// Number of turns.
    pub(super) fn turns(&self) -> usize {
        self.count() / 2 + 1
    }

    /// The even block of a turn, if there is one of this number.
    #[inline(always)]
    pub(super) fn even(&self, turn: usize) -> Option<usize> {
        Some(2 * turn).filter(|block| *block < self.count())
    }

    /// The odd block of a turn, if there is one of this number.
    #[inline(always)]
    pub(super) fn odd(&self, turn: usize) -> Option<usize> {
        (2 * turn).checked_sub(1).filter(|block| *block < self.count())
    }

    /// The nodes that the blocks of a turn touch and those of the turns before do not.
    #[inline(always)]
    pub(super) fn begun(&self, turn: usize) -> Range<usize> {
        self.first_node(2 * turn)..self.first_node(2 * turn + 2)
    }

    /// The nodes that no block of a later turn touches.
    #[inline(always)]
    pub(super) fn finished(&self, turn: usize) -> Range<usize> {
        let start = if turn == 0 { 0 } else { self.first_node(2 * turn - 1) };
        start..self.first_node(2 * turn + 1)
    }

    /// The nodes that a block touches, and others up to the next block but one.
    #[inline(always)]
    pub(super) fn nodes(&self, block: usize) -> Range<usize> {
        self.first_node(block)..self.first_node(block + 2)
    }

    /// The lowest node of a block and all after it.
    #[inline(always)]
    fn first_node(&self, block: usize) -> usize {
        match block {
            0 => 0,
            _ if block < self.count() => self.strips.nodes(block).start,
            _ => self.node_count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::ids::NodeId;
    use percute_testkit::random_rectangle;

    /// Turns begin and finish each node once, before the first and after the last of its elements.
    fn check(cells: &[[NodeId; 3]], node_count: usize, blocks: &Blocks) {
        let (mut begun, mut finished, mut done) = (vec![false; node_count], vec![false; node_count], Vec::new());
        for turn in 0..blocks.turns() {
            for n in blocks.begun(turn) {
                assert!(!std::mem::replace(&mut begun[n], true));
            }
            for block in blocks.even(turn).into_iter().chain(blocks.odd(turn)) {
                for e in blocks.elements(block) {
                    assert!(cells[e].iter().all(|n| begun[n.index()] && !finished[n.index()]), "{e}");
                    done.push(e);
                }
            }
            for n in blocks.finished(turn) {
                assert!(!std::mem::replace(&mut finished[n], true));
            }
        }
        assert!(begun.iter().all(|begun| *begun) && finished.iter().all(|finished| *finished));
        done.sort_unstable();
        assert_eq!(done, (0..cells.len()).collect::<Vec<_>>());
    }

    #[test]
    fn turns_finish_their_nodes() {
        for (nx, ny) in [(4, 30), (5, 31), (3, 1)] {
            let mesh = Mesh::rectangle(1.0, 1.0, nx, ny).unwrap();
            for fewest in [1, 7, 16, 40, 10_000] {
                let blocks = Blocks::with_fewest(&mesh, fewest);
                check(mesh.nodes_of::<3>(), mesh.node_count(), &blocks);
            }
        }
        let mesh = Mesh::rectangle(1.0, 1.0, 4, 30).unwrap();
        assert!(Blocks::with_fewest(&mesh, 8).count() > 5);
    }

    /// Without locality there is one block.
    #[test]
    fn any_order_will_do() {
        let mesh = random_rectangle(1.0, 1.0, 8, 3).unwrap();
        let mut cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(NodeId::index)).collect();
        cells.reverse();
        let points = mesh.points_in::<2>().to_vec();
        let mesh = Mesh::new(points, &cells, &Default::default(), &Default::default()).unwrap();
        check(mesh.nodes_of::<3>(), mesh.node_count(), &Blocks::with_fewest(&mesh, 1));
    }
}
