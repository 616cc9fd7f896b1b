//! Kinematically admissible fields u_CA, w_CA (§6.1).
//!
//! [`NodalTrajectory`] carries the nodal values \[39\], \[40\], \[43\] of all nodes along the steps;
//! [`ContactMotion`] replaces the normal component of a node that may touch by the solution of
//! problem P_CA. Both end in an [`ElementMotion`]. Only this module makes one, so that no raw finite-element field can
//! be measured.
//!
//! Half-step instant k of a run is t_{k/2}: t_n for k = 2n, the middle of a step for odd k.

mod common_motion;
mod contact_motion;
mod contact_motions;
mod corner;
mod nodal_trajectory;
mod non_matching;
mod normal_motions;
mod shape;
mod window;

pub(crate) use common_motion::common;
pub(crate) use contact_motion::{ContactMotion, NormalStep};
pub(crate) use contact_motions::ContactMotions;
use corner::Corner;
pub(crate) use corner::at_both_planes;
pub(crate) use nodal_trajectory::{NodalMotion, NodalTrajectory, half_way};
pub(crate) use non_matching::NonMatchingInstant;
pub(crate) use normal_motions::NormalMotions;

use crate::field_lanes::gather;
use crate::numbers::Reader;
use percute_core::contact::Frame;
use percute_core::ids::NodeId;
use percute_core::problem::Problem;
use percute_core::simd::Registers;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value, load, store};

/// u_CA and u̇_CA at the nodes of one element at one half-step instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementMotion<const D: usize, const N: usize, T = f64> {
    displacement: [[T; D]; N],
    velocity: [[T; D]; N],
}

impl<const D: usize, const N: usize> ElementMotion<D, N> {
    /// The motion of an element before that of its contact nodes is known: the common motion of two that may touch.
    /// `contact` gives the contact node at each local node.
    #[inline]
    pub(crate) fn gather(
        problem: &Problem<D>,
        motion: &NodalMotion<D>,
        nodes: &[NodeId; N],
        contact: &[Option<usize>; N],
    ) -> Self {
        Self {
            displacement: gather_common(problem, motion.displacement(), nodes, contact),
            velocity: gather_common(problem, motion.velocity(), nodes, contact),
        }
    }

    /// Appends it to numbers.
    pub(crate) fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(self.displacement.as_flattened());
        numbers.extend_from_slice(self.velocity.as_flattened());
    }

    /// A motion that was appended.
    pub(crate) fn read(numbers: &mut Reader<'_>) -> Self {
        Self { displacement: numbers.vectors(), velocity: numbers.vectors() }
    }

    /// Any motion, for tests.
    #[cfg(test)]
    pub(crate) fn any(displacement: [[f64; D]; N], velocity: [[f64; D]; N]) -> Self {
        Self { displacement, velocity }
    }

    /// Puts the solution of P_CA in the place of the normal components at local node `i`, which is this node of the
    /// contact surface, the first one at two planes.
    pub(crate) fn set_normal(
        &mut self,
        (problem, i, at): (&Problem<D>, usize, usize),
        tracks: &[ContactMotion],
        instant: usize,
    ) {
        settle((problem, at), [&mut self.displacement[i], &mut self.velocity[i]], tracks, instant);
    }
}

impl<const D: usize, const N: usize, T: Value> ElementMotion<D, N, T> {
    /// The motion in the middle of the step of this length (s) that ends with this one, from the velocities in the
    /// middle (m/s).
    #[inline(always)]
    pub(crate) fn half_way(&self, length: T, velocity: [[T; D]; N]) -> Self {
        let mut displacement = self.displacement;
        for i in 0..N {
            displacement[i] = half_way(length, &displacement[i], [&velocity[i], &self.velocity[i]]);
        }
        Self { displacement, velocity }
    }
}

impl<const D: usize, const N: usize, T> ElementMotion<D, N, T> {
    #[inline(always)]
    pub(crate) fn displacement(&self) -> &[[T; D]; N] {
        &self.displacement
    }

    #[inline(always)]
    pub(crate) fn velocity(&self) -> &[[T; D]; N] {
        &self.velocity
    }
}

/// u_CA and u̇_CA at a node, at some half-step instants side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotionLanes<const D: usize> {
    displacement: [Lanes; D],
    velocity: [Lanes; D],
}

impl<const D: usize> MotionLanes<D> {
    pub(crate) const REST: Self = Self { displacement: [Lanes::ZERO; D], velocity: [Lanes::ZERO; D] };

    /// Takes the motion of these nodes into their records.
    #[inline(always)]
    pub(crate) fn gather<'m, R: Registers, P>(
        like: Wide<R>,
        records: &mut [P],
        nodes: &[u32],
        motions: impl Iterator<Item = Option<&'m NodalMotion<D>>> + Clone,
        place: impl Fn(&mut P) -> &mut Self,
    ) {
        gather(
            like,
            records,
            nodes,
            motions.clone().map(|motion| motion.map(NodalMotion::displacement)),
            #[inline(always)]
            |record| &mut place(record).displacement,
        );
        gather(
            like,
            records,
            nodes,
            motions.map(|motion| motion.map(NodalMotion::velocity)),
            #[inline(always)]
            |record| &mut place(record).velocity,
        );
    }

    /// Takes the velocities of these nodes in the middle of steps into their records.
    #[inline(always)]
    pub(crate) fn gather_velocity<'m, R: Registers, P>(
        like: Wide<R>,
        records: &mut [P],
        nodes: &[u32],
        velocities: impl Iterator<Item = Option<&'m [[f64; D]]>> + Clone,
        place: impl Fn(&mut P) -> &mut Self,
    ) {
        gather(
            like,
            records,
            nodes,
            velocities,
            #[inline(always)]
            |record| &mut place(record).velocity,
        );
    }

    /// Completes the motion in the middle of steps of these lengths (s), of which the velocity is known, from that at
    /// their ends.
    #[inline(always)]
    pub(crate) fn complete_half_way<T: Value<Stored = Lanes>>(&mut self, length: T, end: &Self) {
        let [mid, now] = [load(length, &self.velocity), load(length, &end.velocity)];
        let displacement = half_way(length, &load(length, &end.displacement), [&mid, &now]);
        self.displacement = store(&displacement);
    }
}

impl<const D: usize, const N: usize, T: Value<Stored = Lanes>> ElementMotion<D, N, T> {
    /// The motion of an element without contact node, from that of its nodes, in the form of a number.
    #[inline(always)]
    pub(crate) fn of_nodes(like: T, nodes: [&MotionLanes<D>; N]) -> Self {
        let mut motion = Self { displacement: [[like; D]; N], velocity: [[like; D]; N] };
        for i in 0..N {
            motion.displacement[i] = load(like, &nodes[i].displacement);
            motion.velocity[i] = load(like, &nodes[i].velocity);
        }
        motion
    }
}

/// Values of a nodal field at the nodes of an element, the common motion at contact nodes.
#[inline]
pub(crate) fn gather_common<const D: usize, const N: usize>(
    problem: &Problem<D>,
    field: &[[f64; D]],
    nodes: &[NodeId; N],
    contact: &[Option<usize>; N],
) -> [[f64; D]; N] {
    let at = |i: usize| contact[i].map_or_else(|| field[nodes[i].index()], |at| common(problem, at, field));
    std::array::from_fn(at)
}

/// Puts the solution of P_CA in the place of the normal components of the motion of a contact node, displacement and
/// velocity; it is the common motion of two nodes that may touch. A node at two planes gets both normal components, one
/// of non-matching interfaces the change of its own.
pub(crate) fn settle<const D: usize>(
    (problem, at): (&Problem<D>, usize),
    [displacement, velocity]: [&mut [f64; D]; 2],
    tracks: &[ContactMotion],
    instant: usize,
) {
    let (contact, track) = (&problem.surface().nodes()[at], &tracks[at]);
    if let Some(second) = contact.second_slot {
        if let Some(corner) = Corner::of(problem, contact, [track, &tracks[second]], instant) {
            corner.settle_displacement(displacement);
            corner.settle_velocity(velocity);
        }
        return;
    }
    let frame: Frame<D> = problem.obstacles()[contact.obstacle].flat_frame();
    if problem.surface().non_matching_of(at).is_some() {
        let (speed, place) = track.at(instant);
        for c in 0..D {
            displacement[c] += place * frame.normal()[c];
            velocity[c] += speed * frame.normal()[c];
        }
        return;
    }
    if contact.partner.is_some() {
        let part = problem.surface().own_part(at, problem.mass());
        let (speed, gap) = track.at(instant);
        for c in 0..D {
            displacement[c] += part * (gap - track.undeformed_gap()) * frame.normal()[c];
            velocity[c] += part * speed * frame.normal()[c];
        }
        return;
    }
    if !track.is_altered(instant) {
        // Not rebuilt from the gap, in which a distant plane would drown the displacement.
        return;
    }
    let (speed, gap) = track.at(instant);
    let (_, tangential) = frame.split(displacement);
    let (_, sliding) = frame.split(velocity);
    for c in 0..D {
        displacement[c] = tangential[c] + (gap - track.undeformed_gap()) * frame.normal()[c];
        velocity[c] = sliding[c] + speed * frame.normal()[c];
    }
}
