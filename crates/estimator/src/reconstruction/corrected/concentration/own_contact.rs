//! The contact of one node of the auxiliary solution that touches alone.

use super::NodeCosts;
use crate::reconstruction::corrected::motions::Approach;
use percute_core::contact::{Coulomb, Frame};

/// Bisections of the force: to 1e-12 of the largest.
const BISECTIONS: usize = 40;

/// The contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct OwnContact<const D: usize> {
    /// The force (N).
    pub(super) force: [f64; D],
    /// The force over its normal part.
    pub(super) direction: [f64; D],
    /// Displacement along the plane at which the traction sticks (m).
    anchor: [f64; D],
    /// What is left of the depth that the node had at the beginning (m).
    pub(super) depth: f64,
}

/// A node that has a force of its own.
pub(super) struct Own<const D: usize> {
    pub(super) frame: Frame<D>,
    pub(super) law: Option<Coulomb>,
    pub(super) approach: Approach<D>,
    /// The depth at which the node may be at the next instant (m).
    pub(super) depth: f64,
}

impl<const D: usize> Own<D> {
    /// The normal of the plane.
    fn across(&self) -> [f64; 2] {
        let normal = self.frame.normal();
        [normal[0], normal[D - 1]]
    }

    /// The displacement across the plane that a unit normal force adds until the next instant (m/N).
    fn mobility(&self) -> f64 {
        let normal = self.frame.normal();
        self.approach.mobility.between(normal, normal)
    }

    /// The normal force (N) that brings the node to its plane without a local compliance.
    pub(super) fn largest(&self) -> f64 {
        (-(self.approach.gap + self.depth) / self.mobility()).max(0.0)
    }

    /// The normal force (N) under which the node comes to its plane with the local compliance of its traction;
    /// `largest` brings it there without.
    pub(super) fn normal(&self, costs: &NodeCosts<'_>, largest: f64) -> f64 {
        let (across, mobility) = (self.across(), self.mobility());
        let (mut low, mut high) = (0.0, largest);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let local = costs.approach(&costs.shape(middle), across, middle);
            let remaining = self.approach.gap + self.depth + middle * mobility + local;
            if remaining < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// The contact under a normal force (N): the traction sticks where it first touched, or slides at Coulomb's limit.
    pub(super) fn contact(&self, costs: &NodeCosts<'_>, force: f64, last: Option<OwnContact<D>>) -> OwnContact<D> {
        let (normal, [now, next], depth) = (self.frame.normal(), self.approach.along, self.depth);
        if force == 0.0 {
            return OwnContact { force: [0.0; D], direction: *normal, anchor: now, depth };
        }
        let shape = costs.shape(force);
        let (across, along) = (self.across(), [-self.across()[1], self.across()[0]]);
        let anchor = last.map_or(now, |last| last.anchor);
        let tangent = std::array::from_fn(|c| if c == 0 { -normal[D - 1] } else { normal[0] });
        let body = &self.approach.mobility;
        let mobility = body.between(&tangent, &tangent) + costs.local(&shape, along, along);
        let away = (0..D).map(|c| (next[c] - anchor[c]) * tangent[c]).sum::<f64>()
            + force * (body.between(&tangent, normal) + costs.local(&shape, along, across));
        let limit = self.law.map_or(0.0, |law| law.limit(force));
        // Along a support there is no mobility.
        let friction = if limit > 0.0 { (-away / mobility).clamp(-limit, limit) } else { 0.0 };
        let slip = friction * mobility + away;
        OwnContact {
            force: std::array::from_fn(|c| force * normal[c] + friction * tangent[c]),
            direction: std::array::from_fn(|c| normal[c] + friction / force * tangent[c]),
            anchor: std::array::from_fn(|c| anchor[c] + slip * tangent[c]),
            depth,
        }
    }
}
