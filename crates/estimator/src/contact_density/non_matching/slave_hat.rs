//! Hats on the edges of a slave.

use crate::partition::{Break, Piece};
use percute_core::contact::Side;

/// The traction of a node of a slave on one of its edges: it falls from the node to zero within a part of the edge. The
/// opposite one is on the master, at the same place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlaveHat<const D: usize> {
    /// The node, among those of the slave.
    pub(crate) node: usize,
    /// Its edge, among those of the slave.
    pub(crate) edge: usize,
    /// Whether the node is the first (0) or the second one (1) of the edge.
    pub(crate) end: usize,
    /// The length of the edge along the tangent (m).
    pub(crate) length: f64,
    /// The width is the length of the edge over two to this power.
    pub(crate) halvings: usize,
    /// Its resultant (N).
    pub(crate) resultant: [f64; D],
}

impl<const D: usize> SlaveHat<D> {
    /// A hat on the edge of the slave of which a node is the first (0) or the second one (1), if there is one.
    pub(crate) fn new(slave: &Side, (node, end): (usize, usize), halvings: usize, resultant: [f64; D]) -> Option<Self> {
        let first = node.checked_sub(end)?;
        let edge = slave.edges().binary_search(&first).ok()?;
        let length = slave.xi()[first + 1] - slave.xi()[first];
        Some(Self { node, edge, end, length, halvings, resultant })
    }

    /// Whether it is narrower than its edge.
    pub(super) fn is_narrow(&self) -> bool {
        self.halvings > 0
    }

    fn width(&self) -> f64 {
        0.5_f64.powi(self.halvings as i32)
    }

    /// Where it ends on its edge.
    pub(super) fn ends_at(&self) -> Break {
        let (edge, width) = (self.edge, self.width());
        Break { edge, place: if self.end == 0 { width } else { 1.0 - width } }
    }

    /// Its values at the ends of a piece of its edge (N/m), inside of which it does not end.
    pub(super) fn on(&self, piece: &Piece) -> [[f64; D]; 2] {
        let width = self.width();
        piece.on_slave.map(|second| {
            let away = if self.end == 0 { second } else { 1.0 - second };
            let value = 2.0 / (width * self.length) * (1.0 - away / width).max(0.0);
            self.resultant.map(|f| value * f)
        })
    }
}
