//! One of two surfaces that slide along each other.

/// The nodes of a surface along the interface, in ascending order of ξ, and its edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    start: usize,
    /// ξ and η of each node of the undeformed mesh (m).
    xi: Vec<f64>,
    eta: Vec<f64>,
    /// The first node of each edge; the second one follows it.
    edges: Vec<usize>,
    /// 1 over the length of each edge (1/m).
    inverse: Vec<f64>,
    /// The share of each node in the mean of the surface.
    share: Vec<f64>,
}

impl Side {
    /// From ξ and η of the nodes (m), in ascending order of ξ, and the first node of each edge, in ascending order.
    /// `start` is the position of the first node in the contact surface.
    pub(crate) fn new(start: usize, xi: Vec<f64>, eta: Vec<f64>, edges: Vec<usize>) -> Self {
        let mut share = vec![0.0; xi.len()];
        for &first in &edges {
            let half = 0.5 * (xi[first + 1] - xi[first]);
            share[first] += half;
            share[first + 1] += half;
        }
        let length: f64 = share.iter().sum();
        share.iter_mut().for_each(|share| *share /= length);
        let inverse = edges.iter().map(|&first| 1.0 / (xi[first + 1] - xi[first])).collect();
        Self { start, xi, eta, edges, inverse, share }
    }

    /// Number of nodes.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.xi.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.xi.is_empty()
    }

    /// The position of a node in the contact surface.
    #[inline]
    #[must_use]
    pub fn position(&self, node: usize) -> usize {
        self.start + node
    }

    /// The node at a position in the contact surface, if it is of this side.
    #[inline]
    #[must_use]
    pub fn node_at(&self, position: usize) -> Option<usize> {
        position.checked_sub(self.start).filter(|&node| node < self.len())
    }

    /// The coordinates ξ of the nodes in the undeformed mesh (m), ascending.
    #[inline]
    #[must_use]
    pub fn xi(&self) -> &[f64] {
        &self.xi
    }

    /// The coordinates η of the nodes in the undeformed mesh (m).
    #[inline]
    #[must_use]
    pub fn eta(&self) -> &[f64] {
        &self.eta
    }

    /// The first node of each edge, ascending. The second one is the next node.
    #[inline]
    #[must_use]
    pub fn edges(&self) -> &[usize] {
        &self.edges
    }

    /// 1 over the length of each edge along ξ (1/m).
    #[inline]
    pub(super) fn inverse(&self) -> &[f64] {
        &self.inverse
    }

    /// The mean of a field over the surface, by length.
    #[inline]
    pub(super) fn mean(&self, field: impl Fn(usize) -> f64) -> f64 {
        self.share.iter().enumerate().map(|(node, share)| share * field(node)).sum()
    }
}
