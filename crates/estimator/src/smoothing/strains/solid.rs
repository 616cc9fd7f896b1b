//! Smoothed strains of a solid: those of an element are the sum over its patches.

use super::{Smoothed, SmoothedStrains, StrainLevel};
use crate::blocks::{BLOCK, ElementBlocks};
use crate::components::{COMPONENTS, SPACE_RECORDS, SpaceComponents, space_components, space_tensor};
use crate::element::Element;
use crate::field_lanes::FieldLanes;
use crate::parallel::by_pieces;
use crate::pool::Pool;
use crate::smoothing::SolidPatches;
use percute_core::ids::ElementId;
use percute_core::simd::lanes::{Lanes, Value};
use percute_core::simd::{Registers, Task, Wide, run_task};
use rayon::prelude::*;

/// Room for so many tensors.
fn resize<S: Copy>(records: &mut Vec<[S; COMPONENTS]>, tensors: usize, zero: S) -> &mut [SpaceComponents<S>] {
    records.resize(SPACE_RECORDS * tensors, [zero; COMPONENTS]);
    records.as_chunks_mut().0
}

impl SmoothedStrains {
    /// Takes in displacements (m).
    pub(super) fn fill_solid<const D: usize, const N: usize>(
        &mut self,
        of: Smoothed<'_, D, N>,
        blocks: &ElementBlocks<N>,
        levels: &[StrainLevel<'_, D>],
    ) {
        let room = Pool::new();
        let strains = resize(&mut self.strains, of.elements.len(), Lanes::ZERO);
        strains.par_chunks_mut(BLOCK).enumerate().for_each(|(block, strains)| {
            room.lend(FieldLanes::default, |fields| {
                run_task(StrainsOfSolid { of, blocks, levels, block, fields, strains });
            });
        });
        let (strains, patches) = (&*strains, of.smoothing.solid());
        let sums = resize(&mut self.patches, patches.count(), Lanes::ZERO);
        sums.par_chunks_mut(BLOCK).enumerate().for_each(|(block, sums)| {
            run_task(SumsOfPatches { patches, strains, first: block * BLOCK, sums });
        });
    }
}

impl SmoothedStrains<f64> {
    /// Takes in the displacements of one level (m).
    pub(super) fn fill_one_solid<const D: usize, const N: usize>(
        &mut self,
        of: Smoothed<'_, D, N>,
        displacement: &[[f64; D]],
    ) {
        self.share = 1.0;
        let strains = resize(&mut self.strains, of.elements.len(), 0.0);
        by_pieces((&mut *strains, of.elements), &|_, (strains, elements)| {
            for (strain, element) in strains.iter_mut().zip(elements) {
                *strain = weighted(element, &element.gather(displacement));
            }
        });
        let (strains, patches) = (&*strains, of.smoothing.solid());
        let sums = resize(&mut self.patches, patches.count(), 0.0);
        by_pieces(sums, &|first, sums| sum_patches(0.0, patches, strains, first, sums));
    }
}

impl<S: Copy> SmoothedStrains<S> {
    /// The strain of an element of which σ̄ is made: smoothed where it is, the plain one at other levels.
    #[inline(always)]
    pub(super) fn of_solid<T: Value<Stored = S>, const D: usize, const N: usize>(
        &self,
        like: T,
        of: Smoothed<'_, D, N>,
        element: ElementId,
    ) -> [[T; D]; D] {
        let (patches, _) = self.patches.as_chunks::<SPACE_RECORDS>();
        let mut smooth = [[like.zero(); COMPONENTS]; SPACE_RECORDS];
        for &patch in of.smoothing.solid().of_element(element.index()) {
            add(like, &mut smooth, &patches[patch as usize]);
        }
        let share = like.load(&self.share);
        if share.any(|share| share != 1.0) {
            let (strains, _) = self.strains.as_chunks::<SPACE_RECORDS>();
            let inverse = 1.0 / of.elements[element.index()].volume;
            for (smooth, own) in smooth.iter_mut().zip(&strains[element.index()]) {
                for (smooth, own) in smooth.iter_mut().zip(own) {
                    let own = like.load(own) * inverse;
                    *smooth = own + share * (*smooth - own);
                }
            }
        }
        space_tensor(smooth)
    }
}

/// Adds a tensor in memory.
#[inline(always)]
fn add<T: Value>(like: T, sum: &mut SpaceComponents<T>, one: &SpaceComponents<T::Stored>) {
    for k in 0..SPACE_RECORDS {
        for c in 0..COMPONENTS {
            sum[k][c] += like.load(&one[k][c]);
        }
    }
}

/// |E|ε_E of a displacement of the nodes of an element (m³).
#[inline(always)]
fn weighted<T: Value, const D: usize, const N: usize>(
    element: &Element<D, N>,
    displacement: &[[T; D]; N],
) -> SpaceComponents<T::Stored> {
    let mut strain = [[displacement[0][0].zero(); D]; D];
    for i in 1..N {
        for a in 0..D {
            // Half of it: the strain is the mean of the gradient and its transpose.
            let difference = (displacement[i][a] - displacement[0][a]) * 0.5;
            for b in 0..D {
                strain[a][b] += difference * element.gradients[i][b];
            }
        }
    }
    for a in 0..D {
        for b in 0..=a {
            strain[b][a] = strain[a][b] + strain[b][a];
        }
    }
    let (strain, mut stored) = (space_components(&strain), [[strain[0][0].store(); COMPONENTS]; SPACE_RECORDS]);
    for k in 0..SPACE_RECORDS {
        (0..COMPONENTS).for_each(|c| stored[k][c] = strain[k][c].store());
    }
    stored
}

/// The sums of patches, of which the first has this number.
#[inline(always)]
fn sum_patches<T: Value>(
    like: T,
    patches: &SolidPatches,
    strains: &[SpaceComponents<T::Stored>],
    first: usize,
    sums: &mut [SpaceComponents<T::Stored>],
) {
    for (at, stored) in sums.iter_mut().enumerate() {
        let mut sum = [[like.zero(); COMPONENTS]; SPACE_RECORDS];
        for &element in patches.elements(first + at) {
            add(like, &mut sum, &strains[element as usize]);
        }
        let weight = patches.weight(first + at);
        let factors = match patches.mirrors(first + at) {
            0 => [[weight; COMPONENTS]; SPACE_RECORDS],
            mirrors => without_shear(weight, mirrors),
        };
        for k in 0..SPACE_RECORDS {
            for c in 0..COMPONENTS {
                stored[k][c] = (sum[k][c] * factors[k][c]).store();
            }
        }
    }
}

/// A weight for the components of a strain, 0 for the shear strains across these axes.
fn without_shear(weight: f64, mirrors: u8) -> SpaceComponents<f64> {
    let mut factors = [[weight; 3]; 3];
    for (a, row) in factors.iter_mut().enumerate() {
        for (b, factor) in row.iter_mut().enumerate() {
            if a != b && (mirrors >> a | mirrors >> b) & 1 == 1 {
                *factor = 0.0;
            }
        }
    }
    space_components(&factors)
}

/// The strains of a block of elements.
struct StrainsOfSolid<'b, 'a, const D: usize, const N: usize> {
    of: Smoothed<'a, D, N>,
    blocks: &'b ElementBlocks<N>,
    levels: &'b [StrainLevel<'b, D>],
    block: usize,
    fields: &'b mut FieldLanes<D>,
    strains: &'b mut [SpaceComponents<Lanes>],
}

impl<const D: usize, const N: usize> Task for StrainsOfSolid<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        let Self { of, blocks, levels, block, fields, strains } = self;
        let (like, own) = (Wide::zeros(r), blocks.block(block));
        fields.gather(like, own.nodes, levels.iter().map(|level| Some(level.displacement)));
        let elements = &of.elements[blocks.elements(block)];
        for ((element, local), strain) in elements.iter().zip(own.local).zip(strains) {
            *strain = weighted(element, &fields.of(like, local));
        }
    }
}

/// The sums of some patches.
struct SumsOfPatches<'b> {
    patches: &'b SolidPatches,
    strains: &'b [SpaceComponents<Lanes>],
    first: usize,
    sums: &'b mut [SpaceComponents<Lanes>],
}

impl Task for SumsOfPatches<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, r: R) {
        sum_patches(Wide::zeros(r), self.patches, self.strains, self.first, self.sums);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::elements;
    use crate::smoothing::Smoothing;
    use percute_core::load::Support;
    use percute_core::material::{Elastic, Law};
    use percute_core::mesh::Mesh;
    use percute_core::problem::Problem;
    use percute_testkit::Random;

    /// Levels side by side have the strains of one level; those that are not smoothed the plain ones.
    #[test]
    fn levels_side_by_side() {
        let support = Support { group: "left".into(), components: [true, false, false], velocity: None };
        let problem = Problem::<3>::builder(Mesh::cuboid([1.0, 0.8, 0.7], [4, 4, 4]).unwrap())
            .material(Elastic::solid(70.0, 0.3, 2.0).unwrap())
            .support(support)
            .build()
            .unwrap();
        let (smoothing, elements) = (Smoothing::new(&problem), elements::<3, 4>(&problem));
        let of = Smoothed { problem: &problem, smoothing: &smoothing, elements: &elements };
        let (mut random, count) = (Random::new(4), problem.mesh().node_count());
        let mut field =
            || -> Vec<[f64; 3]> { (0..count).map(|_| std::array::from_fn(|_| random.between(-1.0, 1.0))).collect() };
        let fields: [_; 3] = std::array::from_fn(|_| field());
        let level = |k: usize| StrainLevel { displacement: &fields[k][..], plastic: None, smoothed: k != 1 };
        let (mut many, mut one) = (SmoothedStrains::default(), SmoothedStrains::<f64>::default());
        many.fill(of, &ElementBlocks::new(problem.mesh()), &[level(0), level(1), level(2)]);
        for (k, field) in fields.iter().enumerate() {
            one.fill_one(of, field);
            for (e, element) in elements.iter().enumerate() {
                let id = ElementId::new(e);
                let plain = || problem.material(id).strain(&element.gradient(&element.gather(field)));
                let expected = if k == 1 { plain() } else { one.of(0.0, of, id) };
                let found = many.of(Lanes::ZERO, of, id);
                for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                    // Rounding of strains of some 10.
                    assert!((found.0[k] - expected).abs() < 1e-13, "{k}, {e}: {} for {expected}", found.0[k]);
                }
            }
        }
    }
}
