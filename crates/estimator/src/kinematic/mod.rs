//! Kinematically admissible fields u_CA, w_CA (§6.1).
//!
//! [`FreeMotion`] carries the nodal values \[39\], \[40\], \[43\] of all nodes along the steps;
//! [`ContactTrack`] replaces the normal component of a node that may touch by the solution of
//! problem P_CA. Both end in an [`ElementMotion`]. Only this module makes one, so that no raw finite-element field can be
//! measured.
//!
//! Half-step instant k of a run is t_{k/2}: t_n for k = 2n, the middle of a step for odd k.

mod contact_track;
mod free_motion;
mod shape;
mod window;

pub(crate) use contact_track::{ContactTrack, NormalStep};
pub(crate) use free_motion::{FreeMotion, NodalMotion};

use crate::lanes::{FieldLanes, Lanes};
use percute_core::contact::Frame;
use percute_core::ids::NodeId;

/// u_CA and u̇_CA at the nodes of one element at one half-step instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementMotion<const D: usize, const N: usize, T = f64> {
    displacement: [[T; D]; N],
    velocity: [[T; D]; N],
}

impl<const D: usize, const N: usize> ElementMotion<D, N> {
    /// The motion of an element of which no node may touch a plane, or before its contact nodes
    /// are known.
    #[inline]
    pub(crate) fn gather(motion: &NodalMotion<D>, nodes: &[NodeId; N]) -> Self {
        Self {
            displacement: nodes.map(|n| motion.displacement()[n.index()]),
            velocity: nodes.map(|n| motion.velocity()[n.index()]),
        }
    }

    /// Puts the solution of P_CA in the place of the normal components at local node `i`.
    pub(crate) fn set_normal(&mut self, i: usize, frame: &Frame<D>, track: &ContactTrack, instant: usize) {
        settle(&mut self.displacement[i], &mut self.velocity[i], frame, track, instant);
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

/// u_CA and u̇_CA at some nodes, at some half-step instants side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct MotionLanes<const D: usize> {
    displacement: FieldLanes<D>,
    velocity: FieldLanes<D>,
}

impl<const D: usize> MotionLanes<D> {
    /// Takes the values at these nodes, at each instant.
    #[inline(always)]
    pub(crate) fn gather<'m>(
        &mut self,
        nodes: &[u32],
        motions: impl Iterator<Item = Option<&'m NodalMotion<D>>> + Clone,
    ) {
        self.displacement.gather(nodes, motions.clone().map(|motion| motion.map(NodalMotion::displacement)));
        self.velocity.gather(nodes, motions.map(|motion| motion.map(NodalMotion::velocity)));
    }

    /// The motion of an element without contact node, whose nodes have these places.
    #[inline(always)]
    pub(crate) fn element<const N: usize>(&self, local: &[u32; N]) -> ElementMotion<D, N, Lanes> {
        ElementMotion { displacement: self.displacement.of(local), velocity: self.velocity.of(local) }
    }
}

/// Puts the solution of P_CA in the place of the normal components of one node's motion.
pub(crate) fn settle<const D: usize>(
    displacement: &mut [f64; D],
    velocity: &mut [f64; D],
    frame: &Frame<D>,
    track: &ContactTrack,
    instant: usize,
) {
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
