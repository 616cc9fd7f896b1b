//! The matrix of the energy from the forms of the elements.

use super::mode_forms::{ModeForm, edge, mode_forms};
use super::modes::Numbers;
use super::operator::{NONE, Operator, Sector, WithEdges, WithNodes};
use crate::element::Element;
use crate::stress::TractionForms;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::problem::Problem;
use percute_core::simd::dispatch;
use percute_core::simd::lanes::LANES;

/// The parts of the mesh that matter.
#[derive(Clone, Copy, Debug)]
struct Unknown<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D>,
    elements: &'a [Element<D, N>],
    numbers: &'a Numbers,
}

/// The matrix for the modes of a problem.
pub(super) fn assemble<const D: usize, const N: usize>(
    problem: &Problem<D>,
    elements: &[Element<D, N>],
    numbers: &Numbers,
) -> Operator {
    let unknown = Unknown { problem, elements, numbers };
    let (mut operator, forms) = (unknown.empty(), TractionForms::get());
    for first in (0..elements.len()).step_by(LANES) {
        let form = dispatch(
            #[inline(always)]
            || mode_forms::<D, N>(problem, forms, first),
        );
        (first..elements.len().min(first + LANES)).for_each(|e| unknown.add(&mut operator, e, &form, e - first));
    }
    unknown.factor(&mut operator);
    scale(&mut operator);
    operator
}

impl<const D: usize, const N: usize> Unknown<'_, D, N> {
    /// The components in which the moments of a face are unknown: all in the body, those of the support on its
    /// boundary.
    fn unknown(&self, face: FaceId) -> [bool; D] {
        let inside = self.problem.mesh().face(face).neighbour.is_some();
        if inside { [true; D] } else { self.problem.supported(face) }
    }

    /// Whether the moments of a face may have a part along it, or across it.
    fn contain(&self, face: FaceId, along: bool) -> bool {
        let unknown = self.unknown(face);
        if unknown == [true; D] || unknown == [false; D] {
            return unknown == [true; D];
        }
        // A face along an axis alone has one of both in the one direction of its support.
        (0..D).any(|c| unknown[c] != along && self.problem.mesh().stands_across(face, c))
    }

    /// Which modes a node has: both forces and the couple, as far as all edges around it let them through.
    fn modes_of(&self, node: NodeId) -> [bool; 3] {
        let mut modes = [true; 3];
        for link in self.problem.mesh().stars().star(node).links {
            let Some(face) = *link else { return [false; 3] };
            let unknown = self.unknown(face);
            let own = [unknown[0], unknown[D - 1], self.contain(face, false)];
            (0..3).for_each(|i| modes[i] &= own[i]);
        }
        modes
    }

    /// Sectors of a node: none if it has no modes.
    fn sectors_of(&self, node: NodeId) -> usize {
        let star = self.problem.mesh().stars().star(node);
        match self.modes_of(node).contains(&true) {
            true if star.is_closed() => star.elements.len(),
            true => star.links.len(),
            false => 0,
        }
    }

    /// 1 if an element lies on the side of the neighbour of one of its edges.
    fn side(&self, e: usize, face: FaceId) -> usize {
        usize::from(self.problem.mesh().face(face).owner != ElementId::new(e))
    }

    /// No energy yet.
    fn empty(&self) -> Operator {
        let mesh = self.problem.mesh();
        let (nodes, edges) = (mesh.node_count(), self.numbers.edges());
        let mut operator = Operator {
            first_sector: vec![0],
            sectors: Vec::new(),
            with_nodes: Vec::with_capacity(edges),
            with_edges: Vec::with_capacity(edges),
            ends: vec![[[0.0; 3]; 3]; edges],
            node_scale: vec![[[0.0; 3]; 3]; nodes],
            edge_scale: vec![0.0; edges],
        };
        for node in 0..nodes {
            let sectors = operator.first_sector[node] + self.sectors_of(NodeId::new(node)) as u32;
            operator.first_sector.push(sectors);
            // Where an edge of the boundary has no neighbour, it meets itself, with entries 0.
            for edge in self.numbers.first_edge(node)..self.numbers.first_edge(node + 1) {
                operator.with_nodes.push(WithNodes { nodes: [node as u32; 4], entries: [[0.0; 3]; 4] });
                operator.with_edges.push(WithEdges { edges: [edge as u32; 4], entries: [0.0; 4] });
            }
        }
        operator.sectors = vec![Sector { spoke: 0, rim: NONE }; operator.first_sector[nodes] as usize];
        operator
    }

    /// Adds the form of an element, not yet scaled.
    fn add(&self, to: &mut Operator, e: usize, form: &ModeForm, lane: usize) {
        let mesh = self.problem.mesh();
        let (cell, faces) = (&mesh.nodes_of::<N>()[e], &mesh.faces_of::<N>()[e]);
        let number = [0, 1, 2].map(|k| self.numbers.of(faces[k]));
        let entry = |i: usize, j: usize| form[i][j].0[lane];
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let (lower, higher) = if cell[a] < cell[b] { (a, b) } else { (b, a) };
            let (at, side) = (number[k], self.side(e, faces[k]));
            let row = &mut to.with_nodes[at];
            for (slot, node) in [(0, lower), (1, higher), (2 + side, k)] {
                row.nodes[slot] = cell[node].index() as u32;
                (0..3).for_each(|c| row.entries[slot][c] += entry(edge(k), 3 * node + c));
            }
            let row = &mut to.with_edges[at];
            for (slot, other) in [(2 * side, a), (2 * side + 1, b)] {
                row.edges[slot] = number[other] as u32;
                row.entries[slot] += entry(edge(k), edge(other));
            }
            to.edge_scale[at] += entry(edge(k), edge(k));
            let (ends, own) = (&mut to.ends[at], &mut to.node_scale[cell[k].index()]);
            for i in 0..3 {
                (0..3).for_each(|j| ends[i][j] += entry(3 * lower + i, 3 * higher + j));
                (0..=i).for_each(|j| own[i][j] += entry(3 * k + i, 3 * k + j));
            }
        }
        (0..3).for_each(|i| self.add_sectors(to, e, i, &number));
    }

    /// Sets the edges around local node `i` of an element.
    fn add_sectors(&self, to: &mut Operator, e: usize, i: usize, number: &[usize; 3]) {
        let mesh = self.problem.mesh();
        let (cell, faces) = (&mesh.nodes_of::<N>()[e], &mesh.faces_of::<N>()[e]);
        let (node, sectors) = (cell[i], to.sectors(cell[i].index()));
        if sectors.is_empty() {
            return;
        }
        // The star enters by the edge to the next node and leaves by that to the one after it.
        let enter = sectors.start + self.elements[e].links[i][0].place() - mesh.stars().link_range(node).start;
        let leave = if enter + 1 < sectors.end { enter + 1 } else { sectors.start };
        for (at, k, other) in [(enter, (i + 2) % 3, (i + 1) % 3), (leave, (i + 1) % 3, (i + 2) % 3)] {
            to.sectors[at].spoke = 2 * number[k] as u32 + u32::from(cell[other] < node);
        }
        to.sectors[enter].rim = (2 * number[i] + self.side(e, faces[i])) as u32;
    }

    /// Turns the blocks of nodes and edges into their scales.
    fn factor(&self, operator: &mut Operator) {
        for node in 0..operator.node_scale.len() {
            let scale = &mut operator.node_scale[node];
            *scale = inverse_factor(scale, self.modes_of(NodeId::new(node)));
        }
        for face in (0..operator.edge_scale.len()).map(FaceId::new) {
            let scale = &mut operator.edge_scale[self.numbers.of(face)];
            *scale = if self.contain(face, true) && *scale > 0.0 { 1.0 / scale.sqrt() } else { 0.0 };
        }
    }
}

/// Scales all entries.
fn scale(operator: &mut Operator) {
    let Operator { with_nodes, with_edges, ends, node_scale, edge_scale, .. } = operator;
    for (edge, scale) in edge_scale.iter().enumerate() {
        let row = &mut with_nodes[edge];
        for (entries, node) in row.entries.iter_mut().zip(row.nodes) {
            *entries = node_scale[node as usize].map(|row| scale * (0..3).map(|c| row[c] * entries[c]).sum::<f64>());
        }
        let [lower, higher] = [0, 1].map(|end| &node_scale[row.nodes[end] as usize]);
        let half = ends[edge].map(|entries| higher.map(|row| (0..3).map(|c| row[c] * entries[c]).sum::<f64>()));
        ends[edge] = lower.map(|row| [0, 1, 2].map(|j| (0..3).map(|c| row[c] * half[c][j]).sum()));
        let row = &mut with_edges[edge];
        for (entry, other) in row.entries.iter_mut().zip(row.edges) {
            *entry *= scale * edge_scale[other as usize];
        }
    }
}

/// L⁻¹ of a matrix LLᵀ, of which the part on and below the diagonal is given, in these rows and columns; 0 in others,
/// and in all if it has none.
fn inverse_factor(a: &[[f64; 3]; 3], of: [bool; 3]) -> [[f64; 3]; 3] {
    let (mut l, mut inverse) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    for i in (0..3).filter(|&i| of[i]) {
        for j in (0..=i).filter(|&j| of[j]) {
            let rest = a[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i != j {
                l[i][j] = rest / l[j][j];
            } else if rest > 0.0 {
                l[i][i] = rest.sqrt();
            } else {
                return [[0.0; 3]; 3];
            }
        }
        inverse[i][i] = 1.0 / l[i][i];
        for j in 0..i {
            let sum = (j..i).map(|k| l[i][k] * inverse[k][j]).sum::<f64>();
            inverse[i][j] = -sum * inverse[i][i];
        }
    }
    inverse
}
