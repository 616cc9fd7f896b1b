//! Consecutive elements in blocks, so that nodes are finished one block after the other.

use std::ops::Range;

/// Fewest elements of a block: the nodes of six blocks are in work at a time and should stay in a cache.
const FEWEST: usize = 512;

/// Blocks of consecutive elements. Block k touches nodes of the ranges k and k + 1 only, so that blocks k and k + 2 share no node.
/// A mesh in an order that does not allow it is one block.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    /// First element of each block, and the number of elements.
    elements: Vec<usize>,
    /// First node of each range, and the number of nodes.
    nodes: Vec<usize>,
}

impl Blocks {
    /// Those of elements with these nodes, of at least so many elements each.
    pub(super) fn new<const N: usize>(cells: &[[u32; N]], node_count: usize, fewest: usize) -> Self {
        // The lowest node from each element on.
        let mut lowest = vec![node_count as u32; cells.len() + 1];
        for (e, nodes) in cells.iter().enumerate().rev() {
            lowest[e] = nodes.iter().fold(lowest[e + 1], |low, n| low.min(*n));
        }
        let (mut elements, mut nodes) = (vec![0], vec![0]);
        // The highest nodes before the next cut, and before the last one.
        let (mut highest, mut before) = (0, None);
        for (e, cell) in cells.iter().enumerate() {
            let start = elements[elements.len() - 1];
            if e >= start + fewest && before.is_none_or(|before| lowest[e] > before) {
                elements.push(e);
                nodes.push(lowest[e] as usize);
                before = Some(highest);
            }
            highest = cell.iter().fold(highest, |high, n| high.max(*n));
        }
        elements.push(cells.len());
        nodes.push(node_count);
        Self { elements, nodes }
    }

    /// Those of blocks of the usual size.
    pub(super) fn usual<const N: usize>(cells: &[[u32; N]], node_count: usize) -> Self {
        Self::new(cells, node_count, FEWEST)
    }

    pub(super) fn count(&self) -> usize {
        self.elements.len() - 1
    }

    /// Number of pairs: an even block and the odd one before it. Elements are summed in the order of pairs, the even block of
    /// each first. After a pair, no later block touches the nodes of its ranges.
    pub(super) fn pairs(&self) -> usize {
        self.count() / 2 + 1
    }

    /// The elements of a block; none beyond the last.
    #[inline(always)]
    pub(super) fn elements(&self, block: usize) -> Range<usize> {
        let end = self.count();
        self.elements[block.min(end)]..self.elements[(block + 1).min(end)]
    }

    /// The elements of the two blocks of a pair, in the order of summation.
    #[inline(always)]
    pub(super) fn pair(&self, pair: usize) -> [Range<usize>; 2] {
        [self.elements(2 * pair), if pair == 0 { 0..0 } else { self.elements(2 * pair - 1) }]
    }

    /// The nodes that the even block of a pair touches and no block before it but the odd one of the pair before.
    #[inline(always)]
    pub(super) fn begun(&self, pair: usize) -> Range<usize> {
        self.first_node(2 * pair)..self.first_node(2 * pair + 2)
    }

    /// The nodes that are finished after a pair and were not before it.
    #[inline(always)]
    pub(super) fn finished(&self, pair: usize) -> Range<usize> {
        let start = if pair == 0 { 0 } else { self.first_node(2 * pair - 1) };
        start..self.first_node(2 * pair + 1)
    }

    #[inline(always)]
    fn first_node(&self, range: usize) -> usize {
        self.nodes[range.min(self.count())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::TriangleMesh;
    use percute_testkit::random_rectangle;

    fn cells(mesh: &TriangleMesh) -> Vec<[u32; 3]> {
        mesh.cells().iter().map(|nodes| nodes.map(|n| n.index() as u32)).collect()
    }

    /// Pairs begin and finish each node once, before the first and after the last of its elements.
    fn check(cells: &[[u32; 3]], node_count: usize, blocks: &Blocks) {
        let (mut begun, mut finished, mut done) = (vec![false; node_count], vec![false; node_count], Vec::new());
        for pair in 0..blocks.pairs() {
            for n in blocks.begun(pair) {
                assert!(!std::mem::replace(&mut begun[n], true));
            }
            for e in blocks.pair(pair).into_iter().flatten() {
                assert!(cells[e].iter().all(|n| begun[*n as usize] && !finished[*n as usize]), "{e}");
                done.push(e);
            }
            for n in blocks.finished(pair) {
                assert!(!std::mem::replace(&mut finished[n], true));
            }
        }
        assert!(begun.iter().all(|begun| *begun) && finished.iter().all(|finished| *finished));
        done.sort_unstable();
        assert_eq!(done, (0..cells.len()).collect::<Vec<_>>());
    }

    #[test]
    fn pairs_finish_their_nodes() {
        for (nx, ny) in [(4, 30), (5, 31), (3, 1)] {
            let mesh = TriangleMesh::rectangle(1.0, 1.0, nx, ny).unwrap();
            let cells = cells(&mesh);
            for fewest in [1, 7, 16, 40, 10_000] {
                let blocks = Blocks::new(&cells, mesh.node_count(), fewest);
                check(&cells, mesh.node_count(), &blocks);
                // Rows of nodes: three rows of cells at most between cuts.
                assert!(blocks.count() + 1 >= cells.len() / (6 * nx).max(fewest + 2 * nx), "{}", blocks.count());
            }
        }
    }

    /// Without locality there is one block.
    #[test]
    fn any_order_will_do() {
        let mesh = random_rectangle(1.0, 1.0, 8, 3).unwrap();
        let mut cells = cells(&mesh);
        cells.reverse();
        let blocks = Blocks::new(&cells, mesh.node_count(), 1);
        check(&cells, mesh.node_count(), &blocks);
        assert!(blocks.count() <= 2, "{}", blocks.count());
    }
}
