//! Smoothed strains at one level, or at some side by side.
//!
//! Of bodies that turn the Green strains are averaged. S̄_E is the mean, with the same weights, of the stresses S of
//! the mean strains of edges and nodes. F_E S̄_E is then the slope of an energy, that of the mean strains: the mean of
//! the stresses of the elements would be no such slope, and give energy to rubber.

mod solid;

use super::Smoothing;
use crate::blocks::{BLOCK, ElementBlocks};
use crate::components::{COMPONENTS, components, tensor};
use crate::deformation::second_stress;
use crate::element::Element;
use crate::field_lanes::FieldLanes;
use crate::parallel::by_pieces;
use crate::plastic::{EigenLevels, EigenStrains, take_off};
use crate::pool::Pool;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::material::{Elastic, green_strain};
use percute_core::problem::Problem;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value};
use percute_core::simd::{Registers, Task, run_task};
use rayon::prelude::*;

/// The strains of which smoothed ones are made, of all elements at one level or some; Green strains of finite laws.
#[derive(Clone, Debug, Default)]
pub(crate) struct SmoothedStrains<S = Lanes> {
    /// Of each element; of a solid |E|ε_E (m³), two records each.
    strains: Vec<[S; COMPONENTS]>,
    /// β/(3V) Σ|E|ε_E of each patch; β/3 S of the mean strain of a finite law. Of a solid those of edges, too, with
    /// their weights, two records each.
    patches: Vec<[S; COMPONENTS]>,
    /// (1 − β)/3 S of the mean strain of each edge within a material of a finite law; empty with small strains.
    edges: Vec<[S; COMPONENTS]>,
    /// 1 at the levels whose strains are smoothed, 0 at others.
    share: S,
}

/// A level whose strains may be smoothed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrainLevel<'a, const D: usize> {
    /// u (m).
    pub(crate) displacement: &'a [[f64; D]],
    /// ε* of the elements, where a material yields: strains are those of u less these.
    pub(crate) plastic: Option<&'a EigenStrains>,
    pub(crate) smoothed: bool,
}

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
        levels: &[StrainLevel<'_, D>],
    ) {
        self.share = Lanes::at_levels(|k| if levels.get(k).is_some_and(|level| level.smoothed) { 1.0 } else { 0.0 });
        if D == 3 {
            return self.fill_solid(of, blocks, levels);
        }
        self.strains.resize(of.elements.len(), [Lanes::ZERO; COMPONENTS]);
        self.patches.resize(of.smoothing.patch_count(), [Lanes::ZERO; COMPONENTS]);
        let room = Pool::new();
        self.strains.par_chunks_mut(BLOCK).enumerate().for_each(|(block, strains)| {
            room.lend(FieldLanes::default, |fields| {
                run_task(StrainsOfBlock { of, blocks, levels, block, fields, strains });
            });
        });
        let strains = &self.strains;
        let parts = patches_of_nodes(of.smoothing, &mut self.patches);
        parts.into_par_iter().for_each(|part| run_task(PatchesOfNodes { of, strains, part }));
        if of.problem.is_finite() {
            self.edges.resize(of.problem.mesh().face_count(), [Lanes::ZERO; COMPONENTS]);
            let edges = self.edges.par_chunks_mut(BLOCK).enumerate();
            edges.for_each(|(k, edges)| run_task(EdgesOfBlock { of, strains, first: k * BLOCK, edges }));
        }
    }
}

impl SmoothedStrains<f64> {
    /// Takes in the displacements of one level (m), whose strains are smoothed.
    pub(crate) fn fill_one<const D: usize, const N: usize>(
        &mut self,
        of: Smoothed<'_, D, N>,
        displacement: &[[f64; D]],
    ) {
        if D == 3 {
            return self.fill_one_solid(of, displacement);
        }
        self.strains.resize(of.elements.len(), [0.0; COMPONENTS]);
        by_pieces((&mut self.strains[..], of.elements), &|first, (strains, elements)| {
            for (k, (strain, element)) in strains.iter_mut().zip(elements).enumerate() {
                let gradient = element.gradient(&element.gather(displacement));
                *strain = averaged(of.problem.material(ElementId::new(first + k)), &gradient);
            }
        });
        self.complete(of);
    }

    /// Takes in the strains of the elements of one level, which are smoothed.
    pub(crate) fn fill_strains<const D: usize, const N: usize>(
        &mut self,
        of: Smoothed<'_, D, N>,
        strains: &EigenStrains,
    ) {
        self.strains.clone_from(strains);
        self.complete(of);
    }

    /// The sums at patches and edges.
    fn complete<const D: usize, const N: usize>(&mut self, of: Smoothed<'_, D, N>) {
        self.share = 1.0;
        self.patches.resize(of.smoothing.patch_count(), [0.0; COMPONENTS]);
        let (strains, parts) = (&self.strains, patches_of_nodes(of.smoothing, &mut self.patches));
        let sum = |part: OfNodes<'_, f64>| sum_patches(0.0, of, strains, part);
        // Without a pool, rayon would start one of its own.
        match rayon::current_thread_index() {
            Some(_) => parts.into_par_iter().for_each(sum),
            None => parts.into_iter().for_each(sum),
        }
        if of.problem.is_finite() {
            self.edges.resize(of.problem.mesh().face_count(), [0.0; COMPONENTS]);
            by_pieces(&mut self.edges[..], &|first, edges| edge_stresses(0.0, of, strains, first, edges));
        }
    }
}

impl<S: Copy> SmoothedStrains<S> {
    /// The strain of an element of which σ̄ is made: smoothed where it is, the plain one at other levels. S̄ of a
    /// finite law.
    #[inline(always)]
    pub(crate) fn of<T: Value<Stored = S>, const D: usize, const N: usize>(
        &self,
        like: T,
        of: Smoothed<'_, D, N>,
        element: ElementId,
    ) -> [[T; D]; D] {
        if D == 3 {
            return self.of_solid(like, of, element);
        }
        let Smoothed { problem, smoothing, elements } = of;
        let (mesh, volume) = (problem.mesh(), elements[element.index()].volume);
        let (law, first) = (problem.material(element), mesh.nodes_of::<N>()[element.index()][0]);
        let own = self.strains[element.index()].map(
            #[inline(always)]
            |x| like.load(&x),
        );
        let plain = || if law.is_finite() { components(&second_stress::<T, D>(law, &tensor(own))) } else { own };
        let mut smooth = [like.zero(); COMPONENTS];
        for face in mesh.faces_of::<N>()[element.index()] {
            let other = Smoothing::beyond(problem, element, face);
            let beyond = elements[other.index()].volume;
            let weight = smoothing.edge_weight(first, volume + beyond);
            let (mine, beyond) = (weight * volume, weight * beyond);
            // At a border the mean is that of the element alone.
            let alone = if law.is_finite() && other == element { plain() } else { own };
            for c in 0..COMPONENTS {
                smooth[c] += match law.is_finite() {
                    false => own[c] * mine + like.load(&self.strains[other.index()][c]) * beyond,
                    true if other == element => alone[c] * (mine + beyond),
                    true => like.load(&self.edges[face.index()][c]),
                };
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
        if law.is_finite() && !share.any(|share| share != 1.0) {
            return tensor(smooth);
        }
        let own = plain();
        let blend = |c: usize| own[c] + share * (smooth[c] - own[c]);
        tensor([blend(0), blend(1), blend(2)])
    }
}

/// The strains of a block of elements.
struct StrainsOfBlock<'b, 'a, const D: usize, const N: usize> {
    of: Smoothed<'a, D, N>,
    blocks: &'b ElementBlocks<N>,
    levels: &'b [StrainLevel<'b, D>],
    block: usize,
    fields: &'b mut FieldLanes<D>,
    strains: &'b mut [[Lanes; COMPONENTS]],
}

impl<const D: usize, const N: usize> Task for StrainsOfBlock<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        let Self { of, blocks, levels, block, fields, strains } = self;
        let (like, own) = (Wide::zeros(r), blocks.block(block));
        fields.gather(like, own.nodes, levels.iter().map(|level| Some(level.displacement)));
        let eigen = EigenLevels::new(levels.iter().map(|level| level.plastic));
        let range = blocks.elements(block);
        let elements = &of.elements[range.clone()];
        for (((element, local), strain), e) in elements.iter().zip(own.local).zip(strains).zip(range) {
            let mut gradient = element.gradient(&fields.of(like, local));
            take_off(eigen.as_ref(), &mut gradient, e);
            *strain = averaged(of.problem.material(ElementId::new(e)), &gradient).map(
                #[inline(always)]
                |x| x.store(),
            );
        }
    }
}

/// The strain that is averaged.
#[inline(always)]
fn averaged<T: Value, const D: usize>(law: &Elastic, gradient: &[[T; D]; D]) -> [T; COMPONENTS] {
    if law.is_finite() {
        return components(&green_strain(gradient));
    }
    [gradient[0][0], gradient[D - 1][D - 1], (gradient[0][D - 1] + gradient[D - 1][0]) * 0.5]
}

/// (1 − β)/3 S of the mean strain of edges, of which the first has this number; those within a material.
#[inline(always)]
fn edge_stresses<T: Value, const D: usize, const N: usize>(
    like: T,
    Smoothed { problem, smoothing, elements }: Smoothed<'_, D, N>,
    strains: &[[T::Stored; COMPONENTS]],
    first: usize,
    edges: &mut [[T::Stored; COMPONENTS]],
) {
    for (k, edge) in edges.iter_mut().enumerate() {
        let id = FaceId::new(first + k);
        let owner = problem.mesh().face(id).owner;
        let other = Smoothing::beyond(problem, owner, id);
        if other == owner {
            continue;
        }
        let volumes = [owner, other].map(|element| elements[element.index()].volume);
        let volume = volumes[0] + volumes[1];
        let mut mean = [like.zero(); COMPONENTS];
        for c in 0..COMPONENTS {
            for (element, own) in [owner, other].into_iter().zip(volumes) {
                mean[c] += like.load(&strains[element.index()][c]) * (own / volume);
            }
        }
        let stress = components(&second_stress::<T, D>(problem.material(owner), &tensor(mean)));
        let weight = smoothing.edge_weight(problem.mesh().face(id).nodes[0], volume) * volume;
        for c in 0..COMPONENTS {
            edge[c] = (stress[c] * weight).store();
        }
    }
}

struct EdgesOfBlock<'b, 'a, const D: usize, const N: usize> {
    of: Smoothed<'a, D, N>,
    strains: &'b [[Lanes; COMPONENTS]],
    first: usize,
    edges: &'b mut [[Lanes; COMPONENTS]],
}

impl<const D: usize, const N: usize> Task for EdgesOfBlock<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        edge_stresses(Wide::zeros(r), self.of, self.strains, self.first, self.edges);
    }
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

/// β/(3V) Σ|E|ε_E of the patches of some nodes; β/3 S of the mean strain of a finite law.
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
            let (mut sum, mut share) = ([like.zero(); COMPONENTS], 0.0);
            for &element in problem.mesh().stars().star(node).elements {
                if laws[element.index()] == smoothing.material(patch) {
                    let volume = elements[element.index()].volume * smoothing.weights()[patch];
                    share += volume;
                    for c in 0..COMPONENTS {
                        sum[c] += like.load(&strains[element.index()][c]) * volume;
                    }
                }
            }
            let law = &problem.materials()[smoothing.material(patch) as usize];
            if law.is_finite() && share > 0.0 {
                let mean = tensor(sum.map(
                    #[inline(always)]
                    |x| x * (1.0 / share),
                ));
                sum = components(&second_stress::<T, D>(law, &mean)).map(
                    #[inline(always)]
                    |x| x * share,
                );
            }
            for c in 0..COMPONENTS {
                patches[patch - start][c] = sum[c].store();
            }
        }
    }
}
