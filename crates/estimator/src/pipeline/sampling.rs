//! η of one element at the samples of an interval, its integral over time, and the maps of it.

use super::maps::{Contribution, Maps};
use crate::concentrated::HatStress;
use crate::element::Element;
use crate::kinematic::ElementMotion;
use crate::measure::{Balanced, ElementError, ElementMeasure};
use crate::options::Acceleration;
use crate::residual::Residuals;
use crate::time_level::{Side, Velocities};
use crate::traction::{Equilibrated, Equilibration};
use percute_core::ids::ElementId;
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
}

/// The contact part of η (J).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactPart {
    pub(super) total: f64,
    /// ∫∫F_n|w_n| dt in it.
    pub(super) normal_work: f64,
}

impl ElementSample {
    fn total(&self) -> f64 {
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

/// The fields of an element at one half-step instant that do not depend on tractions.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementVelocities<const D: usize, const N: usize> {
    pub(super) motion: ElementMotion<D, N>,
    /// ∫Γ_DA/ρ dt (m/s).
    increment: [[f64; D]; N],
}

/// One interval between sampled levels.
pub(super) struct ElementInterval<'i, const D: usize, const N: usize> {
    /// The steps at its beginning and its end.
    pub(super) steps: [usize; 2],
    /// The fields that balance there, inside the interval.
    pub(super) balanced: [&'i Balanced<D, N>; 2],
    /// Its beginning, unless the sample at the end of the interval before is the same.
    pub(super) start: Option<&'i ElementVelocities<D, N>>,
    /// Its middle, if it is one step long.
    pub(super) mid: Option<&'i ElementVelocities<D, N>>,
    pub(super) end: &'i ElementVelocities<D, N>,
    /// The contact part of η at its beginning, middle and end (J).
    pub(super) contact: [ContactPart; 3],
    /// The stress of hats at its beginning, middle and end.
    pub(super) hats: [&'i [HatStress<'i>]; 3],
}

/// The data that all elements share.
#[derive(Clone, Copy)]
pub(super) struct Sampling<'a, 'p, const D: usize, const N: usize> {
    pub(super) problem: &'p Problem<D, N>,
    pub(super) times: &'p TimeGrid,
    pub(super) equilibration: &'a Equilibration<'p, D, N>,
    pub(super) choice: Acceleration,
    pub(super) maps: &'a Maps<D>,
}

/// The maps of one element, with the data that all share.
pub(super) struct ElementSampler<'a, 'p, const D: usize, const N: usize> {
    shared: &'a Sampling<'a, 'p, D, N>,
    id: ElementId,
    pub(super) element: &'a Element<D, N>,
    measure: ElementMeasure<'a, D, N>,
}

impl<'a, 'p, const D: usize, const N: usize> ElementSampler<'a, 'p, D, N> {
    pub(super) fn new(shared: &'a Sampling<'a, 'p, D, N>, id: ElementId) -> Self {
        let element = &shared.equilibration.elements[id.index()];
        Self { shared, id, element, measure: ElementMeasure::new(shared.problem, element, id, shared.choice) }
    }

    /// The fields of the element at a half-step instant.
    #[inline]
    pub(super) fn velocities(&self, velocities: &Velocities<D>) -> ElementVelocities<D, N> {
        ElementVelocities {
            motion: ElementMotion::gather(&velocities.motion, &self.element.nodes),
            increment: self.measure.increment(velocities),
        }
    }

    /// The fields that balance at a level; `contact` gives the contact node at each local node.
    #[inline(always)]
    pub(super) fn balanced(&self, level: &Equilibrated<D>, contact: &[Option<usize>; N], side: Side) -> Balanced<D, N> {
        self.measure.balanced(self.shared.equilibration, level, contact, side)
    }

    /// Checks their resultants, and their stress at one level of so many, each element in its turn: the map that makes the
    /// stress is linear and the same at all levels.
    #[inline(always)]
    pub(super) fn check(
        &self,
        balanced: &Balanced<D, N>,
        level: &Equilibrated<D>,
        turns: usize,
        residuals: &mut Residuals,
    ) {
        self.measure.check_resultants(balanced, level.force_scale(), residuals);
        if (level.index() + self.id.index()).is_multiple_of(turns) {
            self.measure.check_stress(balanced, level.force_scale(), residuals);
        }
    }

    /// Samples an interval at its beginning, middle and end, goes on with the integral, and keeps the maps that are wanted.
    #[inline(always)]
    pub(super) fn sample(
        &self,
        interval: &ElementInterval<'_, D, N>,
        course: &mut Course,
        kept: &mut Vec<Contribution>,
    ) -> [ElementSample; 3] {
        let at = |balanced: &Balanced<D, N>, at: &ElementVelocities<D, N>, k: usize| ElementSample {
            error: self.measure.error(balanced, &at.increment, &at.motion, interval.hats[k]),
            contact: interval.contact[k],
        };
        let [before, after] = interval.balanced;
        if let Some(start) = interval.start {
            course.last = at(before, start, 0);
            self.keep(interval.steps[0], course, kept);
        }
        let start = course.last;
        let middle = interval.mid.map(|mid| at(&Balanced::middle(before, after), mid, 1));
        let end = at(after, interval.end, 2);
        let [from, to] = interval.steps.map(|n| self.shared.times.instants()[n]);
        course.integral += trapezoid(to - from, start.total(), middle.map(|m| m.total()), end.total());
        course.last = end;
        self.keep(interval.steps[1], course, kept);
        [start, middle.unwrap_or_default(), end]
    }

    /// Keeps a sample if it is wanted; the one after a jump replaces the one before it.
    #[inline]
    fn keep(&self, step: usize, course: &Course, kept: &mut Vec<Contribution>) {
        if self.shared.maps.want(step) {
            kept.pop_if(|last| last.element == self.id && last.step == step);
            let ElementSample { error, contact } = course.last;
            let (contact, accumulated) = (contact.total, course.integral);
            kept.push(Contribution { element: self.id, step, error, contact, accumulated });
        }
    }
}
