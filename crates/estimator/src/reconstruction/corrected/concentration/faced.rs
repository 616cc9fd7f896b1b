//! What the edges of a node face, and the cost of its tractions there.

use crate::concentrated::{HATS, ShapeCosts, TractionShape};
use std::cell::Cell;

/// A hat with less than this share does not make a node wide.
const SHARE: f64 = 1e-6;

/// The part of an edge of a node that faces the obstacle, from the node on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Reach {
    /// The part of its length.
    pub(in crate::reconstruction::corrected) faces: f64,
    /// Where the gap of the other node is taken, as a part of its length.
    pub(in crate::reconstruction::corrected) known: f64,
}

impl Reach {
    /// All of an edge.
    pub(in crate::reconstruction::corrected) const WHOLE: Self = Self { faces: 1.0, known: 1.0 };

    /// How often the edge is halved until a hat is within this part.
    pub(super) fn halvings(&self) -> usize {
        (0..=HATS).find(|&k| 0.5_f64.powi(k as i32) <= self.faces).unwrap_or(HATS + 1)
    }
}

/// What the edges of a node face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Faced {
    /// The compliance of both over that of the node.
    pub(super) compliance: f64,
    /// The parts of the edges, in their order.
    pub(super) reach: [Reach; 2],
}

impl Faced {
    /// A plane, or a node whose star is known.
    pub(in crate::reconstruction::corrected) const WHOLE: Self = Self { compliance: 1.0, reach: [Reach::WHOLE; 2] };
}

/// The cost of the tractions of one node.
#[derive(Clone, Debug)]
pub(super) struct NodeCosts<'a> {
    pub(super) shapes: ShapeCosts<'a>,
    /// The compliance of both over that of the node.
    pub(super) compliance: f64,
    /// The halvings of the widest hat on each edge.
    pub(super) widest: [usize; 2],
    /// Normal forces with their shapes, of the last two that [`shape_again`](Self::shape_again) was asked for.
    pub(super) found: Cell<[Option<(f64, TractionShape)>; 2]>,
}

impl NodeCosts<'_> {
    /// The best shape under a normal force (N).
    pub(super) fn shape(&self, normal: f64) -> TractionShape {
        self.shapes.shape(self.compliance * normal, self.widest)
    }

    /// The same of a force that comes again.
    pub(super) fn shape_again(&self, normal: f64) -> TractionShape {
        let [last, before] = self.found.get();
        match [last, before].into_iter().flatten().find(|(force, _)| *force == normal) {
            Some((_, shape)) => shape,
            None => {
                let shape = self.shape(normal);
                self.found.set([Some((normal, shape)), last]);
                shape
            }
        }
    }

    /// Whether the mesh lacks the local compliance: no hat is as wide as it may be.
    pub(super) fn is_alone(&self, shape: &TractionShape) -> bool {
        !self.wide(shape).any(|wide| wide)
    }

    /// On each edge, whether its hat is as wide as it may be.
    pub(super) fn wide(&self, shape: &TractionShape) -> impl Iterator<Item = bool> {
        shape.iter().zip(self.widest).map(|(hat, widest)| hat.share > SHARE && hat.halvings <= widest)
    }

    /// As [`ShapeCosts::approach`].
    pub(super) fn approach(&self, shape: &TractionShape, plane: [f64; 2], normal: f64) -> f64 {
        self.shapes.approach(shape, plane, self.compliance * normal)
    }

    /// As [`ShapeCosts::beyond_edges`].
    pub(super) fn beyond_edges(&self, shape: &TractionShape, plane: [f64; 2], normal: f64) -> f64 {
        self.shapes.beyond_edges(shape, plane, self.compliance * normal)
    }

    /// As [`ShapeCosts::local`].
    pub(super) fn local(&self, shape: &TractionShape, along: [f64; 2], force: [f64; 2]) -> f64 {
        self.compliance * self.shapes.local(shape, along, force)
    }
}
