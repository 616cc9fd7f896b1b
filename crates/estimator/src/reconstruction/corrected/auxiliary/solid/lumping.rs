//! The lumping difference μ = 1 − M⁻¹M_c of a solid.
//!
//! An element takes from M − M_c the share m/((D + 1)(D + 2)) of the difference of each two of its nodes. Between two
//! nodes these shares are summed up once; a field then needs the neighbours of each node and no elements.

use crate::parallel::by_pieces;
use percute_core::ids::NodeId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use std::array::from_fn;

/// The nodes with which each node has elements.
#[derive(Clone, Debug)]
pub(super) struct LumpingGraph {
    /// Where the neighbours of each node begin.
    starts: Vec<u32>,
    neighbours: Vec<Neighbour>,
}

/// A node beside another one.
#[derive(Clone, Copy, Debug)]
struct Neighbour {
    node: u32,
    /// Σ m/((D + 1)(D + 2)) over the elements of both (kg).
    share: f64,
}

impl LumpingGraph {
    pub(super) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let mesh = problem.mesh();
        let mut made = Self { starts: vec![0], neighbours: Vec::new() };
        for node in (0..mesh.node_count()).map(NodeId::new) {
            let first = made.neighbours.len();
            for element in mesh.stars().star(node).elements {
                let mass = problem.material(*element).density() * problem.volume(*element);
                let share = mass / ((D + 1) * (D + 2)) as f64;
                let others = mesh.cell(*element).iter().filter(|other| **other != node);
                made.neighbours.extend(others.map(|other| Neighbour { node: other.index() as u32, share }));
            }
            made.join(first);
            made.starts.push(made.neighbours.len() as u32);
        }
        made
    }

    /// Joins the entries of a node, from this one on, that have the same neighbour.
    fn join(&mut self, first: usize) {
        self.neighbours[first..].sort_by_key(|neighbour| neighbour.node);
        let mut last = first;
        for k in first + 1..self.neighbours.len() {
            let next = self.neighbours[k];
            if next.node == self.neighbours[last].node {
                self.neighbours[last].share += next.share;
            } else {
                last += 1;
                self.neighbours[last] = next;
            }
        }
        self.neighbours.truncate((last + 1).min(self.neighbours.len()));
    }

    /// The lumping difference at a node, with these inverse masses of its components (1/kg).
    #[inline(always)]
    pub(super) fn at<const D: usize>(&self, node: usize, inverse_mass: &[f64; D], field: &[[f64; D]]) -> [f64; D] {
        let (own, mut sum) = (field[node], [0.0; D]);
        for neighbour in &self.neighbours[self.starts[node] as usize..self.starts[node + 1] as usize] {
            let other = &field[neighbour.node as usize];
            (0..D).for_each(|c| sum[c] += neighbour.share * (own[c] - other[c]));
        }
        from_fn(|c| inverse_mass[c] * sum[c])
    }

    /// The lumping difference of a field.
    pub(super) fn apply<const D: usize>(&self, inverse_mass: &[[f64; D]], field: &[[f64; D]], to: &mut [[f64; D]]) {
        by_pieces((to, inverse_mass), &|first, (to, inverse_mass)| {
            for (k, (to, inverse)) in to.iter_mut().zip(inverse_mass).enumerate() {
                *to = self.at(first + k, inverse, field);
            }
        });
    }
}
