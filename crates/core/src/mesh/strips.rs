//! Blocks of elements that can be worked on at the same time.

use super::Mesh;
use crate::ids::NodeId;
use std::ops::Range;

/// A strip has at least this many elements, so that its work outweighs the start of a task (2 to 4 µs against 0.5) …
const FEWEST: usize = 2048;
/// … and at least this fraction of them: more strips only have more common nodes.
const MOST_STRIPS: usize = 64;

/// A mesh in its present order, cut into strips: blocks of consecutive elements of which only neighbours share nodes,
/// and whose nodes are ranges in ascending order. All even strips can be worked on at the same time, each on the slice
/// of its nodes, and then all odd ones. The cut depends on the mesh alone. A mesh without such an order is one strip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Strips {
    /// First element of each strip, and the number of elements.
    elements: Vec<u32>,
    /// Range of the nodes of each strip.
    nodes: Vec<[u32; 2]>,
}

impl Strips {
    /// Cuts the elements of a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        Self::with_fewest(mesh, FEWEST.max(mesh.element_count().div_ceil(MOST_STRIPS)))
    }

    /// The same with at least `fewest` elements in a strip.
    #[must_use]
    pub fn with_fewest(mesh: &Mesh, fewest: usize) -> Self {
        Self::of_cells(&mesh.cells().collect::<Vec<_>>(), fewest)
    }

    /// Cuts elements, given by their nodes.
    fn of_cells(cells: &[&[NodeId]], fewest: usize) -> Self {
        let mut lowest_from: Vec<u32> = cells.iter().map(|cell| lowest(cell)).collect();
        for e in (1..cells.len()).rev() {
            lowest_from[e - 1] = lowest_from[e - 1].min(lowest_from[e]);
        }
        let (mut starts, mut end, mut seen) = (vec![0], 0_u32, 0);
        let mut next = fewest;
        while next + fewest <= cells.len() {
            // The strip before the last start must not share a node with any that begins at `next`.
            let (before, start) = (starts.len().checked_sub(2), starts[starts.len() - 1]);
            if before.is_some() {
                end = cells[seen..start].iter().map(|cell| highest(cell) + 1).fold(end, u32::max);
                seen = start;
                next += lowest_from[next..].partition_point(|&lowest| lowest < end);
            }
            if next + fewest > cells.len() {
                break;
            }
            starts.push(next);
            next += fewest;
        }
        if starts.len() < 3 {
            starts.truncate(1);
        }
        starts.push(cells.len());
        let mut end = 0;
        let range = |pair: &[usize]| {
            // Both ends ascend from strip to strip.
            end = cells[pair[0]..pair[1]].iter().map(|cell| highest(cell) + 1).fold(end, u32::max);
            [lowest_from[pair[0]], end]
        };
        Self { nodes: starts.windows(2).map(range).collect(), elements: starts.iter().map(|&e| e as u32).collect() }
    }

    /// Number of strips.
    #[inline]
    #[must_use]
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Number of all elements.
    #[must_use]
    pub fn element_count(&self) -> usize {
        self.elements(self.count() - 1).end
    }

    /// Elements of a strip.
    #[inline]
    #[must_use]
    pub fn elements(&self, strip: usize) -> Range<usize> {
        self.elements[strip] as usize..self.elements[strip + 1] as usize
    }

    /// Range that holds all nodes of a strip, and no node that other strips than its neighbours have.
    #[inline]
    #[must_use]
    pub fn nodes(&self, strip: usize) -> Range<usize> {
        self.nodes[strip][0] as usize..self.nodes[strip][1] as usize
    }

    /// The part of that range which lies in no range of a neighbour. Together with the ranges of all strips of the
    /// other parity these parts hold each node once.
    #[inline]
    #[must_use]
    pub fn own_nodes(&self, strip: usize) -> Range<usize> {
        let Range { start, end } = self.nodes(strip);
        let start = if strip > 0 { start.max(self.nodes(strip - 1).end) } else { start };
        let end = if strip + 1 < self.count() { end.min(self.nodes(strip + 1).start) } else { end };
        start..end
    }
}

fn lowest(cell: &[NodeId]) -> u32 {
    cell.iter().map(|node| node.index() as u32).fold(u32::MAX, u32::min)
}

fn highest(cell: &[NodeId]) -> u32 {
    cell.iter().map(|node| node.index() as u32).fold(0, u32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All that is promised of the cut of these cells.
    fn check(cells: &[&[NodeId]], nodes: usize, strips: &Strips) {
        let mut seen = vec![[0; 2]; nodes];
        assert_eq!((strips.elements(0).start, strips.elements(strips.count() - 1).end), (0, cells.len()));
        for k in 0..strips.count() {
            let range = strips.nodes(k);
            assert!(cells[strips.elements(k)].iter().copied().flatten().all(|node| range.contains(&node.index())));
            assert!(k < 2 || strips.nodes(k - 2).end <= range.start, "strips {} and {k} share nodes", k - 2);
            for parity in 0..2 {
                let part = if k % 2 == parity { strips.nodes(k) } else { strips.own_nodes(k) };
                part.for_each(|node| seen[node][parity] += 1);
            }
        }
        assert!(seen.iter().all(|&count| count == [1, 1]), "{seen:?}");
    }

    proptest::proptest! {
        /// Also where some elements are out of order.
        #[test]
        fn strips_of_the_same_parity_share_no_node(
            nx in 1_usize..9, ny in 1_usize..40, fewest in 1_usize..40,
            swaps in proptest::collection::vec((0_usize..300, 0_usize..30), 0..3),
        ) {
            let mesh = Mesh::rectangle(1.0, 1.0, nx, ny).unwrap();
            let mut cells: Vec<_> = mesh.cells().collect();
            for (at, distance) in swaps {
                let (from, to) = (at % cells.len(), (at + distance) % cells.len());
                cells.swap(from, to);
            }
            check(&cells, mesh.node_count(), &Strips::of_cells(&cells, fewest));
        }
    }

    #[test]
    fn a_rectangle_has_strips_of_its_rows() {
        let mesh = Mesh::rectangle(1.0, 1.0, 10, 50).unwrap();
        let strips = Strips::with_fewest(&mesh, 100);
        assert_eq!(strips.count(), 10);
        assert_eq!((strips.nodes(1), strips.own_nodes(1)), (55..121, 66..110));
        assert_eq!(Strips::new(&mesh).count(), 1);
        let mut reversed: Vec<_> = mesh.cells().collect();
        reversed.reverse();
        assert_eq!(Strips::of_cells(&reversed, 100).count(), 1);
    }
}
