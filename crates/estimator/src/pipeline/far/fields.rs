//! The fields of a block of far elements at some levels, and in the middles of the steps before them.

use super::FarLevels;
use crate::field_lanes::gather;
use crate::increment::{self, Increment};
use crate::kinematic::MotionLanes;
use crate::measure::BalanceFields;
use crate::time_level::Velocities;
use percute_core::simd::Registers;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value, load, store};

/// The fields of a block at some levels, and in the middles before them.
#[derive(Default)]
pub(super) struct BlockFields<const D: usize> {
    pub(super) now: Vec<VelocityLanes<D>>,
    pub(super) mid: Vec<VelocityLanes<D>>,
    pub(super) balance: BalanceFields<D>,
}

/// [`Velocities`] of a node side by side.
#[derive(Clone, Copy)]
pub(super) struct VelocityLanes<const D: usize> {
    pub(super) motion: MotionLanes<D>,
    pub(super) increment: [Lanes; D],
    pub(super) skew_increment: [Lanes; D],
}

impl<const D: usize> VelocityLanes<D> {
    const REST: Self =
        Self { motion: MotionLanes::REST, increment: [Lanes::ZERO; D], skew_increment: [Lanes::ZERO; D] };

    #[inline(always)]
    fn gather<'v, R: Registers>(
        like: Wide<R>,
        records: &mut Vec<Self>,
        nodes: &[u32],
        velocities: impl Iterator<Item = Option<&'v Velocities<D>>> + Clone,
        split: bool,
    ) {
        records.resize(nodes.len(), Self::REST);
        MotionLanes::gather(
            like,
            records,
            nodes,
            velocities.clone().map(|v| v.map(|v| &v.motion)),
            #[inline(always)]
            |record| &mut record.motion,
        );
        gather(
            like,
            records,
            nodes,
            velocities.clone().map(|v| v.map(|v| v.increment.values())),
            #[inline(always)]
            |record| &mut record.increment,
        );
        if split {
            gather(
                like,
                records,
                nodes,
                velocities.map(|v| v.and_then(|v| v.skew_increment.as_ref()).map(Increment::values)),
                #[inline(always)]
                |record| &mut record.skew_increment,
            );
        }
    }
}

impl<const D: usize, const N: usize> FarLevels<'_, '_, '_, D, N> {
    /// Takes the fields of these nodes.
    #[inline(always)]
    pub(super) fn gather<R: Registers>(&self, like: Wide<R>, fields: &mut BlockFields<D>, nodes: &[u32]) {
        let forces = self.levels.levels.forces();
        fields.balance.gather(like, self.shared.problem, nodes, self.levels.levels);
        let split = fields.balance.is_split();
        VelocityLanes::gather(like, &mut fields.now, nodes, forces.iter().map(|f| Some(&f.now)), split);
        if self.has_mids {
            fields.mid.resize(nodes.len(), VelocityLanes::REST);
            MotionLanes::gather_velocity(
                like,
                &mut fields.mid,
                nodes,
                forces.iter().map(|f| f.mid_velocity.as_deref()),
                #[inline(always)]
                |record| &mut record.motion,
            );
            self.complete_middles(like, fields, nodes);
        }
    }

    /// Completes the fields of nodes in the middles of the steps before levels, from those at both levels.
    #[inline(always)]
    fn complete_middles<R: Registers>(&self, like: Wide<R>, fields: &mut BlockFields<D>, nodes: &[u32]) {
        let (length, split) = (like.load(&self.lengths), fields.balance.is_split());
        let before = self.levels.before.map(|level| level.forces());
        let first_fields = [before.map(|f| &f.acceleration[..]), before.and_then(|f| f.level.skew())];
        let records = fields.mid.iter_mut().zip(&fields.now).zip(fields.balance.accelerations());
        for (((mid, now), [own, skew]), &node) in records.zip(nodes) {
            mid.motion.complete_half_way(length, &now.motion);
            let first = first_fields[0].map_or([0.0; D], |field| field[node as usize]);
            mid.increment = half_way(length, &now.increment, own, &first);
            if split {
                let first = first_fields[1].map_or([0.0; D], |field| field[node as usize]);
                mid.skew_increment = half_way(length, &now.skew_increment, skew, &first);
            }
        }
    }
}

/// The integral of a field in the middles of the steps before levels, from the integral and the field at the levels and
/// the field at the level before the first of them.
#[inline(always)]
fn half_way<R: Registers, const D: usize>(
    length: Wide<R>,
    last: &[Lanes; D],
    field: &[Lanes; D],
    first: &[f64; D],
) -> [Lanes; D] {
    let (last, end) = (load(length, last), load(length, field));
    let mut start = end;
    for c in 0..D {
        start[c] = end[c].later(first[c]);
    }
    store(&increment::half_way(length, &last, [&start, &end]))
}
