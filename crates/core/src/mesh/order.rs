//! An order of nodes and elements in which neighbours lie close together in memory.
//!
//! A sweep over the elements reads and writes their nodes. In a local order these are the nodes of a narrow front that
//! stays in the cache; the elements of a strip touch consecutive nodes.

use super::{Mesh, in_kind};
use crate::ids::{ElementId, NodeId};

/// A front of so many nodes is always local: a nodal vector of theirs at eight levels takes 32 kB, as much as the first
/// cache holds. In a shuffled mesh of 357 nodes a step takes 4 % longer than in order and the estimate 16 %.
const SMALL: usize = 256;

/// A front of 4√n of n nodes is local too: 180 kB to 500 kB for 655 thousand to 5 million elements, which the
/// second-level cache holds. Rectangles in rows of up to 16 to 1 are within.
const FRONT: f64 = 4.0;

/// Passes in search of a node at the periphery: the second or third finds no farther one on usual meshes.
const PASSES: usize = 4;

/// New numbers of the nodes and elements of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbering {
    nodes: Vec<NodeId>,
    elements: Vec<ElementId>,
}

impl Numbering {
    /// The numbering with these old numbers of the new nodes and elements, each a permutation.
    #[must_use]
    pub fn new(nodes: Vec<NodeId>, elements: Vec<ElementId>) -> Self {
        Self { nodes, elements }
    }

    /// The old number of each new node.
    #[must_use]
    pub fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    /// The old number of each new element.
    #[must_use]
    pub fn elements(&self) -> &[ElementId] {
        &self.elements
    }

    /// A nodal field of old numbers, in rows, in the new numbers.
    pub fn order_nodal(&self, old: &[f64], new: &mut Vec<f64>) {
        let width = old.len() / self.nodes.len();
        new.clear();
        self.nodes.iter().for_each(|node| new.extend_from_slice(&old[row(node.index(), width)]));
    }

    /// A nodal field of new numbers, in rows, in the old numbers.
    pub fn restore_nodal(&self, new: &[f64], old: &mut Vec<f64>) {
        let width = new.len() / self.nodes.len();
        old.clear();
        old.extend_from_slice(new);
        for (at, node) in self.nodes.iter().enumerate() {
            old[row(node.index(), width)].copy_from_slice(&new[row(at, width)]);
        }
    }

    /// Values of old elements, in rows, in the new numbers.
    #[must_use]
    pub fn order_elemental(&self, old: &[f64]) -> Vec<f64> {
        let width = old.len() / self.elements.len();
        self.elements.iter().flat_map(|element| &old[row(element.index(), width)]).copied().collect()
    }

    /// Values of new elements, in rows, in the old numbers.
    #[must_use]
    pub fn restore_elemental(&self, new: &[f64]) -> Vec<f64> {
        let (width, mut old) = (new.len() / self.elements.len(), new.to_vec());
        for (at, element) in self.elements.iter().enumerate() {
            old[row(element.index(), width)].copy_from_slice(&new[row(at, width)]);
        }
        old
    }
}

/// The place of a row.
fn row(at: usize, width: usize) -> std::ops::Range<usize> {
    width * at..width * (at + 1)
}

impl Mesh {
    /// A local numbering: nodes by breadth-first levels from the periphery of each part (Cuthill and McKee 1969),
    /// elements by their nodes. `None` if the present order is local enough.
    #[must_use]
    pub fn local_numbering(&self) -> Option<Numbering> {
        if self.is_local() {
            return None;
        }
        let nodes = breadth_first(self);
        let place = inverse(&nodes);
        let elements = in_kind!(self, D, N => {
            let corners = |e: usize| {
                let mut corners = self.nodes_of::<N>()[e].map(|node| place[node.index()]);
                corners.sort_unstable();
                corners
            };
            sorted(self.element_count(), nodes.len(), corners)
        });
        Some(Numbering { nodes, elements: elements.into_iter().map(|e| ElementId::new(e as usize)).collect() })
    }

    /// Whether the nodes of each element are close together, and elements that follow each other too: no element has a
    /// node further than a front behind its highest, or behind the lowest node of an element before.
    #[must_use]
    pub fn is_local(&self) -> bool {
        let front = SMALL.max((FRONT * (self.node_count() as f64).sqrt()) as usize);
        let mut reached = 0;
        self.cells().all(|cell| {
            let numbers = cell.iter().map(|node| node.index());
            let [low, high] = [usize::min, usize::max].map(|pick| numbers.clone().fold(cell[0].index(), pick));
            reached = reached.max(low);
            high - low <= front && reached - low <= front
        })
    }
}

/// Place of each number in a permutation.
pub(super) fn inverse(order: &[NodeId]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, old)| place[old.index()] = new as u32);
    place
}

/// The numbers below `count` sorted by these ascending nodes: by the first in one sweep over all, then each few of the
/// same first by the others. Those of the same nodes keep their order.
pub(super) fn sorted<const M: usize>(count: usize, node_count: usize, nodes: impl Fn(usize) -> [u32; M]) -> Vec<u32> {
    let mut end = vec![0_u32; node_count + 1];
    (0..count).for_each(|i| end[nodes(i)[0] as usize + 1] += 1);
    (0..node_count).for_each(|n| end[n + 1] += end[n]);
    let mut order = vec![0; count];
    for i in 0..count {
        let slot = &mut end[nodes(i)[0] as usize];
        order[*slot as usize] = i as u32;
        *slot += 1;
    }
    let mut start = 0;
    for end in end {
        order[start..end as usize].sort_by_key(|&i| nodes(i as usize));
        start = end as usize;
    }
    order
}

/// All nodes by breadth-first levels, part by part.
fn breadth_first(mesh: &Mesh) -> Vec<NodeId> {
    let mut order = Vec::with_capacity(mesh.node_count());
    let mut walk = Walk { mesh, pass: 0, seen: vec![0; mesh.node_count()], queue: Vec::new(), last: 0 };
    for first in (0..mesh.node_count()).map(NodeId::new) {
        if walk.seen[first.index()] == 0 {
            let mut depth = walk.from(first);
            for _ in 0..PASSES {
                let farther = walk.from(walk.least_of_the_last());
                if farther <= std::mem::replace(&mut depth, farther) {
                    break;
                }
            }
            order.append(&mut walk.queue);
        }
    }
    order
}

/// A walk through a part of the mesh.
struct Walk<'m> {
    mesh: &'m Mesh,
    pass: u32,
    /// The last pass that came to each node.
    seen: Vec<u32>,
    /// The nodes in the order of the walk.
    queue: Vec<NodeId>,
    /// The place in it at which the last level begins.
    last: usize,
}

impl Walk<'_> {
    /// Nodes with few elements first, and of those the lowest number.
    fn rank(&self, node: NodeId) -> (usize, NodeId) {
        (self.mesh.stars.star(node).elements.len(), node)
    }

    /// The first by rank in the last level.
    fn least_of_the_last(&self) -> NodeId {
        let level = &self.queue[self.last..];
        level.iter().copied().min_by_key(|&node| self.rank(node)).unwrap_or(level[0])
    }

    /// Walks through the part of this node, and returns the number of levels.
    fn from(&mut self, start: NodeId) -> usize {
        self.pass += 1;
        self.queue.clear();
        self.queue.push(start);
        self.seen[start.index()] = self.pass;
        let (mut depth, mut level) = (0, 0..1);
        while !level.is_empty() {
            (depth, self.last) = (depth + 1, level.start);
            for at in level.clone() {
                self.visit_around(self.queue[at]);
            }
            level = level.end..self.queue.len();
        }
        depth
    }

    /// Puts the neighbours of a node that were not seen yet into the queue.
    fn visit_around(&mut self, node: NodeId) {
        let mesh = self.mesh;
        for element in mesh.stars.star(node).elements {
            for &near in mesh.cell(*element) {
                if self.seen[near.index()] != self.pass {
                    self.seen[near.index()] = self.pass;
                    self.queue.push(near);
                }
            }
        }
    }
}
