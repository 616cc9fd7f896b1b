//! Smoothed strains at one level, or at some side by side. Of bodies that turn the second Piola–Kirchhoff stresses are
//! smoothed: they do not change with a rotation, as strains of elements that turn by unlike angles do.

use super::Smoothing;
use crate::blocks::{BLOCK, ElementBlocks};
use crate::deformation::second_stress;
use crate::element::Element;
use crate::field_lanes::FieldLanes;
use crate::parallel::by_pieces;
use crate::pool::Pool;
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Elastic;
use percute_core::problem::Problem;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value};
use percute_core::simd::{Registers, Task, run_task};
use rayon::prelude::*;

/// Components of a strain: ε_xx, ε_yy, ε_xy.
const COMPONENTS: usize = 3;

/// The strains of which smoothed ones are made, of all elements at one level or some; S of finite laws.
#[derive(Clone, Debug, Default)]
pub(crate) struct SmoothedStrains<S = Lanes> {
    /// Of each element.
    strains: Vec<[S; COMPONENTS]>,
    /// β/(3V) Σ|E|ε_E of each patch.
    patches: Vec<[S; COMPONENTS]>,
    /// 1 at the levels whose strains are smoothed, 0 at others.
    share: S,
}

/// Displacements of some levels, and whether the strains of each are smoothed.
pub(crate) type Displacements<'a, const D: usize> = [(&'a [[f64; D]], bool)];

/// The data of the elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smoothed<'a, const D: usize, const N: usize> {
    pub(crate) problem: &'a Problem<D>,
    pub(crate) smoothing: &'a Smoothing,
    pub(crate) elements: &'a [Element<D, N>],
}

impl SmoothedStrains {
    /// Takes in displacements (m). Each element and each patch is summed up by itself.
    pub(crate) fn fill<const D: usize, const N: usize>(
        &mut self,
        of: Smoothed<'_, D, N>,
        blocks: &ElementBlocks<N>,
        displacements: &Displacements<'_, D>,
    ) {
        self.share = Lanes::at_levels(|k| if displacements.get(k).is_some_and(|level| level.1) { 1.0 } else { 0.0 });
        self.strains.resize(of.elements.len(), [Lanes::ZERO; COMPONENTS]);
        self.patches.resize(of.smoothing.patch_count(), [Lanes::ZERO; COMPONENTS]);
        let room = Pool::new();
        self.strains.par_chunks_mut(BLOCK).enumerate().for_each(|(block, strains)| {
            room.lend(FieldLanes::default, |fields| {
                run_task(StrainsOfBlock { of, blocks, displacements, block, fields, strains });
            });
        });
        let strains = &self.strains;
        let parts = patches_of_nodes(of.smoothing, &mut self.patches);
        parts.into_par_iter().for_each(|part| run_task(PatchesOfNodes { of, strains, part }));
    }
}

impl SmoothedStrains<f64> {
    /// Takes in the displacements of one level (m), whose strains are smoothed.
    pub(crate) fn fill_one<const D: usize, const N: usize>(
        &mut self,
        of: Smoothed<'_, D, N>,
        displacement: &[[f64; D]],
    ) {
        self.share = 1.0;
        self.strains.resize(of.elements.len(), [0.0; COMPONENTS]);
        self.patches.resize(of.smoothing.patch_count(), [0.0; COMPONENTS]);
        by_pieces((&mut self.strains[..], of.elements), &|first, (strains, elements)| {
            for (k, (strain, element)) in strains.iter_mut().zip(elements).enumerate() {
                let gradient = element.gradient(&element.gather(displacement));
                *strain = averaged(of.problem.material(ElementId::new(first + k)), &gradient);
            }
        });
        let (strains, parts) = (&self.strains, patches_of_nodes(of.smoothing, &mut self.patches));
        let sum = |part: OfNodes<'_, f64>| sum_patches(0.0, of, strains, part);
        // Without a pool, rayon would start one of its own.
        match rayon::current_thread_index() {
            Some(_) => parts.into_par_iter().for_each(sum),
            None => parts.into_iter().for_each(sum),
        }
    }
}

impl<S: Copy> SmoothedStrains<S> {
    /// The strain of an element of which σ̄ is made: smoothed where it is, the plain one at other levels.
    #[inline(always)]
    pub(crate) fn of<T: Value<Stored = S>, const D: usize, const N: usize>(
        &self,
        like: T,
        Smoothed { problem, smoothing, elements }: Smoothed<'_, D, N>,
        element: ElementId,
    ) -> [[T; D]; D] {
        let (mesh, volume) = (problem.mesh(), elements[element.index()].volume);
        let own = self.strains[element.index()].map(
            #[inline(always)]
            |x| like.load(&x),
        );
        let mut smooth = [like.zero(); COMPONENTS];
        for face in mesh.faces_of::<N>()[element.index()] {
            let other = Smoothing::beyond(problem, element, face);
            let beyond = elements[other.index()].volume;
            let weight = smoothing.edge_weight(mesh.nodes_of::<N>()[element.index()][0], volume + beyond);
            let (mine, beyond) = (weight * volume, weight * beyond);
            for c in 0..COMPONENTS {
                smooth[c] += own[c] * mine + like.load(&self.strains[other.index()][c]) * beyond;
            }
        }
        let material = problem.element_material()[element.index()];
        for node in &mesh.nodes_of::<N>()[element.index()] {
            let patch = &self.patches[smoothing.patch(*node, material)];
            for c in 0..COMPONENTS {
                smooth[c] += like.load(&patch[c]);
            }
        }
        let share = like.load(&self.share);
        let blend = |c: usize| own[c] + share * (smooth[c] - own[c]);
        let mut strain = [[blend(2); D]; D];
        (strain[0][0], strain[D - 1][D - 1]) = (blend(0), blend(1));
        strain
    }
}

/// The strains of a block of elements.
struct StrainsOfBlock<'b, 'a, const D: usize, const N: usize> {
    of: Smoothed<'a, D, N>,
    blocks: &'b ElementBlocks<N>,
    displacements: &'b Displacements<'b, D>,
    block: usize,
    fields: &'b mut FieldLanes<D>,
    strains: &'b mut [[Lanes; COMPONENTS]],
}

impl<const D: usize, const N: usize> Task for StrainsOfBlock<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        let Self { of, blocks, displacements, block, fields, strains } = self;
        let (like, own) = (Wide::zeros(r), blocks.block(block));
        fields.gather(like, own.nodes, displacements.iter().map(|level| Some(level.0)));
        let range = blocks.elements(block);
        let elements = &of.elements[range.clone()];
        for (((element, local), strain), e) in elements.iter().zip(own.local).zip(strains).zip(range) {
            let gradient = element.gradient(&fields.of(like, local));
            *strain = averaged(of.problem.material(ElementId::new(e)), &gradient).map(
                #[inline(always)]
                |x| x.store(),
            );
        }
    }
}

/// The components that are averaged.
#[inline(always)]
fn averaged<T: Value, const D: usize>(law: &Elastic, gradient: &[[T; D]; D]) -> [T; COMPONENTS] {
    if law.is_finite() {
        let second = second_stress(law, gradient);
        return [second[0][0], second[D - 1][D - 1], second[0][D - 1]];
    }
    [gradient[0][0], gradient[D - 1][D - 1], (gradient[0][D - 1] + gradient[D - 1][0]) * 0.5]
}

/// The patches of some nodes, of which the first has this number.
type OfNodes<'a, S> = (usize, usize, &'a mut [[S; COMPONENTS]]);

/// All patches, some nodes at a time: their first node, their number and their patches.
fn patches_of_nodes<'a, S>(smoothing: &Smoothing, patches: &'a mut [[S; COMPONENTS]]) -> Vec<OfNodes<'a, S>> {
    let (count, mut rest, mut parts) = (smoothing.node_count(), patches, Vec::new());
    for first in (0..count).step_by(BLOCK) {
        let nodes = first..(first + BLOCK).min(count);
        let (own, others) = rest.split_at_mut(smoothing.patches(&nodes).len());
        parts.push((first, nodes.len(), own));
        rest = others;
    }
    parts
}

struct PatchesOfNodes<'b, 'a, const D: usize, const N: usize> {
    of: Smoothed<'a, D, N>,
    strains: &'b [[Lanes; COMPONENTS]],
    part: OfNodes<'b, Lanes>,
}

impl<const D: usize, const N: usize> Task for PatchesOfNodes<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        sum_patches(Wide::zeros(r), self.of, self.strains, self.part);
    }
}

/// β/(3V) Σ|E|ε_E of the patches of some nodes.
#[inline(always)]
fn sum_patches<T: Value, const D: usize, const N: usize>(
    like: T,
    Smoothed { problem, smoothing, elements }: Smoothed<'_, D, N>,
    strains: &[[T::Stored; COMPONENTS]],
    (first, nodes, patches): OfNodes<'_, T::Stored>,
) {
    let laws = problem.element_material();
    let start = smoothing.patches(&(first..first + nodes)).start;
    for node in (first..first + nodes).map(NodeId::new) {
        let own = smoothing.patches(&(node.index()..node.index() + 1));
        for patch in own {
            let mut sum = [like.zero(); COMPONENTS];
            for &element in problem.mesh().stars().star(node).elements {
                if laws[element.index()] == smoothing.material(patch) {
                    let volume = elements[element.index()].volume * smoothing.weights()[patch];
                    for c in 0..COMPONENTS {
                        sum[c] += like.load(&strains[element.index()][c]) * volume;
                    }
                }
            }
            for c in 0..COMPONENTS {
                patches[patch - start][c] = sum[c].store();
            }
        }
    }
}
