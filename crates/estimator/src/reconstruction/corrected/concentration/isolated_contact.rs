//! The contact of one node of the auxiliary solution that touches alone.

use super::NodeCosts;
use super::bracket::bisected;
use crate::concentrated::TractionShape;
use crate::reconstruction::corrected::auxiliary::Approach;
use percute_core::contact::{Coulomb, Frame};

/// The contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct IsolatedContact<const D: usize> {
    /// The force (N).
    pub(super) force: [f64; D],
    /// The force over its normal part.
    pub(super) direction: [f64; D],
    /// Displacement along the plane at which the traction sticks (m).
    anchor: [f64; D],
    /// What is left of the depth that the node had at the beginning (m).
    pub(super) depth: f64,
    /// The shape of its traction.
    pub(super) shape: TractionShape,
    /// The normal force that decides on the shape at the next instant (N).
    width: f64,
}

/// A node that has a force of its own.
pub(super) struct Own<const D: usize> {
    pub(super) frame: Frame<D>,
    /// The normal and the tangent of the plane, turned back with the star.
    pub(super) axes: [[f64; 2]; 2],
    /// Whether the body may turn.
    pub(super) turns: bool,
    pub(super) law: Option<Coulomb>,
    pub(super) approach: Approach<D>,
    /// The depth at which the node may be at the next instant (m).
    pub(super) depth: f64,
}

impl<const D: usize> Own<D> {
    /// The normal force (N) that brings the node to its plane without a local compliance.
    pub(super) fn largest(&self) -> f64 {
        let normal = self.frame.normal();
        (-(self.approach.gap + self.depth) / self.approach.mobility.between(normal, normal)).max(0.0)
    }

    /// The gap that is left under a normal force with this shape (N), that of its traction and of its local compliance
    /// (m).
    fn remaining(&self, costs: &NodeCosts<'_>, shape: &TractionShape, force: f64) -> f64 {
        let normal = self.frame.normal();
        let mean = self.approach.of_traction(far_parts(shape));
        let body = mean.gap + force * mean.mobility.between(normal, normal);
        // Where the motion of far nodes is not foreseen, edges have the gaps of the simulation.
        let local = match self.approach.far[0] {
            Some(_) => costs.beyond_edges(shape, self.axes[0], force),
            None => costs.approach(shape, self.axes[0], force),
        };
        body + self.depth + local
    }

    /// The normal force (N) under which the traction comes to its plane with its local compliance, and its shape.
    ///
    /// The best shape of a first touch is that of its force, at most `largest`, which brings the node there without a
    /// compliance. Later shapes follow a force that rises at once, and one that falls with the time τ of the impulse
    /// smoothing: where a shape would answer a force that swings, both would swing where the width jumps.
    pub(super) fn normal(
        &self,
        costs: &NodeCosts<'_>,
        largest: f64,
        last: Option<IsolatedContact<D>>,
    ) -> (f64, TractionShape) {
        if let Some(last) = last.filter(|last| last.width > 0.0) {
            let shape = costs.shape_again(last.width);
            let [free, under] = [0.0, last.width].map(|force| self.remaining(costs, &shape, force));
            return ((-free * last.width / (under - free)).max(0.0), shape);
        }
        let force = bisected(largest, |force| self.remaining(costs, &costs.shape(force), force));
        (force, costs.shape(force))
    }

    /// The contact under a normal force (N) with a shape, after a part of the time τ: the traction sticks where it
    /// first touched, or slides at Coulomb's limit.
    pub(super) fn contact(
        &self,
        costs: &NodeCosts<'_>,
        (force, shape): (f64, TractionShape),
        part: f64,
        last: Option<IsolatedContact<D>>,
    ) -> IsolatedContact<D> {
        let (normal, depth) = (self.frame.normal(), self.depth);
        let width = last.map_or(force, |last| force.max(last.width + part.min(1.0) * (force - last.width)));
        if force == 0.0 {
            let anchor = self.approach.along[0];
            return IsolatedContact { force: [0.0; D], direction: *normal, anchor, depth, shape, width };
        }
        let approach = self.approach.of_traction(far_parts(&shape));
        let [now, next] = approach.along;
        let [across, along] = self.axes;
        let anchor = last.map_or(now, |last| self.anchor(&last, &now));
        let tangent = tangent_of(normal);
        let body = &approach.mobility;
        let mobility = body.between(&tangent, &tangent) + costs.local(&shape, along, along);
        let away = (0..D).map(|c| (next[c] - anchor[c]) * tangent[c]).sum::<f64>()
            + force * (body.between(&tangent, normal) + costs.local(&shape, along, across));
        let limit = self.law.map_or(0.0, |law| law.limit(force));
        // Along a support there is no mobility.
        let friction = if limit > 0.0 { (-away / mobility).clamp(-limit, limit) } else { 0.0 };
        let slip = friction * mobility + away;
        IsolatedContact {
            force: std::array::from_fn(|c| force * normal[c] + friction * tangent[c]),
            direction: std::array::from_fn(|c| normal[c] + friction / force * tangent[c]),
            anchor: std::array::from_fn(|c| anchor[c] + slip * tangent[c]),
            depth,
            shape,
            width,
        }
    }

    /// Where the traction with the mean displacement `now` sticks. The displacements of a body that turns differ by its
    /// rotation along an edge: where the shape has changed, the mean is one of other points, and the anchor goes with
    /// it.
    fn anchor(&self, last: &IsolatedContact<D>, now: &[f64; D]) -> [f64; D] {
        if !self.turns {
            return last.anchor;
        }
        let [before, _] = self.approach.of_traction(far_parts(&last.shape)).along;
        std::array::from_fn(|c| last.anchor[c] + (now[c] - before[c]))
    }
}

/// The tangent of a plane with this normal.
pub(super) fn tangent_of<const D: usize>(normal: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|c| if c == 0 { -normal[D - 1] } else { normal[0] })
}

/// The parts of the force of a traction on the far nodes of its edges.
fn far_parts(shape: &TractionShape) -> [f64; 2] {
    std::array::from_fn(|edge| shape.get(edge).map_or(0.0, |hat| hat.share * hat.far()))
}
