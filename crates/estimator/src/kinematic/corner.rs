//! The motion of a node that may touch two planes.
//!
//! Problem P_CA is solved for each plane by itself: its conditions involve the normal motion against that plane alone.
//! The motion of the node is the one with both normal components.

use super::contact_motion::ContactMotion;
use percute_core::contact::{ContactNode, Frame};
use percute_core::problem::Problem;

/// Both normal motions of a node at two planes at an instant, of which one differs from that of the simulation.
pub(super) struct Corner<'a, const D: usize> {
    frames: [Frame<D>; 2],
    tracks: [&'a ContactMotion; 2],
    instant: usize,
}

impl<'a, const D: usize> Corner<'a, D> {
    /// That of a node of the contact surface. None if it has one plane, or both leave the motion as it is.
    pub(super) fn of(
        problem: &Problem<D>,
        contact: &ContactNode,
        [own, beside]: [&'a ContactMotion; 2],
        instant: usize,
    ) -> Option<Self> {
        let other = problem.surface().nodes()[contact.second_slot?];
        let frames = [contact.obstacle, other.obstacle].map(|obstacle| problem.obstacles()[obstacle].flat_frame());
        let tracks = [own, beside];
        let made = Self { frames, tracks, instant };
        tracks.iter().any(|track| track.is_altered(instant)).then_some(made)
    }

    /// Gives a displacement (m) both normal components.
    pub(super) fn settle_displacement(&self, displacement: &mut [f64; D]) {
        self.settle(displacement, |track| track.at(self.instant).1 - track.undeformed_gap());
    }

    /// Gives a velocity (m/s) both normal components.
    pub(super) fn settle_velocity(&self, velocity: &mut [f64; D]) {
        self.settle(velocity, |track| track.at(self.instant).0);
    }

    fn settle(&self, vector: &mut [f64; D], normal: impl Fn(&ContactMotion) -> f64) {
        let [first, second] = self.frames.each_ref().map(Frame::normal);
        let cosine: f64 = first.iter().zip(second).map(|(a, b)| a * b).sum();
        let altered = self.tracks.map(|track| track.is_altered(self.instant));
        if D == 2 && altered == [true; 2] {
            // Both components are all of it: at rest on both planes it is 0, not rounding.
            *vector = [0.0; D];
        }
        // Not from the gap where it is that of the simulation: a distant plane would drown the displacement.
        let change = [0, 1].map(|k| match altered[k] {
            true => normal(self.tracks[k]) - self.frames[k].split(vector).0,
            false => 0.0,
        });
        if cosine == 0.0 {
            // Each plane has its own component, as if it were alone.
            for k in (0..2).filter(|&k| self.tracks[k].is_altered(self.instant)) {
                let (_, along) = self.frames[k].split(vector);
                let across = normal(self.tracks[k]);
                *vector = std::array::from_fn(|c| along[c] + across * self.frames[k].normal()[c]);
            }
            return;
        }
        let scale = 1.0 / (1.0 - cosine * cosine);
        let [a, b] = [scale * (change[0] - cosine * change[1]), scale * (change[1] - cosine * change[0])];
        (0..D).for_each(|c| vector[c] += a * first[c] + b * second[c]);
    }
}

/// The velocity (m/s) at a node of the contact surface, with both normal components if it may touch two planes.
pub(crate) fn at_both_planes<const D: usize>(
    problem: &Problem<D>,
    at: usize,
    velocity: &[f64; D],
    tracks: &[ContactMotion],
    instant: usize,
) -> [f64; D] {
    let contact = &problem.surface().nodes()[at];
    let mut settled = *velocity;
    if let Some(second) = contact.second_slot
        && let Some(corner) = Corner::of(problem, contact, [&tracks[at], &tracks[second]], instant)
    {
        corner.settle_velocity(&mut settled);
    }
    settled
}
