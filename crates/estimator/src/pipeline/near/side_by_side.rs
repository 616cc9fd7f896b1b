//! The stresses of a near element at some levels side by side, and in the middles before them.
//!
//! The contact force jumps at none of these levels: the fields at the end of an interval are those at the beginning of
//! the next.

use crate::measure::{AdmissibleStress, Balanced, NodalBalance, outward};
use crate::pipeline::sampling::{ElementSampler, SampledStress};
use crate::stress::{ElementForm, Loading};
use crate::traction::EquilibratedLevels;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{LANES, Lanes, Value, load};
use percute_core::simd::{Registers, Task, run_task};
use std::array::from_fn;

/// The stresses at the levels or in the middles before them.
struct StressLanes<const D: usize, const N: usize> {
    mean: [[Lanes; D]; D],
    fluctuation: Lanes,
    loading: Loading<D, N, Lanes>,
}

/// The fields of an element that balance at some levels, and their stresses.
pub(super) struct SideBySide<const D: usize, const N: usize> {
    balanced: Balanced<D, N, Lanes>,
    /// Residual of the resultants at each level.
    pub(super) residual: Lanes,
    ends: StressLanes<D, N>,
    middles: StressLanes<D, N>,
}

impl<const D: usize, const N: usize> SideBySide<D, N> {
    /// Those at levels without a jump; `reached` are the fields at the level before.
    pub(super) fn new(
        (sampler, form): (&ElementSampler<'_, '_, D, N>, &ElementForm),
        levels: &EquilibratedLevels<D>,
        reached: Option<&Balanced<D, N>>,
    ) -> Self {
        run_task(AtLevels { sampler, form, levels, reached })
    }

    /// The fields at one level.
    pub(super) fn balanced(&self, lane: usize) -> Balanced<D, N> {
        Balanced::combine(&self.balanced, &self.balanced, |now, _| now.0[lane])
    }

    /// The stress at one level, with its loading or without.
    pub(super) fn end(&self, lane: usize, loaded: bool) -> SampledStress<D, N> {
        self.ends.at(lane, loaded)
    }

    /// The same in the middle before the level.
    pub(super) fn middle(&self, lane: usize, loaded: bool) -> SampledStress<D, N> {
        self.middles.at(lane, loaded)
    }
}

impl<const D: usize, const N: usize> StressLanes<D, N> {
    fn at(&self, lane: usize, loaded: bool) -> SampledStress<D, N> {
        let loading = || Loading {
            traction: self.loading.traction.map(|face| face.map(|node| node.map(|lanes| lanes.0[lane]))),
            volume: self.loading.volume.map(|node| node.map(|lanes| lanes.0[lane])),
        };
        let mean = self.mean.map(|row| row.map(|lanes| lanes.0[lane]));
        SampledStress { mean, fluctuation: self.fluctuation.0[lane], loading: loaded.then(loading) }
    }

    #[inline(always)]
    fn new<R: Registers>(stress: &AdmissibleStress<D, N, Wide<R>>, balanced: &Balanced<D, N, Wide<R>>) -> Self {
        let mut stored = Self {
            mean: [[Lanes::ZERO; D]; D],
            fluctuation: stress.fluctuation.energy().store(),
            loading: Loading { traction: [[[Lanes::ZERO; D]; D]; N], volume: [[Lanes::ZERO; D]; N] },
        };
        for a in 0..D {
            for b in 0..D {
                stored.mean[a][b] = stress.mean[a][b].store();
            }
        }
        for k in 0..N {
            for c in 0..D {
                for p in 0..D {
                    stored.loading.traction[k][p][c] = balanced.loading.traction[k][p][c].store();
                }
                stored.loading.volume[k][c] = balanced.loading.volume[k][c].store();
            }
        }
        stored
    }
}

/// An element to be worked on.
struct AtLevels<'a, 's, 'p, const D: usize, const N: usize> {
    sampler: &'a ElementSampler<'s, 'p, D, N>,
    form: &'a ElementForm,
    levels: &'a EquilibratedLevels<D>,
    reached: Option<&'a Balanced<D, N>>,
}

impl<const D: usize, const N: usize> Task for AtLevels<'_, '_, '_, D, N> {
    type Output = SideBySide<D, N>;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> SideBySide<D, N> {
        let Self { sampler, form, levels, reached } = self;
        let (like, measure) = (Wide::zeros(registers), &sampler.measure);
        let end = measure.balanced(&nodal_balance(like, sampler, levels));
        let start = match reached {
            Some(reached) => Balanced::combine(
                reached,
                &end,
                #[inline(always)]
                |last: f64, now: Wide<R>| now.later(last),
            ),
            // Before the first level there is no middle.
            None => Balanced::combine(
                &end,
                &end,
                #[inline(always)]
                |now: Wide<R>, _: Wide<R>| now.later(0.0),
            ),
        };
        let middle = Balanced::middle(&start, &end);
        SideBySide {
            residual: measure.resultant_residual(&end, like.load(&levels.force_scale())).store(),
            ends: StressLanes::new(&measure.stress(form, &end), &end),
            middles: StressLanes::new(&measure.stress(form, &middle), &middle),
            balanced: Balanced::combine(
                &end,
                &end,
                #[inline(always)]
                |now: Wide<R>, _: Wide<R>| now.store(),
            ),
        }
    }
}

/// The fields of an element at levels without a jump.
#[inline(always)]
fn nodal_balance<R: Registers, const D: usize, const N: usize>(
    like: Wide<R>,
    sampler: &ElementSampler<'_, '_, D, N>,
    levels: &EquilibratedLevels<D>,
) -> NodalBalance<D, N, Wide<R>> {
    let (element, forces, moments) = (sampler.element, levels.forces(), levels.moments());
    // Levels that are not there have the fields of the last one.
    let lane = |k: usize| &forces[k.min(forces.len() - 1)];
    let accelerations: [&[[f64; D]]; LANES] = from_fn(|k| &lane(k).acceleration[..]);
    let skews: [Option<&[[f64; D]]>; LANES] = from_fn(|k| lane(k).level.skew());
    let (mut acceleration, mut skew, mut displacement) = ([[like; D]; N], [[like; D]; N], [[like; D]; N]);
    let turning = sampler.problem().is_finite();
    for i in 0..N {
        let node = element.nodes[i].index();
        for c in 0..D {
            if turning {
                displacement[i][c] = like.load(&Lanes::at_levels(|k| lane(k).level.displacement[node][c]));
            }
            acceleration[i][c] = like.load(&Lanes::at_levels(|k| accelerations[k][node][c]));
            skew[i][c] = like.load(&Lanes::at_levels(|k| skews[k].map_or(0.0, |skew| skew[node][c])));
        }
    }
    NodalBalance {
        moments: outward(
            &element.links,
            #[inline(always)]
            |i| {
                let mut own = [[like; D]; D];
                for p in 0..D {
                    own[p] = load(like, &moments[element.links[i][p].place()]);
                }
                own
            },
        ),
        acceleration,
        skew: skews[0].is_some().then_some(skew),
        body_force: load(like, &levels.body_force(sampler.id)),
        displacement: turning.then_some(displacement),
    }
}
