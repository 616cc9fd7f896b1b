//! The elements of the sweep, two and two across a common face.

use super::Reach;
use crate::ids::{ElementId, NodeId};
use crate::material::{LinearLaw, Tensor};
use crate::mesh::{Mesh, Strips};
use crate::problem::Problem;
use std::ops::Range;

/// A sweep goes over so many pairs at a time. Few of them let the elements of a chunk hide the time in which the nodes
/// of the next come from memory; fewer have more work at their ends.
pub(super) const CHUNK: usize = 32;

/// A partner of an element reaches at most so many nodes farther than the elements before. In a triangulation by levels
/// of nodes it would else reach a level farther: twice the nodes would be in work at a time, too many for the first
/// cache on meshes of some hundred thousand elements, and a step would take 1.4 times as long. With fewer nodes than
/// these, every fifth element would have no partner.
const AHEAD: usize = 16;

/// Numbers of the four nodes of a pair in its strip: A has nodes 0 to D, B has node 0 and nodes 2 to D + 1.
pub(crate) type PairNodes = [u32; 4];

/// √(|E| G) ∇φ_i in two pairs: `[i][2 (2 p + l) + b]` is component b at node i + 1 + l of element l of pair p.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct Gradients(pub(crate) [[f64; 8]; 2]);

/// Pairs of elements of one law.
#[derive(Clone, Copy, Debug)]
struct Chunk {
    /// Where the quads of the next chunk begin.
    end: u32,
    law: u32,
    reach: Reach,
}

/// The elements of all strips in pairs, and the pairs two and two: 40 bytes for each element of a plane mesh.
#[derive(Clone, Debug)]
pub(super) struct ElementPairs {
    nodes: Vec<[PairNodes; 2]>,
    gradients: Vec<Gradients>,
    chunks: Vec<Chunk>,
    /// Where the chunks of each strip begin.
    of_strip: Vec<u32>,
    /// (λ + 2G)/G and λ/G of the laws.
    laws: Vec<[f64; 2]>,
}

/// One chunk as the sweep needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChunkData<'a> {
    pub(crate) nodes: &'a [[PairNodes; 2]],
    pub(crate) gradients: &'a [Gradients],
    pub(crate) law: [f64; 2],
}

/// An element and the element across one of its faces, if it has a partner.
pub(super) struct Pair {
    first: ElementId,
    second: Option<ElementId>,
    /// The local node of the first element that the second does not have.
    apart: usize,
}

impl Pair {
    /// The nodes, in the order of [`PairNodes`]; those that it does not have are the first.
    pub(super) fn nodes<const D: usize>(&self, mesh: &Mesh) -> [NodeId; 4] {
        let (cell, corners) = (mesh.cell(self.first), D + 1);
        // Node 1 of A is the one that B does not have.
        let order = |i: usize| cell[(self.apart + corners - 1 + i) % corners];
        let mut nodes = [order(0); 4];
        (1..corners).for_each(|i| nodes[i] = order(i));
        if let Some(second) = self.second {
            let other = mesh.cell(second).iter().find(|node| !cell.contains(node));
            nodes[corners] = other.copied().unwrap_or(order(0));
        }
        nodes
    }

    /// The elements, each with its place in the pair and ∇φ of its nodes but the first.
    pub(super) fn elements<const D: usize>(&self, mesh: &Mesh) -> impl Iterator<Item = (usize, ElementId, Tensor<D>)> {
        let nodes = self.nodes::<D>(mesh);
        [Some(self.first), self.second].into_iter().flatten().enumerate().map(move |(l, element)| {
            let (cell, slopes) = (mesh.cell(element), mesh.gradients_in::<D>(element));
            let place = |i: usize| cell.iter().position(|node| *node == nodes[i + 1 + l]).unwrap_or(0);
            (l, element, std::array::from_fn(|i| slopes[place(i)]))
        })
    }
}

impl ElementPairs {
    pub(super) fn new<const D: usize>(problem: &Problem<D>, strips: &Strips) -> Self {
        let (laws, law_of_material) = laws(problem);
        let half = problem.mesh().element_count() / 4 + strips.count();
        let mut all = Self {
            nodes: Vec::with_capacity(half),
            gradients: Vec::with_capacity(half),
            chunks: Vec::new(),
            of_strip: vec![0],
            laws,
        };
        let mut taken = vec![false; problem.mesh().element_count()];
        for strip in 0..strips.count() {
            let first_chunk = all.chunks.len();
            let law = |e: usize| law_of_material[usize::from(problem.element_material()[e])];
            in_chunks(problem, strips.elements(strip), &mut taken, law, |pairs, law| {
                all.add(problem, strips.nodes(strip).start, pairs, law);
            });
            Reach::close(all.chunks[first_chunk..].iter_mut().map(|chunk| &mut chunk.reach), strips.nodes(strip).len());
            all.of_strip.push(all.chunks.len() as u32);
        }
        all.nodes.shrink_to_fit();
        all.gradients.shrink_to_fit();
        all
    }

    /// Adds a chunk of pairs.
    fn add<const D: usize>(&mut self, problem: &Problem<D>, start: usize, pairs: &[Pair], law: u32) {
        let mesh = problem.mesh();
        for two in pairs.chunks(2) {
            let (mut nodes, mut gradients) = ([[0; 4]; 2], Gradients::default());
            for (p, pair) in two.iter().enumerate() {
                nodes[p] = pair.nodes::<D>(mesh).map(|node| (node.index() - start) as u32);
                for (l, element, slopes) in pair.elements::<D>(mesh) {
                    let root = (problem.volume(element) * problem.material(element).moduli().1).sqrt();
                    for i in 0..D {
                        (0..D).for_each(|b| gradients.0[i][2 * (2 * p + l) + b] = root * slopes[i][b]);
                    }
                }
            }
            if two.len() == 1 {
                nodes[1] = [nodes[0][0]; 4];
            }
            self.nodes.push(nodes);
            self.gradients.push(gradients);
        }
        let quads = &self.nodes[self.chunks.last().map_or(0, |chunk| chunk.end as usize)..];
        let reach = Reach::of(quads.as_flattened().as_flattened().iter().copied());
        self.chunks.push(Chunk { end: self.nodes.len() as u32, law, reach });
    }

    /// The chunks of a strip, with their data.
    #[inline(always)]
    pub(super) fn strip(&self, strip: usize) -> impl Iterator<Item = (&Reach, ChunkData<'_>)> {
        let range = self.of_strip[strip] as usize..self.of_strip[strip + 1] as usize;
        let first = if range.start == 0 { 0 } else { self.chunks[range.start - 1].end as usize };
        self.chunks[range].iter().scan(
            first,
            #[inline(always)]
            |start, chunk| {
                let quads = *start..chunk.end as usize;
                *start = quads.end;
                let (nodes, gradients) = (&self.nodes[quads.clone()], &self.gradients[quads]);
                Some((&chunk.reach, ChunkData { nodes, gradients, law: self.laws[chunk.law as usize] }))
            },
        )
    }
}

/// The different laws, and that of each material.
fn laws<const D: usize>(problem: &Problem<D>) -> (Vec<[f64; 2]>, Vec<u32>) {
    let mut laws: Vec<[f64; 2]> = Vec::new();
    let of_material = problem.materials().iter().map(|material| {
        let (lambda, shear) = material.moduli();
        let law = [(lambda + 2.0 * shear) / shear, lambda / shear];
        let known = laws.iter().position(|other| *other == law);
        known.unwrap_or_else(|| {
            laws.push(law);
            laws.len() - 1
        }) as u32
    });
    let of_material = of_material.collect();
    (laws, of_material)
}

/// Hands the pairs of a strip to `add`, those of a chunk at a time, with their law.
pub(super) fn in_chunks<const D: usize>(
    problem: &Problem<D>,
    strip: Range<usize>,
    taken: &mut [bool],
    law: impl Fn(usize) -> u32,
    mut add: impl FnMut(&[Pair], u32),
) {
    let of = |pair: &Pair| law(pair.first.index());
    for window in pair(problem, strip, taken, &law).chunks_mut(CHUNK) {
        window.sort_by_key(of);
        window.chunk_by(|a, b| of(a) == of(b)).for_each(|same| add(same, of(&same[0])));
    }
}

/// Joins elements of a strip that share a face and a law: each with its free neighbour of the lowest number, if that
/// is not far ahead.
fn pair<const D: usize>(
    problem: &Problem<D>,
    strip: Range<usize>,
    taken: &mut [bool],
    law: impl Fn(usize) -> u32,
) -> Vec<Pair> {
    let mesh = problem.mesh();
    let highest = |e: usize| mesh.cell(ElementId::new(e)).iter().map(|node| node.index()).fold(0, usize::max);
    let (mut pairs, mut reached) = (Vec::with_capacity(strip.len() / 2 + strip.len() / 16 + 1), 0);
    for e in strip.clone() {
        reached = highest(e).max(reached);
        if std::mem::replace(&mut taken[e], true) {
            continue;
        }
        let first = ElementId::new(e);
        let mut partner: Option<(usize, usize)> = None;
        for (apart, face) in mesh.cell_faces(first).iter().enumerate() {
            let face = &mesh.face(*face);
            let other = face.across(first);
            let Some(other) = other.map(ElementId::index) else { continue };
            let free = strip.contains(&other) && !taken[other] && law(other) == law(e);
            if free && highest(other) <= reached + AHEAD && partner.is_none_or(|(known, _)| other < known) {
                partner = Some((other, apart));
            }
        }
        if let Some((other, _)) = partner {
            taken[other] = true;
        }
        let apart = partner.map_or(1, |(_, apart)| apart);
        pairs.push(Pair { first, second: partner.map(|(other, _)| ElementId::new(other)), apart });
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Elastic;
    use percute_testkit::random_rectangle;

    /// In the local numbering of an unstructured mesh, few more nodes than those of a level are in work at a time, and
    /// almost all elements have partners. At most 1.6 times as many nodes are in work as the longer side has elements;
    /// with partners a level farther, 3.1 times.
    #[test]
    fn pairs_keep_the_front_short() {
        let side = 120;
        let mesh = random_rectangle(1.0, 0.8, side, 5).unwrap();
        let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
        let mesh = Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &Default::default(), &Default::default()).unwrap();
        let numbering = mesh.local_numbering().unwrap();
        let law = Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap();
        let problem = Problem::<2>::builder(mesh).material(law).build().unwrap().renumbered(&numbering);
        let strips = Strips::new(problem.mesh());
        let pairs = ElementPairs::new(&problem, &strips);
        let longest =
            pairs.chunks.iter().map(|chunk| chunk.reach.reached.saturating_sub(chunk.reach.left)).max().unwrap();
        assert!((longest as usize) < 2 * side, "{longest}");
        let quads = 4 * pairs.nodes.len();
        assert!(quads * 100 < 108 * problem.mesh().element_count(), "{quads}");
    }
}
