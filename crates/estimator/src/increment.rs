//! ∫₀ᵗ dt of ã and of the lumping difference, of which u̇_DA is made \[13\].

use crate::lanes::{FieldLanes, Lanes};
use percute_core::ids::NodeId;

/// The integral of such a nodal field (m/s).
#[derive(Clone, Debug)]
pub(crate) struct Increment<const D: usize>(Vec<[f64; D]>);

impl<const D: usize> Increment<D> {
    /// At t = 0.
    pub(crate) fn zero(nodes: usize) -> Self {
        Self(vec![[0.0; D]; nodes])
    }

    /// In the middle and at the end of a step of this length (s), over which the field goes linearly from `start` to `end` (m/s²).
    pub(crate) fn advance(&self, length: f64, start: &[[f64; D]], end: &[[f64; D]]) -> [Self; 2] {
        [[0.375, 0.125], [0.5, 0.5]].map(|[a, b]| {
            let each = self.0.iter().zip(start.iter().zip(end));
            Self(each.map(|(w, (x, y))| std::array::from_fn(|c| w[c] + length * (a * x[c] + b * y[c]))).collect())
        })
    }

    /// Its values at the nodes of an element.
    #[inline]
    pub(crate) fn gather<const N: usize>(&self, nodes: &[NodeId; N]) -> [[f64; D]; N] {
        nodes.map(|n| self.0[n.index()])
    }
}

/// Such integrals at some nodes, at some instants side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct IncrementLanes<const D: usize>(FieldLanes<D>);

impl<const D: usize> IncrementLanes<D> {
    /// Takes the values at these nodes, at each instant.
    #[inline(always)]
    pub(crate) fn gather<'i>(
        &mut self,
        nodes: &[u32],
        increments: impl Iterator<Item = Option<&'i Increment<D>>> + Clone,
    ) {
        self.0.gather(nodes, increments.map(|increment| increment.map(|increment| &increment.0[..])));
    }

    /// The values at the nodes of an element, which have these places.
    #[inline(always)]
    pub(crate) fn of<const N: usize>(&self, local: &[u32; N]) -> [[Lanes; D]; N] {
        self.0.of(local)
    }
}
