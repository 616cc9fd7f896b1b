//! ∫₀ᵗ ã dt, of which u̇_DA is made \[13\].

use percute_core::ids::NodeId;

/// The integral at all nodes (m/s).
#[derive(Clone, Debug)]
pub(crate) struct Increment<const D: usize>(Vec<[f64; D]>);

/// The integral at the nodes of one element (m/s).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ElementIncrement<const D: usize, const N: usize>([[f64; D]; N]);

impl<const D: usize> Increment<D> {
    /// At t = 0.
    pub(crate) fn zero(nodes: usize) -> Self {
        Self(vec![[0.0; D]; nodes])
    }

    /// In the middle and at the end of a step of this length (s), over which ã goes linearly from `start` to `end` (m/s²).
    pub(crate) fn advance(&self, length: f64, start: &[[f64; D]], end: &[[f64; D]]) -> [Self; 2] {
        [[0.375, 0.125], [0.5, 0.5]].map(|[a, b]| {
            let each = self.0.iter().zip(start.iter().zip(end));
            Self(each.map(|(w, (x, y))| std::array::from_fn(|c| w[c] + length * (a * x[c] + b * y[c]))).collect())
        })
    }

    /// Its values at the nodes of an element.
    #[inline]
    pub(crate) fn gather<const N: usize>(&self, nodes: &[NodeId; N]) -> ElementIncrement<D, N> {
        ElementIncrement(nodes.map(|n| self.0[n.index()]))
    }
}

impl<const D: usize, const N: usize> ElementIncrement<D, N> {
    #[inline]
    pub(crate) fn values(&self) -> &[[f64; D]; N] {
        &self.0
    }
}
