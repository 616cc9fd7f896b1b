//! Tractions of least energy in a solid.
//!
//! All changes of the moments that give no element a resultant or a moment are sums of modes of single faces
//! ([`face_modes`]) and of rings of elements around edges ([`rings`]). Conjugate gradients over these ([`descent`])
//! reduce ½∫(σ_DA − σ)K⁻¹(σ_DA − σ), σ the stress of the displacement that is equilibrated.

mod assembly;
mod descent;
mod face_modes;
mod forms;
mod rings;

use super::energy::moment_slopes;
use crate::blocks::BLOCK;
use crate::element::{Element, face_at};
use crate::measure::{BalanceFields, BalanceNode, ElementMeasure};
use crate::options::Acceleration;
use crate::pool::Pool;
use crate::stress::EnergyForms;
use crate::time_level::ForcesKnown;
use crate::traction::{BalancedStrains, EquilibratedLevels, Equilibration, Then};
use assembly::{Assembly, FaceBlock, RingBlock};
use descent::{Descent, DescentRoom, slopes_of_strips};
use face_modes::{FaceModes, Vector};
use forms::{Forms, MOMENTS};
use percute_core::ids::{ElementId, FaceId};
use percute_core::problem::Problem;
use percute_core::simd::lanes::{LANES, Lanes, Value, load};
use percute_core::simd::{Registers, Task, Wide, run_task};
use rayon::prelude::*;
use rings::{Rings, unknown};
use std::ops::Range;

/// The data that are fixed in time.
#[derive(Debug)]
pub(in crate::reconstruction) struct SolidMinimisation {
    modes: Vec<FaceModes>,
    rings: Rings,
    forms: Forms,
    face_blocks: Vec<FaceBlock>,
    ring_blocks: Vec<RingBlock>,
    rooms: Pool<DescentRoom>,
}

impl SolidMinimisation {
    /// Prepares all elements.
    pub(in crate::reconstruction) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let mesh = problem.mesh();
        let modes: Vec<FaceModes> = (0..mesh.face_count())
            .map(FaceId::new)
            .map(|face| {
                let nodes = mesh.face(face).nodes;
                let points = [0, 1, 2].map(|p| std::array::from_fn(|c| mesh.point(nodes[p])[c]));
                FaceModes::new(&points, unknown(problem, face) == [true; D])
            })
            .collect();
        let (rings, forms) = (Rings::new(problem, &modes), Forms::new(problem));
        let assembly = Assembly { mesh, modes: &modes, forms: &forms };
        let (face_blocks, ring_blocks) = (assembly.face_blocks(), assembly.ring_blocks(&rings));
        Self { modes, rings, forms, face_blocks, ring_blocks, rooms: Pool::new() }
    }

    /// About how much memory it takes (bytes). With six elements, there are some twelve faces, seven edges and 36 links
    /// at a node.
    pub(in crate::reconstruction) fn memory(elements: usize) -> usize {
        let face = size_of::<FaceModes>() + size_of::<FaceBlock>() + 12 * size_of::<Lanes>();
        let ring = size_of::<RingBlock>() + 12 * size_of::<Lanes>() + 5 * size_of::<rings::RingFace>();
        elements.saturating_mul(Forms::BYTES + 2 * face + 6 * ring / 5 + 12 * size_of::<Vector<Lanes>>())
    }

    /// Solves the star problems of levels with these forces, and strains if they are smoothed, and improves their
    /// moments; `then` is given each part of the mesh with the final ones. Returns the largest relative miss of the
    /// star problems.
    pub(in crate::reconstruction) fn equilibrate<const D: usize, const N: usize>(
        &self,
        of @ (problem, equilibration, _): (&Problem<D>, &Equilibration<'_, D, N>, Acceleration),
        forces: (Vec<ForcesKnown<D>>, Option<BalancedStrains<'_>>),
        levels: &mut EquilibratedLevels<D>,
        then: Then<'_, D>,
    ) -> f64 {
        let mesh = problem.mesh();
        let new = || DescentRoom::new(mesh.stars().link_count(), mesh.face_count(), self.rings.len());
        self.rooms.lend(new, |room| {
            let miss = add_slopes(of, forces, levels, &mut room.slopes);
            let descent = Descent {
                mesh,
                elements: &equilibration.elements,
                strips: &equilibration.strips,
                modes: &self.modes,
                rings: &self.rings,
                forms: &self.forms,
                blocks: (&self.face_blocks, &self.ring_blocks),
            };
            descent.descend(room, levels.all_moments_mut(), &equilibration.stop);
            equilibration.parts().for_each(|part| then(levels, part));
            miss
        })
    }
}

/// Solves the star problems and finds the slopes of the energy in the moments on all links.
fn add_slopes<const D: usize, const N: usize>(
    (problem, equilibration, choice): (&Problem<D>, &Equilibration<'_, D, N>, Acceleration),
    (forces, strains): (Vec<ForcesKnown<D>>, Option<BalancedStrains<'_>>),
    levels: &mut EquilibratedLevels<D>,
    all: &mut [Vector<Lanes>],
) -> f64 {
    all.fill([Lanes::ZERO; 3]);
    let room = Pool::new();
    equilibration.solve(forces, levels, strains, |levels, part| {
        let slopes = SolidSlopes { problem, equilibration, choice, levels };
        for parity in 0..2 {
            let strips = part.strips.clone().filter(|strip| strip % 2 == parity);
            slopes_of_strips(problem.mesh(), &equilibration.strips, strips, all)
                .into_par_iter()
                .for_each(|strip| room.lend(BalanceFields::default, |fields| slopes.add(fields, strip)));
        }
    })
}

/// The slopes of the energy of some levels.
#[derive(Clone, Copy)]
struct SolidSlopes<'a, const D: usize, const N: usize> {
    problem: &'a Problem<D>,
    equilibration: &'a Equilibration<'a, D, N>,
    choice: Acceleration,
    levels: &'a EquilibratedLevels<D>,
}

impl<const D: usize, const N: usize> SolidSlopes<'_, D, N> {
    /// Adds those of some elements.
    fn add(
        &self,
        fields: &mut BalanceFields<D>,
        (elements, first, slopes): (Range<usize>, usize, &mut [Vector<Lanes>]),
    ) {
        for block in elements.start / BLOCK..elements.end.div_ceil(BLOCK) {
            let own = self.equilibration.blocks.elements(block);
            let range = own.start.max(elements.start)..own.end.min(elements.end);
            run_task(SolidSlopesOfBlock { all: self, fields, block, range, first, slopes });
        }
    }

    #[inline(always)]
    fn add_block<R: Registers>(
        &self,
        like: Wide<R>,
        fields: &mut BalanceFields<D>,
        (block, range): (usize, Range<usize>),
        (first, slopes): (usize, &mut [Vector<Lanes>]),
    ) {
        let (problem, equilibration, levels) = (self.problem, self.equilibration, self.levels);
        let begin = equilibration.blocks.elements(block).start;
        let block = equilibration.blocks.block(block);
        fields.gather(like, problem, block.nodes, levels);
        fields.gather_displacement(like, block.nodes, levels);
        let mut forms = EnergyForms::new(problem.mesh().kind());
        for start in range.clone().step_by(LANES) {
            let group = start..(start + LANES).min(range.end);
            fields.gather_moments(&equilibration.elements[group.clone()], levels);
            let nodes_of = |e: usize| fields.nodes(&block.local[e - begin]);
            let points = group.clone().map(|e| (ElementId::new(e), BalanceNode::points(&nodes_of(e))));
            let lanes = forms.prepare(problem, points);
            for (e, lane) in group.zip(lanes) {
                let (id, nodes, element) = (ElementId::new(e), nodes_of(e), &equilibration.elements[e]);
                let form = forms.of(problem, id, &BalanceNode::points(&nodes), lane);
                let measure = ElementMeasure::of_nodes((problem, element, id), self.choice, &nodes);
                let balance = fields.nodal_balance(like, e - start, levels, (id, &element.links), &nodes);
                let gradient = element.gradient(&BalanceNode::displacements(like, &nodes));
                let [stress, _] = measure.stress_and_strain(&gradient);
                let (slope, mut flat) = (moment_slopes(&measure, &form, &balance, &stress), [like; MOMENTS]);
                for i in 0..MOMENTS {
                    flat[i] = slope[i / 9][i / 3 % 3][i % 3];
                }
                add_outward(element, &flat, first, slopes);
            }
        }
    }
}

/// Some elements of a block whose slopes are wanted.
struct SolidSlopesOfBlock<'b, 'a, const D: usize, const N: usize> {
    all: &'b SolidSlopes<'a, D, N>,
    fields: &'b mut BalanceFields<D>,
    block: usize,
    range: Range<usize>,
    first: usize,
    slopes: &'b mut [Vector<Lanes>],
}

impl<const D: usize, const N: usize> Task for SolidSlopesOfBlock<'_, '_, D, N> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) {
        let Self { all, fields, block, range, first, slopes } = self;
        all.add_block(Wide::zeros(registers), fields, (block, range), (first, slopes));
    }
}

/// The outward moments of an element, from those on all links.
#[inline(always)]
fn outward_moments<T: Value<Stored = Lanes>, const D: usize, const N: usize>(
    like: T,
    element: &Element<D, N>,
    moments: &[Vector<Lanes>],
) -> [T; MOMENTS] {
    let mut own = [like.zero(); MOMENTS];
    for i in 0..N {
        for p in 0..D {
            let (link, k) = (element.links[i][p], face_at::<N>(i, p));
            let moment: [T; 3] = load(like, &moments[link.place()]);
            let enters = link.enters::<D>(k, p);
            for c in 0..3 {
                own[9 * k + 3 * p + c] = if enters { -moment[c] } else { moment[c] };
            }
        }
    }
    own
}

/// Adds slopes in the outward moments of an element to those on the links from `first` on.
#[inline(always)]
fn add_outward<T: Value<Stored = Lanes>, const D: usize, const N: usize>(
    element: &Element<D, N>,
    own: &[T; MOMENTS],
    first: usize,
    slopes: &mut [Vector<Lanes>],
) {
    for i in 0..N {
        for p in 0..D {
            let (link, k) = (element.links[i][p], face_at::<N>(i, p));
            let (to, enters) = (&mut slopes[link.place() - first], link.enters::<D>(k, p));
            for c in 0..3 {
                let slope = own[9 * k + 3 * p + c];
                let sum = own[0].load(&to[c]);
                to[c] = if enters { sum - slope } else { sum + slope }.store();
            }
        }
    }
}
