//! The elements, two and two across a common facet: a pair has four nodes to read and write where two triangles have
//! six.

use super::blocks::Blocks;
use super::lanes::place;
use crate::simd::Eight;
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::{Law, LinearLaw};
use percute_core::problem::Problem;
use percute_core::simplex::Shape;
use std::ops::Range;

/// A pair of triangles A and B: A has its nodes 0, 1, 2 and B its nodes 0, 2, 3. A bar is a triangle whose nodes 0 and
/// 2, or 0 and 3, are one. Without a partner, B has no gradients and no mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// Nodes are counted from the first one of the block.
    pub(super) nodes: [u32; 4],
    /// √V ∇φ, V the volume (m³), at the nodes 1 and 2 of A and 2 and 3 of B; that at node 0 is minus the sum.
    pub(super) gradients: [[f64; 2]; 4],
    /// m/(D+2) of A and B, m the mass (kg); times ¾ in bars, so that the nodes 0 and 2 together are those of a bar.
    pub(super) shares: [f64; 2],
    pub(super) law: u32,
}

/// The moduli of a law (Pa), by place: the derivatives along x_b of all components make the column b of a gradient. A
/// stress in column b is `own` times the derivative of the same place plus `partner` times that of the place in the
/// other column with components exchanged: the other normal component, or the same shear component.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Moduli {
    pub(super) own: [Eight; 2],
    pub(super) partner: [Eight; 2],
}

/// All elements, block by block.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    pairs: Vec<Pair>,
    /// Where those of each block begin.
    starts: Vec<u32>,
    pub(super) laws: Vec<Moduli>,
}

impl Pairs {
    pub(super) fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, blocks: &Blocks) -> Self {
        let count = problem.mesh().element_count();
        let (mut pairs, mut starts) = (Vec::with_capacity(count / 2 + count / 16), vec![0]);
        let mut taken = vec![false; count];
        for block in 0..blocks.count() {
            let (range, first) = (blocks.elements(block), blocks.nodes(block).start as u32);
            for e in range.clone() {
                if !taken[e] {
                    let (apart, partner) = partner(problem, e, &range, &taken);
                    taken[e] = true;
                    if let Some(other) = partner {
                        taken[other.index()] = true;
                    }
                    let mut pair = Pair::new(problem, ElementId::new(e), apart, partner);
                    pair.nodes = pair.nodes.map(|n| n - first);
                    pairs.push(pair);
                }
            }
            starts.push(pairs.len() as u32);
        }
        pairs.shrink_to_fit();
        let shape = problem.mesh().simplex().shape();
        Self { pairs, starts, laws: problem.materials().iter().map(|law| Moduli::new::<D>(law, shape)).collect() }
    }

    /// Those of a block.
    #[inline(always)]
    pub(super) fn block(&self, block: usize) -> &[Pair] {
        &self.pairs[self.starts[block] as usize..self.starts[block + 1] as usize]
    }
}

/// The free neighbour with the lowest number of an element, in this range and of its law, and the local node that it
/// does not have.
fn partner<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    e: usize,
    range: &Range<usize>,
    taken: &[bool],
) -> (usize, Option<ElementId>) {
    let (mesh, laws, id) = (problem.mesh(), problem.element_material(), ElementId::new(e));
    let mut found: (usize, Option<ElementId>) = (1, None);
    for (apart, facet) in mesh.cell_facets()[e].iter().enumerate() {
        let facet = &mesh.facets()[facet.index()];
        let Some(other) = (if facet.owner == id { facet.neighbour } else { Some(facet.owner) }) else { continue };
        let o = other.index();
        if range.contains(&o) && !taken[o] && laws[o] == laws[e] && found.1.is_none_or(|known| other < known) {
            found = (apart, Some(other));
        }
    }
    found
}

impl Pair {
    /// An element and its partner, which does not have the local node `apart`.
    fn new<const D: usize, const N: usize>(
        problem: &Problem<D, N>,
        first: ElementId,
        apart: usize,
        second: Option<ElementId>,
    ) -> Self {
        let mesh = problem.mesh();
        let cell = &mesh.cells()[first.index()];
        let local = |i: usize| cell[(apart + N - 1 + i) % N];
        // Nodes 1 and 3 are those apart.
        let shape = mesh.simplex().shape();
        let shared = match shape {
            Shape::Bar => local(0),
            Shape::Triangle => local(2),
        };
        let other = second.and_then(|second| mesh.cells()[second.index()].iter().find(|node| !cell.contains(node)));
        let nodes = [local(0), local(1), shared, *other.unwrap_or(&local(0))];
        let gradient = |element: Option<ElementId>, node: NodeId| {
            let mut gradient = [0.0; 2];
            if let Some(element) = element.filter(|_| node != nodes[0]) {
                let at = mesh.local_node(element, node).map(|i| mesh.cell_geometry(element).gradients[i]);
                let root = problem.volume(element).sqrt();
                at.iter().flatten().zip(&mut gradient).for_each(|(g, to)| *to = root * g);
            }
            gradient
        };
        let as_triangle = match shape {
            Shape::Bar => 0.75,
            Shape::Triangle => 1.0,
        };
        let share = |element: Option<ElementId>| {
            let mass = element.map_or(0.0, |e| problem.material(e).density() * problem.volume(e));
            as_triangle * mass / (D + 2) as f64
        };
        let of = [(Some(first), 1), (Some(first), 2), (second, 2), (second, 3)];
        Self {
            nodes: nodes.map(|n| n.index() as u32),
            gradients: of.map(|(element, i)| gradient(element, nodes[i])),
            shares: [share(Some(first)), share(second)],
            law: u32::from(problem.element_material()[first.index()]),
        }
    }
}

impl Moduli {
    fn new<const D: usize>(law: &impl LinearLaw, shape: Shape) -> Self {
        let (lambda, shear) = law.moduli();
        let normal = lambda + 2.0 * shear;
        let shear = match shape {
            Shape::Bar => 0.0,
            Shape::Triangle => shear,
        };
        let by_place = |along: f64| {
            [0, 1].map(|column| {
                let mut moduli = [0.0; 8];
                for motion in 0..super::lanes::MOTIONS {
                    (0..2).for_each(|c| moduli[place(motion, c)] = if c == column { along } else { shear });
                }
                moduli
            })
        };
        Self { own: by_place(normal), partner: by_place(lambda) }
    }
}
