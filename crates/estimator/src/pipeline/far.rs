//! Elements without a candidate node of contact, sampled as soon as their levels are equilibrated.

use super::maps::Contribution;
use super::sampled_levels::SampledLevels;
use super::sampling::{Course, ElementSample, Sampling};
use crate::blocks::BLOCK;
use crate::increment::Increment;
use crate::kinematic::{ElementMotion, MotionLanes};
use crate::lanes::{LANES, Lanes, Value, gather};
use crate::measure::{
    AdmissibleStress, BalanceFields, BalanceNode, Balanced, ElementError, ElementMeasure, NodalBalance, at_places,
};
use crate::residual::{Residuals, worse};
use crate::simd::dispatch;
use crate::stress::{EnergyForm, EnergyForms};
use crate::time_level::Velocities;
use percute_core::ids::ElementId;
use rayon::prelude::*;

/// Away from contact the pointwise equilibrium of σ_DA is checked in so many elements at each level, each element in its turn: a
/// check costs more than the measure itself.
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
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FarCourse<const D: usize, const N: usize> {
    pub(super) course: Course,
    stress: AdmissibleStress<D, N>,
}

/// The results of a block of far elements.
struct FarBlock {
    levels: ElementError<Lanes>,
    mids: ElementError<Lanes>,
    residuals: Residuals,
    kept: Vec<Contribution>,
}

/// The fields of a block at some levels, and in the middles before them.
#[derive(Default)]
struct BlockFields<const D: usize> {
    now: Vec<VelocityLanes<D>>,
    mid: Vec<VelocityLanes<D>>,
    balance: BalanceFields<D>,
}

/// [`Velocities`] of a node side by side.
#[derive(Clone, Copy)]
struct VelocityLanes<const D: usize> {
    motion: MotionLanes<D>,
    increment: [Lanes; D],
    lumping_increment: [Lanes; D],
}

impl<const D: usize> VelocityLanes<D> {
    #[inline(always)]
    fn gather<'v>(
        records: &mut Vec<Self>,
        nodes: &[u32],
        velocities: impl Iterator<Item = Option<&'v Velocities<D>>> + Clone,
        mixed: bool,
    ) {
        let none = [Lanes::ZERO; D];
        records.resize(nodes.len(), Self { motion: MotionLanes::REST, increment: none, lumping_increment: none });
        MotionLanes::gather(
            records,
            nodes,
            velocities.clone().map(|v| v.map(|v| &v.motion)),
            #[inline(always)]
            |record| &mut record.motion,
        );
        gather(
            records,
            nodes,
            velocities.clone().map(|v| v.map(|v| v.increment.values())),
            #[inline(always)]
            |record| &mut record.increment,
        );
        if mixed {
            gather(
                records,
                nodes,
                velocities.map(|v| v.and_then(|v| v.lumping_increment.as_ref()).map(Increment::values)),
                #[inline(always)]
                |record| &mut record.lumping_increment,
            );
        }
    }
}

/// Samples all far elements at some levels, by blocks, and adds them up in the order of the blocks.
pub(super) fn sample<const D: usize, const N: usize>(
    shared: &Sampling<'_, '_, D, N>,
    levels: &SampledLevels<'_, D>,
    is_near: &[bool],
    courses: &mut [FarCourse<D, N>],
    sums: &mut FarSums,
) -> (Residuals, Vec<Contribution>) {
    let all = FarLevels::new(shared, levels);
    let block = |fields: &mut BlockFields<D>, (block, courses): (usize, &mut [FarCourse<D, N>])| {
        dispatch(
            #[inline(always)]
            || all.sample(block, fields, is_near, courses),
        )
    };
    let blocks: Vec<FarBlock> =
        courses.par_chunks_mut(BLOCK).enumerate().map_init(BlockFields::default, block).collect();
    let (mut at_levels, mut in_mids) = (ElementError::zero(), ElementError::zero());
    let (mut residuals, mut kept) = (Residuals::default(), Vec::new());
    for block in blocks {
        at_levels.add(&block.levels);
        in_mids.add(&block.mids);
        residuals.merge(&block.residuals);
        kept.extend(block.kept);
    }
    sums.extend(&at_levels, &in_mids, levels.levels.len(), levels.before.is_none());
    (residuals, kept)
}

/// The data that all blocks share at some levels.
struct FarLevels<'a, 's, 'p, const D: usize, const N: usize> {
    shared: &'a Sampling<'s, 'p, D, N>,
    levels: &'a SampledLevels<'a, D>,
    /// Which levels end an interval of a single step, and whether any does.
    single: [bool; LANES],
    has_mids: bool,
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
    fn new(shared: &'a Sampling<'s, 'p, D, N>, levels: &'a SampledLevels<'a, D>) -> Self {
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
            ends: Lanes::at_levels(|lane| if single[lane] { 0.25 * length(lane) } else { 0.5 * length(lane) }),
            middles: Lanes::at_levels(|lane| if single[lane] { 0.5 * length(lane) } else { 0.0 }),
            turns,
            turn: std::array::from_fn(|lane| index(lane).map_or(usize::MAX, |n| n % turns)),
            wanted: std::array::from_fn(|lane| index(lane).is_some_and(|n| shared.maps.want(n))),
        }
    }

    #[inline(always)]
    fn sample(
        &self,
        block: usize,
        fields: &mut BlockFields<D>,
        is_near: &[bool],
        courses: &mut [FarCourse<D, N>],
    ) -> FarBlock {
        let mut found = FarBlock {
            levels: ElementError::zero(),
            mids: ElementError::zero(),
            residuals: Residuals::default(),
            kept: Vec::new(),
        };
        let (problem, equilibration) = (self.shared.problem, self.shared.equilibration);
        let (range, block) = (equilibration.blocks.elements(block), equilibration.blocks.block(block));
        self.gather(fields, block.nodes);
        let mut forms = EnergyForms::new(problem.mesh().simplex().shape());
        let mut worst = Lanes::ZERO;
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
                    let of = (problem, &equilibration.elements[e], id);
                    let measure = ElementMeasure::of_nodes(of, self.shared.choice, &nodes);
                    let balance = fields.balance.nodal_balance(e - start, self.levels.levels, id, &nodes);
                    let element = FarElement { all: self, measure, form, id, local: &block.local[k] };
                    element.sample(fields, &balance, &mut courses[k], &mut found, &mut worst);
                }
            }
        }
        // A lane without a level holds no state.
        let worst = worst.0[..self.levels.levels.len()].iter().copied().fold(0.0, worse);
        found.residuals.element_resultants = worse(found.residuals.element_resultants, worst);
        found
    }

    #[inline(always)]
    fn gather(&self, fields: &mut BlockFields<D>, nodes: &[u32]) {
        let forces = self.levels.levels.forces();
        fields.balance.gather(self.shared.problem, nodes, self.levels.levels);
        let mixed = fields.balance.is_mixed();
        VelocityLanes::gather(&mut fields.now, nodes, forces.iter().map(|f| Some(&f.now)), mixed);
        if self.has_mids {
            let mids = forces.iter().zip(self.single).map(|(f, single)| f.mid.as_ref().filter(|_| single));
            VelocityLanes::gather(&mut fields.mid, nodes, mids, mixed);
        }
    }
}

/// One far element.
struct FarElement<'f, 'a, 's, 'p, const D: usize, const N: usize> {
    all: &'f FarLevels<'a, 's, 'p, D, N>,
    measure: ElementMeasure<'f, D, N>,
    form: EnergyForm<'f>,
    id: ElementId,
    local: &'f [u32; N],
}

impl<const D: usize, const N: usize> FarElement<'_, '_, '_, '_, D, N> {
    /// Samples the element at all levels and in the middles before them.
    #[inline(always)]
    fn sample(
        &self,
        fields: &BlockFields<D>,
        balance: &NodalBalance<D, N, Lanes>,
        so_far: &mut FarCourse<D, N>,
        found: &mut FarBlock,
        worst: &mut Lanes,
    ) {
        let (levels, balanced) = (self.all.levels.levels, self.measure.balanced(balance));
        *worst = worst.worse(self.measure.resultant_residual(&balanced, levels.force_scale()));
        self.check(&balanced, &mut found.residuals);
        let stress = self.measure.stress(&self.form, &balanced);
        let mixed = fields.balance.is_mixed();
        let now = self.error(&stress, &fields.now, mixed);
        found.levels.add(&now);
        let mut mid = ElementError::zero();
        if self.all.has_mids {
            // A window that begins with the first level has no middle before it.
            let before = AdmissibleStress::combine(&so_far.stress, &stress, |last: f64, now: Lanes| now.later(last));
            mid = self.error(&AdmissibleStress::middle(&before, &stress), &fields.mid, mixed).only(&self.all.single);
            found.mids.add(&mid);
        }
        let last = levels.len() - 1;
        so_far.stress = AdmissibleStress::combine(&stress, &stress, |now: Lanes, _: Lanes| now.0[last]);
        self.integrate(&now, &mid, &mut so_far.course, &mut found.kept);
    }

    #[inline(always)]
    fn error(
        &self,
        stress: &AdmissibleStress<D, N, Lanes>,
        velocities: &[VelocityLanes<D>],
        mixed: bool,
    ) -> ElementError<Lanes> {
        let nodes = at_places(velocities, self.local);
        let (mut increment, mut lumping, mut motions) =
            ([[Lanes::ZERO; D]; N], [[Lanes::ZERO; D]; N], [&nodes[0].motion; N]);
        for i in 0..N {
            (increment[i], lumping[i]) = (nodes[i].increment, nodes[i].lumping_increment);
            motions[i] = &nodes[i].motion;
        }
        let increment = self.measure.increment_of(&increment, mixed.then_some(&lumping));
        self.measure.error(stress, &increment, &ElementMotion::of_nodes(motions), Lanes::ZERO)
    }

    /// Checks the stress at the levels at which it is the turn of the element: the map that makes the stress is linear and the
    /// same at all levels.
    #[inline(always)]
    fn check(&self, balanced: &Balanced<D, N, Lanes>, residuals: &mut Residuals) {
        let turn = (self.all.turns - self.id.index() % self.all.turns) % self.all.turns;
        if !self.all.turn.contains(&turn) {
            return;
        }
        for (lane, _) in self.all.turn.iter().enumerate().filter(|&(_, &level)| level == turn) {
            let one = Balanced::combine(balanced, balanced, |now: Lanes, _: Lanes| now.0[lane]);
            self.measure.check_stress(&one, self.all.levels.levels.force_scale().0[lane], residuals);
        }
    }

    /// Goes on with the integral of η over time, and keeps the samples that are wanted.
    #[inline(always)]
    fn integrate(
        &self,
        now: &ElementError<Lanes>,
        mid: &ElementError<Lanes>,
        course: &mut Course,
        kept: &mut Vec<Contribution>,
    ) {
        let totals = now.total();
        // The trapezoidal rule, with the middle where it is sampled.
        let integrals = (totals.later(course.last().total()) + totals) * self.all.ends + mid.total() * self.all.middles;
        for (lane, forces) in self.all.levels.levels.forces().iter().enumerate() {
            course.add(integrals.0[lane]);
            if self.all.wanted[lane] {
                course.reach(ElementSample::away_from_contact(now.lane(lane)));
                course.keep(self.id, forces.level.index, kept);
            }
        }
        course.reach(ElementSample::away_from_contact(now.lane(self.all.levels.levels.len() - 1)));
    }
}
