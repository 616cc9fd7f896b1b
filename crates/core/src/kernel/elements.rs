//! Internal forces of tetrahedra with any law: one point of integration in each, eight elements at a time.

use super::{Kernel, Reach};
use crate::material::{Elastic, MOST_VARIABLES, PointLaw};
use crate::mesh::Strips;
use crate::problem::Problem;
use crate::simd::lanes::{LANES, Lanes, Value};
use crate::simd::{Eight, Registers, Wide};
use std::ops::Range;

/// Nodes of an element.
const NODES: usize = 4;
/// Groups of a chunk, at the most: as many elements as in a chunk of pairs.
const GROUPS: usize = 8;

/// Eight elements of one law. Lanes that are left have no volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tetrahedra<const D: usize> {
    /// Their nodes in the strip.
    nodes: [[u32; LANES]; NODES],
    /// ∇φ of the nodes but the first (1/m).
    slopes: [[Lanes; D]; D],
    /// |E| (m³).
    volume: Lanes,
}

/// Groups of one law that are swept together.
#[derive(Clone, Debug)]
struct ElementChunk {
    groups: Range<u32>,
    law: u32,
    reach: Reach,
}

/// A chunk as the sweep needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementChunkData<'a, M, const D: usize> {
    groups: &'a [Tetrahedra<D>],
    /// Numbers of the elements in the strip.
    elements: &'a [[u32; LANES]],
    law: &'a M,
}

/// The elements of all strips.
#[derive(Clone, Debug)]
pub(crate) struct ElementKernel<M, const D: usize> {
    strips: Strips,
    groups: Vec<Tetrahedra<D>>,
    /// Their elements, apart from them: only laws with internal variables read these.
    elements: Vec<[u32; LANES]>,
    chunks: Vec<ElementChunk>,
    /// Where the chunks of each strip begin.
    of_strip: Vec<usize>,
    laws: Vec<M>,
}

impl<M: PointLaw, const D: usize> ElementKernel<M, D> {
    /// That of a problem, with a law for each material.
    pub(crate) fn new(problem: &Problem<D>, law: impl Fn(&Elastic) -> M) -> Self {
        let laws = problem.materials().iter().map(law).collect();
        Self::with_laws(problem, Strips::new(problem.mesh()), laws)
    }

    /// The same with these strips.
    fn with_laws(problem: &Problem<D>, strips: Strips, laws: Vec<M>) -> Self {
        let (groups, elements, chunks) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = Self { strips, groups, elements, chunks, of_strip: vec![0], laws };
        for strip in 0..all.strips.count() {
            let (nodes, elements) = (all.strips.nodes(strip), all.strips.elements(strip));
            let first_chunk = all.chunks.len();
            let law = |e: &usize| problem.element_material()[*e];
            let mut window: Vec<usize> = Vec::with_capacity(GROUPS * LANES);
            for first in elements.clone().step_by(GROUPS * LANES) {
                window.clear();
                window.extend(first..elements.end.min(first + GROUPS * LANES));
                window.sort_by_key(law);
                for same in window.chunk_by(|a, b| law(a) == law(b)) {
                    all.add(problem, [nodes.start, elements.start], same, law(&same[0]).into());
                }
            }
            Reach::close(all.chunks[first_chunk..].iter_mut().map(|chunk| &mut chunk.reach), nodes.len());
            all.of_strip.push(all.chunks.len());
        }
        all
    }

    /// Adds a chunk of elements.
    fn add(&mut self, problem: &Problem<D>, starts: [usize; 2], elements: &[usize], law: u32) {
        let from = self.groups.len();
        for eight in elements.chunks(LANES) {
            self.groups.push(Tetrahedra::new(problem, starts[0], eight));
            let mut numbers = [0; LANES];
            numbers.iter_mut().zip(eight).for_each(|(number, e)| *number = (e - starts[1]) as u32);
            self.elements.push(numbers);
        }
        let nodes = self.groups[from..].iter().flat_map(|group| group.nodes.into_iter().flatten());
        self.chunks.push(ElementChunk { reach: Reach::of(nodes), groups: from as u32..self.groups.len() as u32, law });
    }
}

impl<const D: usize> Tetrahedra<D> {
    fn new(problem: &Problem<D>, first_node: usize, elements: &[usize]) -> Self {
        let mesh = problem.mesh();
        let node = |e: usize, i: usize| (mesh.cell(crate::ids::ElementId::new(e))[i].index() - first_node) as u32;
        // Lanes that are left move with a node of the group.
        let mut group =
            Self { nodes: [[node(elements[0], 0); LANES]; NODES], slopes: [[Lanes::ZERO; D]; D], volume: Lanes::ZERO };
        for (lane, &e) in elements.iter().enumerate() {
            let element = crate::ids::ElementId::new(e);
            let slopes = mesh.gradients_in::<D>(element);
            (0..NODES).for_each(|i| group.nodes[i][lane] = node(e, i));
            group.volume.0[lane] = problem.volume(element);
            for i in 0..D {
                (0..D).for_each(|b| group.slopes[i][b].0[lane] = slopes[i + 1][b]);
            }
        }
        group
    }

    /// Component c of a field at a node of each element.
    #[inline(always)]
    fn at<R: Registers>(&self, like: Wide<R>, u: &[[f64; D]], node: usize, c: usize) -> Wide<R> {
        like.load(&Lanes::at_levels(
            #[inline(always)]
            |lane| u[self.nodes[node][lane] as usize][c],
        ))
    }

    /// H = ∂u_a/∂X_b.
    #[inline(always)]
    fn gradient<R: Registers>(&self, like: Wide<R>, u: &[[f64; D]]) -> [[Wide<R>; D]; D] {
        let mut gradient = [[like; D]; D];
        for a in 0..D {
            let base = self.at(like, u, 0, a);
            for i in 0..D {
                let difference = self.at(like, u, i + 1, a) - base;
                for b in 0..D {
                    let part = difference * like.load(&self.slopes[i][b]);
                    gradient[a][b] = if i == 0 { part } else { gradient[a][b] + part };
                }
            }
        }
        gradient
    }

    /// Subtracts the forces of P times the volume.
    #[inline(always)]
    fn subtract<R: Registers>(&self, like: Wide<R>, stress: &[[Wide<R>; D]; D], from: &mut [[f64; D]]) {
        for a in 0..D {
            let mut base = like.zero();
            for i in 0..D {
                let mut force = stress[a][0] * like.load(&self.slopes[i][0]);
                (1..D).for_each(|b| force += stress[a][b] * like.load(&self.slopes[i][b]));
                base += force;
                let force = force.store();
                (0..LANES).for_each(|lane| from[self.nodes[i + 1][lane] as usize][a] -= force.0[lane]);
            }
            let base = base.store();
            (0..LANES).for_each(|lane| from[self.nodes[0][lane] as usize][a] += base.0[lane]);
        }
    }
}

impl<M: PointLaw, const D: usize> Kernel<D> for ElementKernel<M, D> {
    type Chunk<'a>
        = ElementChunkData<'a, M, D>
    where
        M: 'a;

    fn strips(&self) -> &Strips {
        &self.strips
    }

    fn variables(&self) -> usize {
        M::variables::<D>()
    }

    #[inline(always)]
    fn chunks(&self, strip: usize) -> impl Iterator<Item = (&Reach, ElementChunkData<'_, M, D>)> {
        self.chunks[self.of_strip[strip]..self.of_strip[strip + 1]].iter().map(
            #[inline(always)]
            |chunk| {
                let groups = chunk.groups.start as usize..chunk.groups.end as usize;
                let (elements, law) = (&self.elements[groups.clone()], &self.laws[chunk.law as usize]);
                (&chunk.reach, ElementChunkData { groups: &self.groups[groups], elements, law })
            },
        )
    }

    #[inline(always)]
    fn sweep<L: Registers>(
        &self,
        lanes: L,
        chunk: &ElementChunkData<'_, M, D>,
        displacement: &[[f64; D]],
        internal: &mut [f64],
        force: &mut [[f64; D]],
        energy: &mut Eight,
    ) {
        let like = Wide::zeros(lanes);
        // One check of an index is enough for both.
        let force = &mut force[..displacement.len()];
        let (mut total, count) = (like, M::variables::<D>());
        for (group, elements) in chunk.groups.iter().zip(chunk.elements) {
            let gradient = group.gradient(like, displacement);
            let mut variables = [like; MOST_VARIABLES];
            for k in 0..count {
                variables[k] = like.load(&Lanes::at_levels(|lane| internal[count * elements[lane] as usize + k]));
            }
            let (mut stress, density) = chunk.law.respond(&gradient, &mut variables[..count]);
            let volume = like.load(&group.volume);
            for k in 0..count {
                let stored = variables[k].store();
                for lane in (0..LANES).filter(|lane| group.volume.0[*lane] > 0.0) {
                    internal[count * elements[lane] as usize + k] = stored.0[lane];
                }
            }
            total += density * volume;
            stress.iter_mut().flatten().for_each(|stress| *stress = *stress * volume);
            group.subtract(like, &stress, force);
        }
        *energy = (like.load(&Lanes(*energy)) + total * 2.0).store().0;
    }
}
