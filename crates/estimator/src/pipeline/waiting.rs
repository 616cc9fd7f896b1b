//! Intervals of near elements that wait until the motion of their nodes is known, as numbers.

use super::sampling::{ElementVelocities, SampledStress};
use crate::contact_density::{CornerSliding, FacePressures, NarrowHat, ResidualStress};
use crate::numbers::Reader;

/// An element at a half-step instant; until contact is solved for, its normal components are those of the simulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactInstant<const D: usize, const N: usize> {
    pub(super) velocities: ElementVelocities<D, N>,
    /// The part of friction in the contact part of η (J).
    pub(super) friction: f64,
}

/// A sample that waits: the stress is known, the motion is not.
#[derive(Clone, Copy, Debug)]
pub(super) struct WaitingSample<const D: usize, const N: usize> {
    pub(super) at: ContactInstant<D, N>,
    pub(super) stress: SampledStress<D, N>,
}

/// An interval whose motion is not known yet.
#[derive(Clone, Debug)]
pub(super) struct Waiting<const D: usize, const N: usize> {
    /// The stress at its beginning, if this has to be sampled: the first one, or one after a jump.
    pub(super) start: Option<SampledStress<D, N>>,
    pub(super) mid: Option<WaitingSample<D, N>>,
    pub(super) stop: WaitingSample<D, N>,
    /// Which nodes touch at the beginning and at the end: the plane of their first slot, and a second one.
    pub(super) touching: [[[bool; 2]; N]; 2],
    /// Pressures on its candidate faces, where they act off contact.
    pub(super) pressures: Vec<FacePressures<D>>,
    /// Sliding on its candidate faces beside a node at two planes, step by step.
    pub(super) sliding: Vec<CornerSliding<D>>,
    /// Stresses beside σ_DA at the beginning and the end, of non-matching interfaces.
    pub(super) residual: [ResidualStress; 2],
    /// Narrow hats of its nodes at the beginning and the end, those of a node side by side.
    pub(super) hats: [Vec<NarrowHat<D>>; 2],
}

/// Numbers of an interval of several steps without pressures, sliding and hats.
pub(super) const fn shortest<const D: usize, const N: usize>() -> usize {
    5 + sample::<D, N>()
}

/// Numbers of a sample.
pub(super) const fn sample<const D: usize, const N: usize>() -> usize {
    3 * N * D + D * D + 2
}

impl<const D: usize, const N: usize> WaitingSample<D, N> {
    fn append(&self, numbers: &mut Vec<f64>) {
        self.at.velocities.append(numbers);
        numbers.push(self.at.friction);
        self.stress.append(numbers);
    }

    fn read(numbers: &mut Reader<'_>, loaded: bool) -> Self {
        let at = ContactInstant { velocities: ElementVelocities::read(numbers), friction: numbers.number() };
        Self { at, stress: SampledStress::read(numbers, loaded) }
    }
}

impl<const D: usize, const N: usize> Waiting<D, N> {
    /// Whether there are stresses beside σ_DA, which need the loading that it balances.
    pub(super) fn is_loaded(hats: &[Vec<NarrowHat<D>>; 2], residual: &[ResidualStress; 2]) -> bool {
        hats.iter().any(|hats| !hats.is_empty()) || !residual.iter().all(ResidualStress::is_none)
    }

    /// Appends it to numbers.
    pub(super) fn append(&self, numbers: &mut Vec<f64>) {
        let touching = self.touching.as_flattened().as_flattened().iter().copied();
        let residual = !self.residual.iter().all(ResidualStress::is_none);
        let flags = [self.start.is_some(), self.mid.is_some(), residual].into_iter().chain(touching);
        numbers.push(flags.fold(0, |flags, flag| 2 * flags + usize::from(flag)) as f64);
        if residual {
            self.residual.iter().for_each(|residual| residual.append(numbers));
        }
        let [from, to] = &self.hats;
        let counts = [self.pressures.len(), self.sliding.len(), from.len(), to.len()];
        numbers.extend(counts.map(|count| count as f64));
        self.pressures.iter().for_each(|pressures| pressures.append(numbers));
        self.sliding.iter().for_each(|sliding| sliding.append(numbers));
        self.hats.iter().flatten().for_each(|hat| hat.append(numbers));
        self.start.iter().for_each(|start| start.append(numbers));
        self.mid.iter().for_each(|mid| mid.append(numbers));
        self.stop.append(numbers);
    }

    /// One that was appended.
    pub(super) fn read(numbers: &mut Reader<'_>) -> Self {
        let flags = numbers.count();
        let flag = |k: usize| (flags >> (4 * N + 2 - k)) & 1 == 1;
        let residual = [(); 2].map(|()| if flag(2) { ResidualStress::read(numbers) } else { ResidualStress::NONE });
        let [pressures, sliding, from, to] = [(); 4].map(|()| numbers.count());
        let pressures = (0..pressures).map(|_| FacePressures::read(numbers)).collect();
        let sliding = (0..sliding).map(|_| CornerSliding::read(numbers)).collect();
        let hats = [from, to].map(|count| (0..count).map(|_| NarrowHat::read(numbers)).collect());
        let loaded = Self::is_loaded(&hats, &residual);
        Self {
            start: flag(0).then(|| SampledStress::read(numbers, loaded)),
            mid: flag(1).then(|| WaitingSample::read(numbers, loaded)),
            stop: WaitingSample::read(numbers, loaded),
            touching: [0, 1].map(|end| std::array::from_fn(|i| [0, 1].map(|k| flag(3 + 2 * (end * N + i) + k)))),
            pressures,
            sliding,
            residual,
            hats,
        }
    }
}
