//! η of one element at the samples of an interval, its integral over time, and the maps of it.

use super::maps::{Contribution, Maps};
use crate::components::components;
use crate::concentrated::HatStress;
use crate::contact_density::ResidualStress;
use crate::element::Element;
use crate::increment::{self, Increment};
use crate::kinematic::{ElementMotion, gather_common};
use crate::measure::{AdmissibleStress, Balanced, ElementError, ElementMeasure, hat_energy, work};
use crate::numbers::Reader;
use crate::options::Acceleration;
use crate::plastic::PlasticPart;
use crate::residual::{Residuals, worse};
use crate::stress::{ElementForm, Loading};
use crate::time_level::{Side, Velocities};
use crate::traction::{EquilibratedLevel, Equilibration};
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// Trapezoidal integral over an interval, with or without a sample in its middle.
#[inline]
pub(super) fn trapezoid(length: f64, start: f64, middle: Option<f64>, end: f64) -> f64 {
    match middle {
        Some(middle) => 0.25 * length * (start + 2.0 * middle + end),
        None => 0.5 * length * (start + end),
    }
}

/// η and d of an element at one sample (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ElementSample {
    pub(super) error: ElementError,
    /// The contact part.
    pub(super) contact: ContactPart,
    /// ε* of σ_CA, as xx, yy and xy.
    pub(super) eigenstrain: [f64; 3],
}

/// The contact part of η (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactPart {
    pub(super) total: f64,
    /// ∫∫F_n|w_n| dt in it.
    pub(super) normal_work: f64,
}

impl ElementSample {
    /// Where there is no contact part.
    #[inline(always)]
    pub(super) fn away_from_contact(error: ElementError, eigenstrain: [f64; 3]) -> Self {
        Self { error, contact: ContactPart::default(), eigenstrain }
    }

    #[inline(always)]
    pub(super) fn total(&self) -> f64 {
        self.error.total() + self.contact.total
    }
}

/// η of an element up to the last sample.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Course {
    /// ∫η_E dt (J s).
    pub(super) integral: f64,
    last: ElementSample,
}

impl Course {
    /// η at the last sample.
    #[inline(always)]
    pub(super) fn last(&self) -> &ElementSample {
        &self.last
    }

    /// Adds the integral over an interval (J s).
    #[inline(always)]
    pub(super) fn add(&mut self, integral: f64) {
        self.integral += integral;
    }

    /// Goes on to a sample.
    #[inline(always)]
    pub(super) fn reach(&mut self, sample: ElementSample) {
        self.last = sample;
    }

    /// Keeps the last sample of an element, at this step; the one after a jump replaces the one before it.
    pub(super) fn keep(&self, element: ElementId, step: usize, kept: &mut Vec<Contribution>) {
        kept.pop_if(|last| last.element == element && last.step == step);
        let ElementSample { error, contact, eigenstrain } = self.last;
        let accumulated = self.integral;
        kept.push(Contribution { element, step, error, contact: contact.total, accumulated, eigenstrain });
    }
}

/// The fields of an element at one half-step instant that do not depend on tractions.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementVelocities<const D: usize, const N: usize> {
    pub(super) motion: ElementMotion<D, N>,
    /// ∫Γ_DA/ρ dt (m/s).
    increment: [[f64; D]; N],
}

impl<const D: usize, const N: usize> ElementVelocities<D, N> {
    /// Appends them to numbers.
    pub(super) fn append(&self, numbers: &mut Vec<f64>) {
        self.motion.append(numbers);
        numbers.extend_from_slice(self.increment.as_flattened());
    }

    /// Those that were appended.
    pub(super) fn read(numbers: &mut Reader<'_>) -> Self {
        Self { motion: ElementMotion::read(numbers), increment: numbers.vectors() }
    }
}

/// The part of σ_DA of an element in η at one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampledStress<const D: usize, const N: usize> {
    /// Its mean (Pa).
    pub(super) mean: [[f64; D]; D],
    /// The energy of the rest (J per unit of section or thickness).
    pub(super) fluctuation: f64,
    /// The loading that it balances, where other stresses need it.
    pub(super) loading: Option<Loading<D, N>>,
}

impl<const D: usize, const N: usize> SampledStress<D, N> {
    /// Appends it to numbers.
    pub(super) fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(self.mean.as_flattened());
        numbers.push(self.fluctuation);
        if let Some(loading) = &self.loading {
            numbers.extend_from_slice(loading.traction.as_flattened().as_flattened());
            numbers.extend_from_slice(loading.volume.as_flattened());
        }
    }

    /// One that was appended, with its loading or without.
    pub(super) fn read(numbers: &mut Reader<'_>, loaded: bool) -> Self {
        let (mean, fluctuation) = (numbers.vectors(), numbers.number());
        let mut loading = || Loading { traction: [(); N].map(|()| numbers.vectors()), volume: numbers.vectors() };
        Self { mean, fluctuation, loading: loaded.then(&mut loading) }
    }
}

/// The fields of an element at one sample.
pub(super) type SampledFields<'i, const D: usize, const N: usize> =
    (&'i SampledStress<D, N>, &'i ElementVelocities<D, N>);

/// One interval between sampled levels.
pub(super) struct ElementInterval<'i, const D: usize, const N: usize> {
    /// The steps at its beginning and its end.
    pub(super) steps: [usize; 2],
    /// Its beginning, unless the sample at the end of the interval before is the same.
    pub(super) start: Option<SampledFields<'i, D, N>>,
    /// Its middle, if it is one step long.
    pub(super) mid: Option<SampledFields<'i, D, N>>,
    pub(super) end: SampledFields<'i, D, N>,
    /// The contact part of η at its beginning, middle and end (J).
    pub(super) contact: [ContactPart; 3],
    /// Stresses beside these, at its beginning, middle and end.
    pub(super) residual: [ResidualStress; 3],
    /// The stress of hats at its beginning, middle and end.
    pub(super) hats: [&'i [HatStress<'i>]; 3],
    /// The plastic parts there, of a material that yields.
    pub(super) plastic: Option<[PlasticPart<D>; 3]>,
}

/// The data that all elements share.
#[derive(Clone, Copy)]
pub(super) struct SharedData<'a, 'p, const D: usize, const N: usize> {
    pub(super) problem: &'p Problem<D>,
    pub(super) times: &'p TimeGrid,
    pub(super) equilibration: &'a Equilibration<'p, D, N>,
    pub(super) choice: Acceleration,
    pub(super) maps: &'a Maps,
}

/// The maps of one element, with the data that all share.
pub(super) struct ElementSampler<'a, 'p, const D: usize, const N: usize> {
    shared: &'a SharedData<'a, 'p, D, N>,
    pub(super) id: ElementId,
    pub(super) element: &'a Element<D, N>,
    pub(super) measure: ElementMeasure<'a, D, N>,
}

impl<'a, 'p, const D: usize, const N: usize> ElementSampler<'a, 'p, D, N> {
    pub(super) fn new(shared: &'a SharedData<'a, 'p, D, N>, id: ElementId) -> Self {
        let (problem, element) = (shared.problem, &shared.equilibration.elements[id.index()]);
        Self { shared, id, element, measure: ElementMeasure::new(problem, element, id, shared.choice) }
    }

    pub(super) fn problem(&self) -> &'p Problem<D> {
        self.shared.problem
    }

    /// σ_DA of the fields that balance, by the form of the element, with its loading or without.
    pub(super) fn stress(&self, form: &ElementForm, balanced: &Balanced<D, N>, loaded: bool) -> SampledStress<D, N> {
        let AdmissibleStress { mean, fluctuation } = self.measure.stress(form, balanced);
        SampledStress { mean, fluctuation: fluctuation.energy(), loading: loaded.then_some(balanced.loading) }
    }

    /// The fields of the element at a half-step instant; `contact` gives the contact node at each local node.
    #[inline]
    pub(super) fn velocities(
        &self,
        velocities: &Velocities<D>,
        contact: &[Option<usize>; N],
    ) -> ElementVelocities<D, N> {
        ElementVelocities {
            motion: ElementMotion::gather(self.shared.problem, &velocities.motion, &self.element.nodes, contact),
            increment: self.measure.increment(velocities),
        }
    }

    /// The fields of the element in the middle of a step between two levels; `contact` gives the contact node at each
    /// local node.
    pub(super) fn velocities_half_way(
        &self,
        [from, to]: [&EquilibratedLevel<'_, D>; 2],
        contact: &[Option<usize>; N],
    ) -> ElementVelocities<D, N> {
        let (element, [start, end]) = (self.element, [from.forces(), to.forces()]);
        let (length, now) = (self.shared.times.step(from.index()), &end.now);
        let last = self.measure.acceleration(to, contact, Side::Before);
        let half_way = |increment: &Increment<D>, start: &[[f64; D]], end: &[[f64; D]; N]| {
            let (increment, start) = (increment.gather(&element.nodes), element.gather(start));
            std::array::from_fn(|i| increment::half_way(length, &increment[i], [&start[i], &end[i]]))
        };
        let skew = now.skew_increment.as_ref().zip(start.level.skew()).zip(end.level.skew());
        let skew = skew.map(|((increment, start), end)| half_way(increment, start, &element.gather(end)));
        let increment = half_way(&now.increment, &start.acceleration, &last);
        let problem = self.shared.problem;
        let mid_velocity = end.mid_velocity.as_ref();
        let mid_velocity = mid_velocity.map(|field| gather_common(problem, field, &element.nodes, contact));
        let motion = ElementMotion::gather(problem, &now.motion, &element.nodes, contact);
        ElementVelocities {
            motion: mid_velocity.map_or(motion, |velocity| motion.half_way(length, velocity)),
            increment: self.measure.increment_of(&increment, skew.as_ref()),
        }
    }

    /// The fields that balance at a level; `contact` gives the contact node at each local node.
    pub(super) fn balanced(
        &self,
        level: &EquilibratedLevel<'_, D>,
        contact: &[Option<usize>; N],
        side: Side,
    ) -> Balanced<D, N> {
        self.measure.balanced(&self.measure.nodal_balance(self.shared.equilibration, level, contact, side))
    }

    /// Checks their resultants, and their stress if it is the turn of the element: the map that makes the stress is
    /// linear and the same at all levels.
    pub(super) fn check(
        &self,
        balanced: &Balanced<D, N>,
        level: &EquilibratedLevel<'_, D>,
        turn: bool,
        residuals: &mut Residuals,
    ) {
        let residual = self.measure.resultant_residual(balanced, level.force_scale());
        residuals.element_resultants = worse(residuals.element_resultants, residual);
        if turn {
            self.check_stress(balanced, level, residuals);
        }
    }

    /// Checks their stress.
    pub(super) fn check_stress(
        &self,
        balanced: &Balanced<D, N>,
        level: &EquilibratedLevel<'_, D>,
        residuals: &mut Residuals,
    ) {
        self.measure.check_stress(balanced, level.force_scale(), residuals);
    }

    /// Samples an interval at its beginning, middle and end, goes on with the integral, and keeps the maps that are
    /// wanted. Gives the samples, and by how much stresses beside σ_DA change η there (J), at the beginning only if
    /// this is sampled.
    pub(super) fn sample(
        &self,
        interval: &ElementInterval<'_, D, N>,
        course: &mut Course,
        kept: &mut Vec<Contribution>,
    ) -> ([ElementSample; 3], [f64; 3]) {
        let mut changes = [0.0; 3];
        let mut at = |(stress, at): SampledFields<'_, D, N>, k: usize| {
            let (hats, residual) = (interval.hats[k], &interval.residual[k]);
            let plastic = interval.plastic.as_ref().map(|parts| &parts[k]);
            let misfit = stress.loading.as_ref().map(|loading| self.measure.difference(loading, &at.motion, plastic));
            let of_misfit = |work: &dyn Fn(&Loading<D, N>) -> f64| misfit.as_ref().map_or(0.0, work);
            let of_hats = of_misfit(&|misfit| hat_energy(misfit, hats));
            let alone = self.measure.error_of(
                (&stress.mean, stress.fluctuation),
                &at.increment,
                &at.motion,
                (of_hats, plastic),
            );
            let error = if residual.is_none() {
                alone
            } else {
                let extent = self.shared.problem.material(self.id).extent();
                let hats: f64 = hats.iter().map(|hat| hats.len() as f64 * hat.energy()).sum();
                let energies = [stress.fluctuation, hats].map(|energy| extent * energy);
                alone.residual(residual, of_misfit(&|misfit| work(misfit, &residual.products)), energies)
            };
            changes[k] = error.elastic - alone.elastic;
            let eigenstrain = plastic.map_or([0.0; 3], |part| components(&part.eigenstrain));
            ElementSample { error, contact: interval.contact[k], eigenstrain }
        };
        if let Some(start) = interval.start {
            course.last = at(start, 0);
            self.keep(interval.steps[0], course, kept);
        }
        let start = course.last;
        let middle = interval.mid.map(|mid| at(mid, 1));
        let end = at(interval.end, 2);
        let [from, to] = interval.steps.map(|n| self.shared.times.instants()[n]);
        course.integral += trapezoid(to - from, start.total(), middle.map(|m| m.total()), end.total());
        course.last = end;
        self.keep(interval.steps[1], course, kept);
        ([start, middle.unwrap_or_default(), end], changes)
    }

    /// Keeps a sample if it is wanted.
    fn keep(&self, step: usize, course: &Course, kept: &mut Vec<Contribution>) {
        if self.shared.maps.want(step) {
            course.keep(self.id, step, kept);
        }
    }
}
