//! Kinematically admissible fields u_CA, w_CA (§6.1).
//!
//! [`FreeMotion`] carries the nodal values \[39\], \[40\], \[43\] of all nodes along the steps;
//! [`ContactTrack`] replaces the normal component of a node that may touch by the solution of
//! problem P_CA. Both end in an [`ElementMotion`], which only this module can make: the measure
//! cannot be fed a raw finite-element field.

mod contact_track;
mod free_motion;
mod shape;
mod window;

pub(crate) use contact_track::{ContactTrack, NormalStep};
pub(crate) use free_motion::{FreeMotion, Knot, Motion};

use percute_core::ids::NodeId;
use percute_core::obstacle::Plane;

/// u_CA and u̇_CA at the nodes of one element at one knot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementMotion<const D: usize, const N: usize> {
    displacement: [[f64; D]; N],
    velocity: [[f64; D]; N],
}

impl<const D: usize, const N: usize> ElementMotion<D, N> {
    /// The motion of an element of which no node may touch a plane, or before its contact nodes
    /// are known.
    #[inline]
    pub(crate) fn gather(knot: &Knot<D>, nodes: &[NodeId; N]) -> Self {
        Self {
            displacement: nodes.map(|n| knot.displacement[n.index()]),
            velocity: nodes.map(|n| knot.velocity[n.index()]),
        }
    }

    /// Puts the solution of P_CA in the place of the normal components at local node `i`.
    pub(crate) fn set_normal(&mut self, i: usize, plane: &Plane<D>, track: &ContactTrack, knot: usize) {
        settle(&mut self.displacement[i], &mut self.velocity[i], plane, track, knot);
    }

    #[inline]
    pub(crate) fn displacement(&self) -> &[[f64; D]; N] {
        &self.displacement
    }

    #[inline]
    pub(crate) fn velocity(&self) -> &[[f64; D]; N] {
        &self.velocity
    }
}

/// Puts the solution of P_CA in the place of the normal components of one node's motion.
pub(crate) fn settle<const D: usize>(
    displacement: &mut [f64; D],
    velocity: &mut [f64; D],
    plane: &Plane<D>,
    track: &ContactTrack,
    knot: usize,
) {
    if !track.is_altered(knot) {
        // Not rebuilt from the gap, in which a distant plane would drown the displacement.
        return;
    }
    let (speed, gap) = track.at(knot);
    let (_, tangential) = plane.split(displacement);
    let (_, sliding) = plane.split(velocity);
    for c in 0..D {
        displacement[c] = tangential[c] + (gap - track.undeformed_gap()) * plane.normal()[c];
        velocity[c] = sliding[c] + speed * plane.normal()[c];
    }
}
