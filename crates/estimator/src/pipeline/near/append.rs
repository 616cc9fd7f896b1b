//! The intervals of a near element, as numbers that wait.

use super::NearElement;
use super::side_by_side::SideBySide;
use crate::contact_density::FacePressures;
use crate::measure::Balanced;
use crate::pipeline::sampled_levels::SampledLevels;
use crate::pipeline::sampling::{ElementSampler, SampledStress, SharedData};
use crate::pipeline::waiting::{ContactInstant, Waiting, WaitingSample};
use crate::residual::worse;
use crate::time_level::{Side, Velocities};
use crate::traction::EquilibratedLevel;

/// The pointwise equilibrium of σ_DA is checked in one interval of so many: a check costs as much as the stress of four
/// intervals.
const CHECK: usize = 64;

/// An instant of an interval.
#[derive(Clone, Copy, Debug)]
enum At {
    Start,
    Middle,
    End,
}

impl<const D: usize, const N: usize> NearElement<D, N> {
    /// Appends the intervals between consecutive levels to numbers.
    pub(in crate::pipeline) fn append(
        &mut self,
        shared: &SharedData<'_, '_, D, N>,
        levels: &SampledLevels<'_, D>,
        numbers: &mut Vec<f64>,
    ) {
        let sampler = ElementSampler::new(shared, self.element);
        if levels.before.is_none() {
            self.start = Some(self.at(&sampler, &levels.levels.forces()[0].now, 0.0));
        }
        let before = levels.before.as_ref().map(EquilibratedLevel::forces);
        if before.into_iter().chain(levels.levels.forces()).any(|forces| forces.before.is_some()) {
            self.append_each(&sampler, levels, numbers);
        } else {
            self.append_side_by_side(&sampler, levels, numbers);
        }
    }

    /// One after the other: the contact force jumps at some of them.
    fn append_each(
        &mut self,
        sampler: &ElementSampler<'_, '_, D, N>,
        levels: &SampledLevels<'_, D>,
        numbers: &mut Vec<f64>,
    ) {
        self.reached = None;
        for interval in levels.intervals() {
            let [from, to] = &interval;
            let [start, end] = [(from, Side::After), (to, Side::Before)]
                .map(|(level, side)| sampler.balanced(level, &self.contact, side));
            let (begins, turn) = (from.index() == 0 || from.forces().before.is_some(), self.turn());
            if begins {
                sampler.check(&start, from, turn, &mut self.residuals);
            }
            sampler.check(&end, to, turn, &mut self.residuals);
            let stress = |at: At, loaded: bool| match at {
                At::Start => sampler.stress(&self.form, &start, loaded),
                At::Middle => sampler.stress(&self.form, &Balanced::middle(&start, &end), loaded),
                At::End => sampler.stress(&self.form, &end, loaded),
            };
            self.interval(sampler, interval, begins, stress).append(numbers);
        }
    }

    /// All of them together.
    fn append_side_by_side(
        &mut self,
        sampler: &ElementSampler<'_, '_, D, N>,
        levels: &SampledLevels<'_, D>,
        numbers: &mut Vec<f64>,
    ) {
        let before = levels.before.as_ref();
        let reached = self.reached.take();
        let reached = reached.or_else(|| Some(sampler.balanced(before?, &self.contact, Side::After)));
        let fields = SideBySide::new((sampler, &self.form), levels.levels, reached.as_ref());
        let count = levels.levels.len();
        let worst = fields.residual.0[..count].iter().copied().fold(0.0, worse);
        self.residuals.element_resultants = worse(self.residuals.element_resultants, worst);
        for (lane, interval) in (count - levels.intervals().count()..).zip(levels.intervals()) {
            let [from, to] = &interval;
            let begins = from.index() == 0;
            // Before the first of these levels is the one that was reached.
            let start = || lane.checked_sub(1).map_or(reached, |before| Some(fields.balanced(before)));
            if self.turn() {
                sampler.check_stress(&fields.balanced(lane), to, &mut self.residuals);
                let start = start().filter(|_| begins);
                start.iter().for_each(|start| sampler.check_stress(start, from, &mut self.residuals));
            }
            let stress = |at: At, loaded: bool| match at {
                At::Start => {
                    start().map_or_else(|| fields.end(lane, loaded), |start| sampler.stress(&self.form, &start, loaded))
                }
                At::Middle => fields.middle(lane, loaded),
                At::End => fields.end(lane, loaded),
            };
            self.interval(sampler, interval, begins, stress).append(numbers);
        }
        self.reached = Some(fields.balanced(count - 1));
    }

    /// Whether the stress of the next interval is checked.
    fn turn(&mut self) -> bool {
        self.checks += 1;
        (self.checks - 1 + self.element.index()).is_multiple_of(CHECK)
    }

    /// An interval, whose beginning is sampled if it `begins` anew; `stress` gives the stress there, with its loading
    /// or without.
    fn interval(
        &self,
        sampler: &ElementSampler<'_, '_, D, N>,
        [from, to]: [EquilibratedLevel<'_, D>; 2],
        begins: bool,
        stress: impl Fn(At, bool) -> SampledStress<D, N>,
    ) -> Waiting<D, N> {
        let forces = to.forces();
        let friction = |k: usize| self.faces.iter().map(|&f| forces.friction[f][k]).sum::<f64>();
        let surface = sampler.problem().surface();
        let slots = |at: Option<usize>| [at, at.and_then(|at| surface.nodes()[at].second_slot)];
        let touches = |level: &EquilibratedLevel<'_, D>, at: usize| level.forces().level.surface.touching[at];
        let touching = [&from, &to]
            .map(|level| self.contact.map(|at| slots(at).map(|at| at.is_some_and(|at| touches(level, at)))));
        let faces = self.faces.iter().filter(|&&f| forces.off_contact.iter().any(|step| step.act_on(f)));
        let pressures = faces.map(|&f| FacePressures::gather(f, from.index(), &forces.off_contact));
        let pressures = pressures.filter(|pressures| !pressures.is_zero()).collect();
        let sliding = forces.corner_sliding.iter().filter(|sliding| self.faces.contains(&sliding.face));
        let sliding = sliding.cloned().collect();
        let hats: [Vec<_>; 2] = [&from, &to].map(|level| {
            self.contact.iter().flatten().flat_map(|&at| level.forces().density.hats_of(at)).copied().collect()
        });
        let problem = sampler.problem();
        let residual = [&from, &to].map(|level| level.forces().density.residual(problem, self.element));
        let loaded = Waiting::<D, N>::is_loaded(&hats, &residual);
        let single = forces.mid_velocity.is_some() && to.index() == from.index() + 1;
        let mid = single.then(|| WaitingSample {
            at: ContactInstant {
                velocities: sampler.velocities_half_way([&from, &to], &self.contact),
                friction: friction(0),
            },
            stress: stress(At::Middle, loaded),
        });
        let stop = WaitingSample { at: self.at(sampler, &forces.now, friction(1)), stress: stress(At::End, loaded) };
        Waiting {
            start: begins.then(|| stress(At::Start, loaded)),
            mid,
            stop,
            touching,
            pressures,
            sliding,
            residual,
            hats,
        }
    }

    pub(super) fn at(
        &self,
        sampler: &ElementSampler<'_, '_, D, N>,
        velocities: &Velocities<D>,
        friction: f64,
    ) -> ContactInstant<D, N> {
        ContactInstant { velocities: sampler.velocities(velocities, &self.contact), friction }
    }
}
