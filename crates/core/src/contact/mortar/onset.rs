//! Multipliers that set in while surfaces slide.

use super::dual::EndPart;
use super::partition::Segment;
use super::side::Side;

/// How far two conditions of an edge give way, over s(1 − s)² times what its element and that of the master do. With
/// less, contact gives more energy; with more, surfaces enter each other deeper.
const SOFTNESS: f64 = 4.0;

/// Two multipliers of an edge, of which one sets in. Their conditions give way by the difference of both, the less the
/// farther it has set in, so that it takes up its force step by step: the condition of the sum stays exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Onset {
    /// The first node of the edge.
    first: usize,
    /// The node whose multiplier sets in.
    uncovered: usize,
    /// How far they give way (m³/N).
    compliance: f64,
}

impl Onset {
    /// That of an edge of the slave on which such a part of some length (m) is covered by these segments; none once the
    /// multiplier has set in.
    pub(super) fn new(
        (slave, edge): (&Side, usize),
        (part, covered): (&EndPart, f64),
        master: &Side,
        segments: &[Segment],
    ) -> Option<Self> {
        let ((uncovered, onset), first) = (part.uncovered(), slave.edges()[edge]);
        // The edge of the master that ends here.
        let other = if uncovered == 1 { segments.last() } else { segments.first() };
        let soft = slave.compliance(edge) + master.compliance(other?.master);
        let [start, end] = slave.ends(first);
        // It ends with the square: with a linear end, the depth that is left would be pushed out in the last step.
        let rest = 1.0 - onset;
        let compliance = SOFTNESS * onset * rest * rest * 0.5 * covered * (end - start) * soft;
        (onset < 1.0).then_some(Self { first, uncovered: first + uncovered, compliance })
    }

    /// The node whose multiplier sets in.
    #[inline]
    pub(super) fn uncovered(&self) -> usize {
        self.uncovered
    }

    /// The first node of the edge, and how far its conditions give way (m³/N).
    #[inline]
    pub(super) fn softens(&self) -> (usize, f64) {
        (self.first, self.compliance)
    }

    /// How far the condition of a node gives way under these multipliers (N/m), in m².
    pub(super) fn give(&self, node: usize, multiplier: impl Fn(usize) -> f64) -> f64 {
        let rise = self.compliance * (multiplier(self.first + 1) - multiplier(self.first));
        if node == self.first {
            -rise
        } else if node == self.first + 1 {
            rise
        } else {
            0.0
        }
    }
}
