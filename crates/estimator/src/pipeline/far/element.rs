//! The samples of one far element.

use super::FarLevels;
use super::fields::{BlockFields, VelocityLanes};
use super::{FarCourse, FarSamples};
use crate::components::components;
use crate::kinematic::ElementMotion;
use crate::measure::{AdmissibleStress, Balanced, ElementError, ElementMeasure, NodalBalance, at_places};
use crate::pipeline::maps::Contribution;
use crate::pipeline::sampling::{Course, ElementSample};
use crate::plastic::{PlasticMemory, PlasticPart};
use crate::residual::Residuals;
use crate::stress::EnergyForm;
use percute_core::ids::ElementId;
use percute_core::simd::Registers;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value, load};

/// One far element.
pub(super) struct FarElement<'f, 'a, 's, 'p, const D: usize, const N: usize> {
    pub(super) all: &'f FarLevels<'a, 's, 'p, D, N>,
    pub(super) measure: ElementMeasure<'f, D, N>,
    pub(super) form: EnergyForm<'f>,
    pub(super) id: ElementId,
    pub(super) local: &'f [u32; N],
}

impl<const D: usize, const N: usize> FarElement<'_, '_, '_, '_, D, N> {
    /// Samples the element at all levels and in the middles before them.
    #[inline(always)]
    pub(super) fn sample<R: Registers>(
        &self,
        like: Wide<R>,
        fields: &BlockFields<D>,
        balance: &NodalBalance<D, N, Wide<R>>,
        so_far: &mut FarCourse<D, N>,
        found: &mut FarSamples<Wide<R>>,
    ) {
        let (levels, balanced) = (self.all.levels.levels, self.measure.balanced(balance));
        found.worst = found.worst.worse(self.measure.resultant_residual(&balanced, like.load(&levels.force_scale())));
        self.check(&balanced, &mut found.residuals);
        let stress = self.measure.stress(&self.form, &balanced);
        let split = fields.balance.is_split();
        let plastic = self.plastic(&stress, &fields.now, &mut so_far.plastic);
        let [plastic_now, plastic_mid] = match &plastic {
            Some([now, mid]) => [Some(now.load(like)), Some(mid.load(like))],
            None => [None, None],
        };
        let now = self.error(&stress, &fields.now, split, plastic_now.as_ref());
        found.levels.add(&now);
        let mut mid = ElementError::filled(like);
        if self.all.has_mids {
            // A window that begins with the first level has no middle before it.
            let before = AdmissibleStress::combine(
                &so_far.stress,
                &stress,
                #[inline(always)]
                |last: f64, now: Wide<R>| now.later(last),
            );
            mid = self.error(&AdmissibleStress::middle(&before, &stress), &fields.mid, split, plastic_mid.as_ref());
            if !self.all.all_single {
                mid = mid.only(&self.all.single);
            }
            found.mids.add(&mid);
        }
        let last = levels.len() - 1;
        so_far.stress = AdmissibleStress::combine(
            &stress,
            &stress,
            #[inline(always)]
            |now: Wide<R>, _: Wide<R>| now.store().0[last],
        );
        so_far.before = so_far.course.integral;
        let eigenstrain = |lane: usize| {
            let of = |part: &PlasticPart<D, Lanes>| components(&part.eigenstrain.map(|row| row.map(|x| x.0[lane])));
            plastic.as_ref().map_or([0.0; 3], |[now, _]| of(now))
        };
        self.integrate((&now, &mid), eigenstrain, &mut so_far.course, &mut found.kept);
    }

    /// The plastic parts at all levels and in the middles before them, level after level; none of a material that does
    /// not yield.
    #[inline(always)]
    fn plastic<R: Registers>(
        &self,
        stress: &AdmissibleStress<D, N, Wide<R>>,
        velocities: &[VelocityLanes<D>],
        memory: &mut Option<Box<PlasticMemory<D>>>,
    ) -> Option<[PlasticPart<D, Lanes>; 2]> {
        let (law, volume) = self.measure.yielding()?;
        let (nodes, like) = (at_places(velocities, self.local), stress.mean[0][0]);
        let mut motions = [&nodes[0].motion; N];
        (0..N).for_each(|i| motions[i] = &nodes[i].motion);
        let gradient = self.measure.elastic_gradient(&ElementMotion::of_nodes(like, motions), None);
        let [gradient, mean] = [&gradient, &stress.mean].map(|tensor| tensor.map(|row| row.map(Value::store)));
        let memory = memory.get_or_insert_default();
        let mut parts = [PlasticPart::rest(); 2];
        for lane in 0..self.all.levels.levels.len() {
            let before = memory.last;
            let [gradient, mean] = [&gradient, &mean].map(|tensor| tensor.map(|row| row.map(|x: Lanes| x.0[lane])));
            memory.advance(law, volume, &gradient, &mean);
            parts[0].set(lane, &memory.last);
            parts[1].set(lane, &PlasticPart::middle(&before, &memory.last));
        }
        Some(parts)
    }

    #[inline(always)]
    fn error<R: Registers>(
        &self,
        stress: &AdmissibleStress<D, N, Wide<R>>,
        velocities: &[VelocityLanes<D>],
        split: bool,
        plastic: Option<&PlasticPart<D, Wide<R>>>,
    ) -> ElementError<Wide<R>> {
        let (nodes, like) = (at_places(velocities, self.local), stress.mean[0][0]);
        let (mut increment, mut skew, mut motions) = ([[like; D]; N], [[like; D]; N], [&nodes[0].motion; N]);
        for i in 0..N {
            increment[i] = load(like, &nodes[i].increment);
            skew[i] = load(like, &nodes[i].skew_increment);
            motions[i] = &nodes[i].motion;
        }
        let increment = self.measure.increment_of(&increment, split.then_some(&skew));
        self.measure.error(stress, &increment, &ElementMotion::of_nodes(like, motions), plastic)
    }

    /// Checks the stress at the levels at which it is the turn of the element: the map that makes the stress is linear
    /// and the same at all levels.
    #[inline(always)]
    fn check<T: Value<Stored = Lanes>>(&self, balanced: &Balanced<D, N, T>, residuals: &mut Residuals) {
        let turn = (self.all.turns - self.id.index() % self.all.turns) % self.all.turns;
        if !self.all.turn.contains(&turn) {
            return;
        }
        for (lane, _) in self.all.turn.iter().enumerate().filter(|&(_, &level)| level == turn) {
            let one = Balanced::combine(
                balanced,
                balanced,
                #[inline(always)]
                |now: T, _: T| now.store().0[lane],
            );
            self.measure.check_stress(&one, self.all.levels.levels.force_scale().0[lane], residuals);
        }
    }

    /// Goes on with the integral of η over time, and keeps the samples that are wanted.
    #[inline(always)]
    fn integrate<R: Registers>(
        &self,
        (now, mid): (&ElementError<Wide<R>>, &ElementError<Wide<R>>),
        eigenstrain: impl Fn(usize) -> [f64; 3],
        course: &mut Course,
        kept: &mut Vec<Contribution>,
    ) {
        let totals = now.total();
        // The trapezoidal rule, with the middle where it is sampled.
        let [ends, middles] = [totals.load(&self.all.ends), totals.load(&self.all.middles)];
        let integrals = (totals.later(course.last().total()) + totals) * ends + mid.total() * middles;
        let (integrals, now) = (integrals.store(), now.store());
        for (lane, forces) in self.all.levels.levels.forces().iter().enumerate() {
            course.add(integrals.0[lane]);
            if self.all.wanted[lane] {
                course.reach(ElementSample::away_from_contact(now.lane(lane), eigenstrain(lane)));
                course.keep(self.id, forces.level.index, kept);
            }
        }
        let last = self.all.levels.levels.len() - 1;
        course.reach(ElementSample::away_from_contact(now.lane(last), eigenstrain(last)));
    }
}
