//! The elements, two and two across a common face: a pair has four nodes to read and write where two triangles have
//! six.

use super::blocks::Blocks;
use super::lanes::{MOTIONS, place};
use super::weights::Shares;
use crate::smoothing::Smoothing;
use percute_core::cell::CellKind;
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::{Law, LinearLaw};
use percute_core::problem::Problem;
use percute_core::simd::Eight;
use std::ops::Range;

/// A pair of triangles A and B: A has its nodes 0, 1, 2 and B its nodes 0, 2, 3. A bar is a triangle whose nodes 0 and
/// 2, or 0 and 3, are one. Without a partner, B has no gradients and no mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrianglePair {
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

/// The elements and patches that the strains of a pair are smoothed with. The gradients of the elements of a pair have
/// the places 2k and 2k + 1, k its number among all pairs.
#[derive(Clone, Copy, Debug)]
pub(super) struct PairSurroundings {
    /// The places of the elements beyond the faces of A and of B; those of the elements themselves at the boundary of
    /// a material.
    pub(super) beyond: [[u32; 3]; 2],
    /// (1 − β)/(3(V_E + V_F)) at these faces (1/m³).
    pub(super) weights: [[f64; 3]; 2],
    /// The patches at the nodes 0, 1, 2, 3, counted from the first one of the block.
    pub(super) patches: [u32; 4],
    /// √V of A and B.
    pub(super) roots: [f64; 2],
}

/// The moduli of all laws.
#[derive(Clone, Debug)]
pub(super) struct Laws {
    pub(super) plain: Vec<Moduli>,
    /// Those for the part of each motion that is made of plain strains, where the others are smoothed.
    pub(super) rest: Vec<Moduli>,
    /// Those for smoothed strains; the first pair of motions has such.
    pub(super) smoothed: Vec<Moduli>,
    /// 1/(3t) with the thickness t (1/m).
    pub(super) thirds: Vec<f64>,
}

/// All elements, block by block.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    pairs: Vec<TrianglePair>,
    /// Empty where strains stay.
    around: Vec<PairSurroundings>,
    /// Where those of each block begin.
    starts: Vec<u32>,
    pub(super) laws: Laws,
}

impl Pairs {
    /// Those of motions with these shares of smoothed strains.
    pub(super) fn new<const D: usize>(
        problem: &Problem<D>,
        blocks: &Blocks,
        smoothing: &Smoothing,
        shares: &[Shares; MOTIONS],
    ) -> Self {
        let count = problem.mesh().element_count();
        let (mut pairs, mut starts) = (Vec::with_capacity(count / 2 + count / 16), vec![0]);
        let mut elements: Vec<[Option<ElementId>; 2]> = Vec::new();
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
                    let mut pair = TrianglePair::new(problem, ElementId::new(e), apart, partner);
                    pair.nodes = pair.nodes.map(|n| n - first);
                    pairs.push(pair);
                    elements.push([Some(ElementId::new(e)), partner]);
                }
            }
            starts.push(pairs.len() as u32);
        }
        pairs.shrink_to_fit();
        let laws = Laws::new(problem, shares);
        let mut made = Self { pairs, around: Vec::new(), starts, laws };
        if smoothing.smooths() {
            made.add_around(problem, blocks, smoothing, &elements);
        }
        made
    }

    fn add_around<const D: usize>(
        &mut self,
        problem: &Problem<D>,
        blocks: &Blocks,
        smoothing: &Smoothing,
        elements: &[[Option<ElementId>; 2]],
    ) {
        let mut places = vec![0; problem.mesh().element_count()];
        for (place, element) in elements.as_flattened().iter().enumerate() {
            element.iter().for_each(|element| places[element.index()] = place as u32);
        }
        for block in 0..blocks.count() {
            let first = smoothing.patches(&blocks.nodes(block)).start;
            let first_node = blocks.nodes(block).start;
            for k in self.starts[block] as usize..self.starts[block + 1] as usize {
                let nodes = self.pairs[k].nodes.map(|n| NodeId::new(n as usize + first_node));
                let mut around = PairSurroundings::new(problem, smoothing, elements[k], &places, [2 * k, 2 * k + 1]);
                around.patches = nodes.map(|node| (smoothing.patch(node, self.pairs[k].law as u16) - first) as u32);
                self.around.push(around);
            }
        }
    }

    /// Those of a block.
    #[inline(always)]
    pub(super) fn block(&self, block: usize) -> &[TrianglePair] {
        &self.pairs[self.range(block)]
    }

    /// What is around them.
    #[inline(always)]
    pub(super) fn around(&self, block: usize) -> &[PairSurroundings] {
        &self.around[self.range(block)]
    }

    /// What is around a pair; none where strains stay.
    pub(super) fn around_pair(&self, number: usize) -> Option<&PairSurroundings> {
        self.around.get(number)
    }

    /// The numbers of those of a block among all.
    #[inline(always)]
    pub(super) fn range(&self, block: usize) -> Range<usize> {
        self.starts[block] as usize..self.starts[block + 1] as usize
    }

    /// The places of the gradients of these blocks.
    pub(super) fn places(&self, blocks: Range<usize>) -> Range<usize> {
        if self.around.is_empty() {
            return 0..0;
        }
        2 * self.starts[blocks.start] as usize..2 * self.starts[blocks.end] as usize
    }
}

impl PairSurroundings {
    /// What is around a pair whose elements have these places, but for patches.
    fn new<const D: usize>(
        problem: &Problem<D>,
        smoothing: &Smoothing,
        pair: [Option<ElementId>; 2],
        places: &[u32],
        own: [usize; 2],
    ) -> Self {
        let mut made = Self {
            beyond: own.map(|place| [place as u32; 3]),
            weights: [[0.0; 3]; 2],
            patches: [0; 4],
            roots: pair.map(|element| element.map_or(0.0, |element| problem.volume(element).sqrt())),
        };
        for (which, element) in pair.into_iter().enumerate() {
            let Some(element) = element else { continue };
            for (k, face) in problem.mesh().cell_faces(element).iter().enumerate() {
                let other = Smoothing::beyond(problem, element, *face);
                let volume = problem.volume(element) + problem.volume(other);
                made.beyond[which][k] = places[other.index()];
                made.weights[which][k] = smoothing.edge_weight(problem.mesh().cell(element)[0], volume);
            }
        }
        made
    }
}

impl Laws {
    fn new<const D: usize>(problem: &Problem<D>, shares: &[Shares; MOTIONS]) -> Self {
        let shape = problem.mesh().kind();
        let plain: Vec<Moduli> = problem.materials().iter().map(|law| Moduli::new(law, shape)).collect();
        let smoothed = shares.map(|share| share.space);
        Self {
            rest: plain.iter().map(|moduli| moduli.scaled(&smoothed.map(|share| 1.0 - share))).collect(),
            smoothed: plain.iter().map(|moduli| moduli.scaled(&smoothed)).collect(),
            plain,
            thirds: problem.materials().iter().map(|law| 1.0 / (3.0 * law.extent())).collect(),
        }
    }
}

/// The free neighbour with the lowest number of an element, in this range and of its law, and the local node that it
/// does not have.
fn partner<const D: usize>(
    problem: &Problem<D>,
    e: usize,
    range: &Range<usize>,
    taken: &[bool],
) -> (usize, Option<ElementId>) {
    let (mesh, laws, id) = (problem.mesh(), problem.element_material(), ElementId::new(e));
    let mut found: (usize, Option<ElementId>) = (1, None);
    for (apart, &face) in mesh.cell_faces(id).iter().enumerate() {
        let face = &mesh.face(face);
        let Some(other) = face.across(id) else { continue };
        let o = other.index();
        if range.contains(&o) && !taken[o] && laws[o] == laws[e] && found.1.is_none_or(|known| other < known) {
            found = (apart, Some(other));
        }
    }
    found
}

impl TrianglePair {
    /// An element and its partner, which does not have the local node `apart`.
    fn new<const D: usize>(problem: &Problem<D>, first: ElementId, apart: usize, second: Option<ElementId>) -> Self {
        let mesh = problem.mesh();
        let cell = mesh.cell(first);
        let local = |i: usize| cell[(apart + cell.len() - 1 + i) % cell.len()];
        // Nodes 1 and 3 are those apart.
        let shape = mesh.kind();
        let shared = match shape {
            CellKind::Bar => local(0),
            CellKind::Triangle => local(2),
            CellKind::Tetrahedron => unreachable!("solids have an auxiliary solution of their own"),
        };
        let other = second.and_then(|second| mesh.cell(second).iter().find(|node| !cell.contains(node)));
        let nodes = [local(0), local(1), shared, *other.unwrap_or(&local(0))];
        let gradient = |element: Option<ElementId>, node: NodeId| {
            let mut gradient = [0.0; 2];
            if let Some(element) = element.filter(|_| node != nodes[0]) {
                let at = mesh.local_node(element, node).map(|i| mesh.gradients_in::<D>(element)[i]);
                let root = problem.volume(element).sqrt();
                at.iter().flatten().zip(&mut gradient).for_each(|(g, to)| *to = root * g);
            }
            gradient
        };
        let as_triangle = match shape {
            CellKind::Bar => 0.75,
            CellKind::Triangle => 1.0,
            CellKind::Tetrahedron => unreachable!("solids have an auxiliary solution of their own"),
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
    fn new(law: &impl LinearLaw, shape: CellKind) -> Self {
        let (lambda, shear) = law.moduli();
        let normal = lambda + 2.0 * shear;
        let shear = match shape {
            CellKind::Bar => 0.0,
            CellKind::Triangle => shear,
            CellKind::Tetrahedron => unreachable!("solids have an auxiliary solution of their own"),
        };
        let by_place = |along: f64| {
            [0, 1].map(|column| {
                let mut moduli = [0.0; 8];
                for motion in 0..MOTIONS {
                    (0..2).for_each(|c| moduli[place(motion, c)] = if c == column { along } else { shear });
                }
                moduli
            })
        };
        Self { own: by_place(normal), partner: by_place(lambda) }
    }

    /// The moduli of each motion times its factor.
    fn scaled(&self, factors: &[f64; MOTIONS]) -> Self {
        let scaled = |moduli: [Eight; 2]| {
            moduli.map(|mut column| {
                for (motion, factor) in factors.iter().enumerate() {
                    (0..2).for_each(|c| column[place(motion, c)] *= factor);
                }
                column
            })
        };
        Self { own: scaled(self.own), partner: scaled(self.partner) }
    }
}
