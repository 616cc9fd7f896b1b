//! ∫₀ᵗ dt of ã and of the lumping difference, of which u̇_DA is made \[13\].

use crate::nodal_field::{FieldPool, NodalField};
use percute_core::ids::NodeId;

/// The integral of such a nodal field (m/s).
#[derive(Clone, Debug)]
pub(crate) struct Increment<const D: usize>(NodalField<D>);

impl<const D: usize> Increment<D> {
    /// At t = 0.
    pub(crate) fn zero(pool: &FieldPool<D>) -> Self {
        Self(pool.zeros())
    }

    /// In the middle and at the end of a step of this length (s), over which the field goes linearly from `start` to `end` (m/s²).
    pub(crate) fn advance(&self, length: f64, start: &[[f64; D]], end: &[[f64; D]]) -> [Self; 2] {
        let [mut middle, mut last] = [self.0.another(), self.0.another()];
        let fields = self.0.iter().zip(start.iter().zip(end));
        for ((middle, last), (w, (x, y))) in middle.iter_mut().zip(last.iter_mut()).zip(fields) {
            for c in 0..D {
                middle[c] = w[c] + length * (0.375 * x[c] + 0.125 * y[c]);
                last[c] = w[c] + length * (0.5 * x[c] + 0.5 * y[c]);
            }
        }
        [Self(middle), Self(last)]
    }

    /// Its values at all nodes.
    pub(crate) fn values(&self) -> &[[f64; D]] {
        &self.0
    }

    /// Its values at the nodes of an element.
    #[inline]
    pub(crate) fn gather<const N: usize>(&self, nodes: &[NodeId; N]) -> [[f64; D]; N] {
        nodes.map(|n| self.0[n.index()])
    }
}
