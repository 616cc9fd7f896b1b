//! ∫₀ᵗ dt of ã, or of a_c and o₂, of which u̇_DA is made \[13\].

use crate::nodal_field::{FieldPool, NodalField};
use crate::parallel::by_pieces;
use percute_core::ids::NodeId;
use percute_core::simd::lanes::Value;

/// The integral in the middle of a step of this length (s), from that at its end and the field at its start and its end
/// (m/s²).
#[inline(always)]
pub(crate) fn half_way<T: Value, const D: usize>(length: T, last: &[T; D], [start, end]: [&[T; D]; 2]) -> [T; D] {
    let mut middle = *last;
    for c in 0..D {
        middle[c] -= length * (start[c] * 0.125 + end[c] * 0.375);
    }
    middle
}

/// The integral of such a nodal field (m/s).
#[derive(Clone, Debug)]
pub(crate) struct Increment<const D: usize>(NodalField<D>);

impl<const D: usize> Increment<D> {
    /// At t = 0.
    pub(crate) fn zero(pool: &FieldPool<D>) -> Self {
        Self(pool.zeros())
    }

    /// At the end of a step of this length (s), over which the field goes linearly from `start` to `end` (m/s²).
    pub(crate) fn advance(&self, length: f64, start: &[[f64; D]], end: &[[f64; D]]) -> Self {
        let mut last = self.0.another();
        by_pieces((&mut last[..], (&self.0[..], start, end)), &|_, (last, (first, start, end))| {
            for (last, (w, (x, y))) in last.iter_mut().zip(first.iter().zip(start.iter().zip(end))) {
                *last = std::array::from_fn(|c| w[c] + length * (0.5 * x[c] + 0.5 * y[c]));
            }
        });
        Self(last)
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
