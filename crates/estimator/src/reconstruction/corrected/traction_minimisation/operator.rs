//! The energy of the modes: a matrix whose blocks for each node and each edge alone are the identity.
//!
//! Coefficients are scaled by the Cholesky factors of these blocks. The spectrum then depends on shapes only, not on
//! sizes, materials or axes.

use super::modes::Numbers;
use percute_core::simd::lanes::Lanes;
use std::ops::Range;

/// The entries that couple an edge with nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct WithNodes {
    /// Its lower and its higher end and the opposite nodes on both sides.
    pub(super) nodes: [u32; 4],
    pub(super) entries: [[f64; 3]; 4],
}

/// The entries that couple an edge with edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct WithEdges {
    /// The two other edges on each side.
    pub(super) edges: [u32; 4],
    pub(super) entries: [f64; 4],
}

/// An edge at a node and the next edge opposite to the node, counterclockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sector {
    /// Twice the number of the edge, and 1 if the node is its higher end.
    pub(super) spoke: u32,
    /// Twice the number of the opposite edge, and 1 if the node lies on its neighbour's side; [`NONE`] after the last
    /// edge of a node of the boundary.
    pub(super) rim: u32,
}

pub(super) const NONE: u32 = u32::MAX;

/// The matrix and the scales of the coefficients.
#[derive(Debug)]
pub(super) struct Operator {
    /// Where those of each node begin; nodes without modes have none.
    pub(super) first_sector: Vec<u32>,
    pub(super) sectors: Vec<Sector>,
    pub(super) with_nodes: Vec<WithNodes>,
    pub(super) with_edges: Vec<WithEdges>,
    /// The entries that couple the lower end of an edge (rows) with the higher one.
    pub(super) ends: Vec<[[f64; 3]; 3]>,
    /// L⁻¹ of the block LLᵀ of each node; zero without modes.
    pub(super) node_scale: Vec<[[f64; 3]; 3]>,
    /// The same of each edge.
    pub(super) edge_scale: Vec<f64>,
}

/// Nodes that are worked on at once, and the edges of which they are the lower ends.
#[derive(Clone, Debug)]
pub(super) struct Block {
    nodes: Range<usize>,
    edges: Range<usize>,
    /// The node and the edge with which the arrays at hand begin.
    first_node: usize,
    first_edge: usize,
}

impl Block {
    /// In arrays that begin with node `first`.
    #[inline(always)]
    pub(super) fn new(numbers: &Numbers, nodes: Range<usize>, first: usize) -> Self {
        let edges = numbers.first_edge(nodes.start)..numbers.first_edge(nodes.end);
        Self { nodes, edges, first_node: first, first_edge: numbers.first_edge(first) }
    }

    /// The edges, in the arrays.
    pub(super) fn edges(&self) -> Range<usize> {
        self.edges.start - self.first_edge..self.edges.end - self.first_edge
    }
}

impl Operator {
    /// Of an element (bytes): in a triangulation, three edges and one node go with two elements, and six edges with a
    /// node.
    pub(super) const BYTES: usize = 3 * size_of::<Sector>()
        + (3 * (size_of::<WithNodes>() + size_of::<WithEdges>() + 10 * size_of::<f64>())
            + size_of::<[[f64; 3]; 3]>()
            + size_of::<u32>())
            / 2;

    /// The sectors of a node.
    #[inline(always)]
    pub(super) fn sectors(&self, node: usize) -> Range<usize> {
        self.first_sector[node] as usize..self.first_sector[node + 1] as usize
    }

    /// Scales slopes: L⁻¹ of each node and each edge.
    #[inline(always)]
    pub(super) fn scale_slopes(&self, block: &Block, nodes: &mut [[Lanes; 3]], edges: &mut [Lanes]) {
        for node in block.nodes.clone() {
            let (slopes, scale) = (&mut nodes[node - block.first_node], &self.node_scale[node]);
            let values = *slopes;
            for i in 0..3 {
                slopes[i] = combined(&scale[i], &values);
            }
        }
        self.scale_edges(block, edges);
    }

    /// Turns scaled coefficients of nodes into coefficients: L⁻ᵀ.
    #[inline(always)]
    pub(super) fn unscale_nodes(&self, block: &Block, from: &[[Lanes; 3]], to: &mut [[Lanes; 3]]) {
        for node in block.nodes.clone() {
            let (at, scale) = (node - block.first_node, &self.node_scale[node]);
            let values = from[at];
            for i in 0..3 {
                to[at][i] = combined(&[scale[0][i], scale[1][i], scale[2][i]], &values);
            }
        }
    }

    /// Turns scaled coefficients of edges into coefficients, or slopes in them into scaled ones.
    #[inline(always)]
    pub(super) fn scale_edges(&self, block: &Block, edges: &mut [Lanes]) {
        for edge in block.edges.clone() {
            let value = &mut edges[edge - block.first_edge];
            *value = *value * self.edge_scale[edge];
        }
    }

    /// Gives `with` the sum over the nodes around each edge, and its place.
    #[inline(always)]
    pub(super) fn nodes_around_edges(&self, block: &Block, x: &[[Lanes; 3]], mut with: impl FnMut(usize, Lanes)) {
        for edge in block.edges.clone() {
            let WithNodes { nodes, entries } = &self.with_nodes[edge];
            let mut parts = [Lanes::ZERO; 4];
            for k in 0..4 {
                parts[k] = combined(&entries[k], &x[nodes[k] as usize - block.first_node]);
            }
            let [a, b, c, d] = parts;
            with(edge - block.first_edge, (a + b) + (c + d));
        }
    }

    /// Gives `with` the sum over the edges around each edge, and its place.
    #[inline(always)]
    pub(super) fn edges_around_edges(&self, block: &Block, x: &[Lanes], mut with: impl FnMut(usize, Lanes)) {
        for edge in block.edges.clone() {
            let WithEdges { edges, entries } = &self.with_edges[edge];
            let mut parts = [Lanes::ZERO; 4];
            for k in 0..4 {
                parts[k] = x[edges[k] as usize - block.first_edge] * entries[k];
            }
            let [a, b, c, d] = parts;
            with(edge - block.first_edge, (a + b) + (c + d));
        }
    }

    /// Gives `with` the sums over the nodes around each node, if they are wanted, less those over the edges around it,
    /// and its place.
    #[inline(always)]
    pub(super) fn around_nodes<const NODES: bool>(
        &self,
        block: &Block,
        x: &[[Lanes; 3]],
        edges: &[Lanes],
        mut with: impl FnMut(usize, &[Lanes; 3]),
    ) {
        for node in block.nodes.clone() {
            let mut sum = [Lanes::ZERO; 3];
            for Sector { spoke, rim } in &self.sectors[self.sectors(node)] {
                let (edge, higher) = ((spoke >> 1) as usize, spoke & 1 == 1);
                let (row, value) = (&self.with_nodes[edge], edges[edge - block.first_edge]);
                let entries = &row.entries[usize::from(higher)];
                for i in 0..3 {
                    sum[i] -= value * entries[i];
                }
                if NODES {
                    let end = &x[row.nodes[usize::from(!higher)] as usize - block.first_node];
                    let m = &self.ends[edge];
                    for i in 0..3 {
                        let row = if higher { [m[0][i], m[1][i], m[2][i]] } else { m[i] };
                        sum[i] += combined(&row, end);
                    }
                }
                if *rim != NONE {
                    let (edge, side) = ((rim >> 1) as usize, (rim & 1) as usize);
                    let (entries, value) = (&self.with_nodes[edge].entries[2 + side], edges[edge - block.first_edge]);
                    for i in 0..3 {
                        sum[i] -= value * entries[i];
                    }
                }
            }
            with(node - block.first_node, &sum);
        }
    }
}

/// Σ row_j values_j.
#[inline(always)]
fn combined(row: &[f64; 3], values: &[Lanes; 3]) -> Lanes {
    values[0] * row[0] + values[1] * row[1] + values[2] * row[2]
}
