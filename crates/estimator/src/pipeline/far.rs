//! Elements without a candidate node of contact, sampled as soon as their levels are equilibrated.

mod element;
mod fields;

use super::maps::Contribution;
use super::sampled_levels::SampledLevels;
use super::sampling::{Course, SharedData};
use crate::blocks::BLOCK;
use crate::measure::{AdmissibleStress, BalanceNode, ElementError, ElementMeasure};
use crate::plastic::PlasticMemory;
use crate::pool::Pool;
use crate::residual::{Residuals, worse};
use crate::stress::EnergyForms;
use crate::traction::{EquilibratedLevel, EquilibratedLevels};
use element::FarElement;
use fields::BlockFields;
use percute_core::ids::ElementId;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{LANES, Lanes, Value};
use percute_core::simd::{Registers, Task, run_task};
use rayon::prelude::*;
use std::ops::Range;

/// Away from contact the pointwise equilibrium of σ_DA is checked in so many elements at each level, each element in
/// its turn, at most every so many levels: a check costs more than the measure itself.
const CHECKS: usize = 64;

/// Sums over far elements at the levels and in the middles between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarSums {
    pub(crate) levels: Vec<ElementError>,
    pub(crate) mids: Vec<ElementError>,
}

impl FarSums {
    /// Appends later levels.
    fn extend(&mut self, levels: &ElementError<Lanes>, mids: &ElementError<Lanes>, count: usize, begins: bool) {
        self.levels.extend((0..count).map(|lane| levels.lane(lane)));
        self.mids.extend((usize::from(begins)..count).map(|lane| mids.lane(lane)));
    }
}

/// η_E of a far element so far, and its σ_DA at the last level.
#[derive(Clone, Debug, Default)]
pub(super) struct FarCourse<const D: usize, const N: usize> {
    pub(super) course: Course,
    /// The integral before the levels at work.
    before: f64,
    stress: AdmissibleStress<D, N>,
    /// Of a material that yields.
    plastic: Option<Box<PlasticMemory<D>>>,
}

/// The results of a block of far elements.
struct FarBlock {
    levels: ElementError<Lanes>,
    mids: ElementError<Lanes>,
    residuals: Residuals,
    kept: Vec<Contribution>,
}

/// The same while its elements are sampled.
struct FarSamples<T> {
    levels: ElementError<T>,
    mids: ElementError<T>,
    /// The largest residual of the balance of an element.
    worst: T,
    residuals: Residuals,
    kept: Vec<Contribution>,
}

/// The sampling of all far elements at some levels, part by part: blocks are added up in their order.
pub(super) struct FarSampling<'a, 's, 'p, const D: usize, const N: usize> {
    shared: &'a SharedData<'s, 'p, D, N>,
    /// The level before these.
    before: Option<EquilibratedLevel<'a, D>>,
    is_near: &'a [bool],
    courses: &'a mut [FarCourse<D, N>],
    /// Number of elements sampled.
    done: usize,
    room: Pool<BlockFields<D>>,
    levels: ElementError<Lanes>,
    mids: ElementError<Lanes>,
    residuals: Residuals,
    kept: Vec<Contribution>,
}

impl<'a, 's, 'p, const D: usize, const N: usize> FarSampling<'a, 's, 'p, D, N> {
    pub(super) fn new(
        shared: &'a SharedData<'s, 'p, D, N>,
        before: Option<EquilibratedLevel<'a, D>>,
        is_near: &'a [bool],
        courses: &'a mut [FarCourse<D, N>],
    ) -> Self {
        let none = ElementError::filled(Lanes::ZERO);
        let (residuals, kept) = (Residuals::default(), Vec::new());
        let room = Pool::new();
        Self { shared, before, is_near, courses, done: 0, room, levels: none, mids: none, residuals, kept }
    }

    /// Samples the elements of some blocks.
    pub(super) fn sample(&mut self, levels: &EquilibratedLevels<D>, blocks: Range<usize>) {
        let Self { shared, before, is_near, courses, room, .. } = self;
        let levels = SampledLevels { before: *before, levels };
        let all = FarLevels::new(shared, &levels);
        let end = (blocks.end * BLOCK).min(courses.len());
        let block = |(block, courses): (usize, &mut [FarCourse<D, N>])| {
            let block = blocks.start + block;
            let task =
                |fields: &mut BlockFields<D>| run_task(SampleBlock { all: &all, block, fields, is_near, courses });
            room.lend(BlockFields::default, task)
        };
        let courses = courses[blocks.start * BLOCK..end].par_chunks_mut(BLOCK).enumerate();
        let found: Vec<FarBlock> = courses.map(block).collect();
        self.done = end;
        for block in found {
            self.levels.add(&block.levels);
            self.mids.add(&block.mids);
            self.residuals.merge(&block.residuals);
            self.kept.extend(block.kept);
        }
    }

    /// Takes back what was added to integrals at these levels.
    pub(super) fn undo(self) {
        self.courses[..self.done].iter_mut().for_each(|far| far.course.integral = far.before);
    }

    /// Appends the sums at these levels, of which all blocks are sampled.
    pub(super) fn finish(self, levels: &EquilibratedLevels<D>, sums: &mut FarSums) -> (Residuals, Vec<Contribution>) {
        sums.extend(&self.levels, &self.mids, levels.len(), self.before.is_none());
        (self.residuals, self.kept)
    }
}

/// A block to be sampled.
struct SampleBlock<'b, 'a, 's, 'p, const D: usize, const N: usize> {
    all: &'b FarLevels<'a, 's, 'p, D, N>,
    block: usize,
    fields: &'b mut BlockFields<D>,
    is_near: &'b [bool],
    courses: &'b mut [FarCourse<D, N>],
}

impl<const D: usize, const N: usize> Task for SampleBlock<'_, '_, '_, '_, D, N> {
    type Output = FarBlock;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> FarBlock {
        self.all.sample(Wide::zeros(registers), self.block, self.fields, self.is_near, self.courses)
    }
}

/// The data that all blocks share at some levels.
struct FarLevels<'a, 's, 'p, const D: usize, const N: usize> {
    shared: &'a SharedData<'s, 'p, D, N>,
    levels: &'a SampledLevels<'a, D>,
    /// Which levels end an interval of a single step, and whether any and all of them do.
    single: [bool; LANES],
    has_mids: bool,
    all_single: bool,
    /// Lengths of these steps (s).
    lengths: Lanes,
    /// Weights of the integral over the interval before each level: of η at its ends and in its middle (s).
    ends: Lanes,
    middles: Lanes,
    /// An element is checked at each level of so many.
    turns: usize,
    /// The number of each level, modulo the turns.
    turn: [usize; LANES],
    /// The levels of which maps are wanted.
    wanted: [bool; LANES],
}

impl<'a, 's, 'p, const D: usize, const N: usize> FarLevels<'a, 's, 'p, D, N> {
    fn new(shared: &'a SharedData<'s, 'p, D, N>, levels: &'a SampledLevels<'a, D>) -> Self {
        let (forces, instants) = (levels.levels.forces(), shared.times.instants());
        let single: [bool; LANES] = std::array::from_fn(|lane| lane < forces.len() && levels.is_single(lane));
        let length = |lane: usize| {
            let before = (lane < forces.len()).then(|| levels.before(lane)).flatten();
            before.map_or(0.0, |before| instants[forces[lane].level.index] - instants[before.index()])
        };
        let turns = (shared.problem.mesh().element_count() / CHECKS).max(CHECKS);
        let index = |lane: usize| forces.get(lane).map(|f| f.level.index);
        Self {
            shared,
            levels,
            single,
            has_mids: single.contains(&true),
            all_single: !single.contains(&false),
            lengths: Lanes::at_levels(
                |lane| if single[lane] { shared.times.step(forces[lane].level.index - 1) } else { 0.0 },
            ),
            ends: Lanes::at_levels(|lane| if single[lane] { 0.25 * length(lane) } else { 0.5 * length(lane) }),
            middles: Lanes::at_levels(|lane| if single[lane] { 0.5 * length(lane) } else { 0.0 }),
            turns,
            turn: std::array::from_fn(|lane| index(lane).map_or(usize::MAX, |n| n % turns)),
            wanted: std::array::from_fn(|lane| index(lane).is_some_and(|n| shared.maps.want(n))),
        }
    }

    #[inline(always)]
    fn sample<R: Registers>(
        &self,
        like: Wide<R>,
        block: usize,
        fields: &mut BlockFields<D>,
        is_near: &[bool],
        courses: &mut [FarCourse<D, N>],
    ) -> FarBlock {
        let mut found = FarSamples {
            levels: ElementError::filled(like),
            mids: ElementError::filled(like),
            worst: like,
            residuals: Residuals::default(),
            kept: Vec::new(),
        };
        let (problem, equilibration) = (self.shared.problem, self.shared.equilibration);
        let (range, block) = (equilibration.blocks.elements(block), equilibration.blocks.block(block));
        self.gather(like, fields, block.nodes);
        let mut forms = EnergyForms::new(problem.mesh().kind());
        for start in range.clone().step_by(LANES) {
            let group = start..(start + LANES).min(range.end);
            fields.balance.gather_moments(&equilibration.elements[group.clone()], self.levels.levels);
            let nodes_of = |e: usize| fields.balance.nodes(&block.local[e - range.start]);
            let points = group.clone().map(|e| (ElementId::new(e), BalanceNode::points(&nodes_of(e))));
            let lanes = forms.prepare(problem, points);
            for (e, lane) in group.zip(lanes) {
                if !is_near[e] {
                    let (k, id, nodes) = (e - range.start, ElementId::new(e), nodes_of(e));
                    let form = forms.of(problem, id, &BalanceNode::points(&nodes), lane);
                    let (element, levels) = (&equilibration.elements[e], self.levels.levels);
                    let of = (problem, element, id);
                    let measure = ElementMeasure::of_nodes(of, self.shared.choice, &nodes);
                    let balance = fields.balance.nodal_balance(like, e - start, levels, (id, &element.links), &nodes);
                    let element = FarElement { all: self, measure, form, id, local: &block.local[k] };
                    element.sample(like, fields, &balance, &mut courses[k], &mut found);
                }
            }
        }
        // A lane without a level holds no state.
        let worst = found.worst.store().0[..self.levels.levels.len()].iter().copied().fold(0.0, worse);
        let FarSamples { levels, mids, mut residuals, kept, .. } = found;
        residuals.element_resultants = worse(residuals.element_resultants, worst);
        FarBlock { levels: levels.store(), mids: mids.store(), residuals, kept }
    }
}
