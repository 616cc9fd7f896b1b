//! One side of a non-matching interface.

use std::ops::Range;

/// Where a surface turns by more at a node (rad), it has a corner there, else it is a curve: between the 30° of coarse
/// curves and the 45° of chamfers.
pub const CORNER: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// The nodes of a surface along the interface and its edges: those of one body after those of the other, for each in
/// ascending order of ξ.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    start: usize,
    parts: Vec<Part>,
    /// ξ and η of each node of the undeformed mesh (m).
    xi: Vec<f64>,
    eta: Vec<f64>,
    /// The first node of each edge; the second one follows it.
    edges: Vec<usize>,
    /// Whether a node is a corner, where the surface ends or turns away from the other one.
    corners: Vec<bool>,
    /// 1 over the length of each edge (1/m).
    inverse: Vec<f64>,
    /// The share of each node in the motion of its part along ξ.
    share: Vec<f64>,
    /// 1 over the stiffness ρc² of the element at each edge and its thickness (1/(Pa·m)).
    compliance: Vec<f64>,
}

/// The part of a surface that belongs to one body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its nodes.
    pub nodes: Range<usize>,
    /// Its edges, among [`Side::edges`].
    pub edges: Range<usize>,
}

impl Side {
    /// From ξ and η of the nodes (m), the first node of each edge, in ascending order, and the first node of each body:
    /// its nodes are in ascending order of ξ. `start` is the position of the first node in the contact surface.
    pub(crate) fn new(start: usize, [xi, eta]: [Vec<f64>; 2], edges: Vec<usize>, bodies: &[usize]) -> Self {
        let edges_before = |node: usize| edges.partition_point(|&first| first < node);
        let part = |(k, &first): (usize, &usize)| {
            let end = bodies.get(k + 1).copied().unwrap_or(xi.len());
            Part { nodes: first..end, edges: edges_before(first)..edges_before(end) }
        };
        let parts: Vec<Part> = bodies.iter().enumerate().map(part).collect();
        let mut share = vec![0.0; xi.len()];
        for &first in &edges {
            let half = 0.5 * (xi[first + 1] - xi[first]);
            share[first] += half;
            share[first + 1] += half;
        }
        for part in &parts {
            let length: f64 = share[part.nodes.clone()].iter().sum();
            share[part.nodes.clone()].iter_mut().for_each(|share| *share /= length);
        }
        let inverse = edges.iter().map(|&first| 1.0 / (xi[first + 1] - xi[first])).collect();
        let corners = corners([&xi, &eta], &edges);
        let compliance = vec![0.0; edges.len()];
        Self { start, parts, xi, eta, corners, edges, inverse, share, compliance }
    }

    /// The same with 1 over the stiffness ρc² of the element at each edge and its thickness (1/(Pa·m)); elsewhere 0.
    pub(crate) fn with_compliance(self, compliance: Vec<f64>) -> Self {
        Self { compliance, ..self }
    }

    /// The same where supports hold nodes, from the initial velocities along the tangent (m/s). `steady` nodes keep
    /// theirs. If they go with the mean of their part, to `tolerance`, the part moves by them: half of a symmetric
    /// model then moves as the whole one. Where they do not, a wave has yet to bring their motion to the other nodes.
    pub(crate) fn held(mut self, velocity: &[f64], steady: &[bool], tolerance: f64) -> Self {
        for part in &self.parts {
            let mean = self.motion_of(part, |node| velocity[node]);
            let leads = |node: &usize| steady[*node] && (velocity[*node] - mean).abs() <= tolerance;
            let leading: Vec<usize> = part.nodes.clone().filter(leads).collect();
            if !leading.is_empty() {
                self.share[part.nodes.clone()].fill(0.0);
                leading.iter().for_each(|&node| self.share[node] = 1.0 / leading.len() as f64);
            }
        }
        self
    }

    /// The parts of all bodies that it belongs to.
    #[inline]
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The part of an edge.
    #[inline]
    #[must_use]
    pub fn part_of_edge(&self, edge: usize) -> usize {
        self.parts.partition_point(|part| part.edges.end <= edge)
    }

    /// Whether each node of an edge is a corner.
    #[inline]
    pub(super) fn corners(&self, edge: usize) -> [bool; 2] {
        let first = self.edges[edge];
        [self.corners[first], self.corners[first + 1]]
    }

    /// Whether a node of a slave is a corner.
    #[inline]
    pub(in crate::contact) fn is_corner(&self, node: usize) -> bool {
        self.corners[node]
    }

    /// The part of a node.
    #[inline]
    #[must_use]
    pub fn part_of(&self, node: usize) -> usize {
        self.parts.partition_point(|part| part.nodes.end <= node)
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

    /// The positions of all nodes in the contact surface.
    #[inline]
    pub(super) fn positions(&self) -> Range<usize> {
        self.start..self.start + self.len()
    }

    /// The node at a position in the contact surface, if it is of this side.
    #[inline]
    #[must_use]
    pub fn node_at(&self, position: usize) -> Option<usize> {
        position.checked_sub(self.start).filter(|&node| node < self.len())
    }

    /// The coordinates ξ of the nodes in the undeformed mesh (m), ascending in each part.
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

    /// ξ of both ends of the edge with this first node (m).
    #[inline]
    #[must_use]
    pub fn ends(&self, first: usize) -> [f64; 2] {
        [self.xi[first], self.xi[first + 1]]
    }

    /// 1 over the length of each edge along ξ (1/m).
    #[inline]
    pub(super) fn inverse(&self) -> &[f64] {
        &self.inverse
    }

    /// 1 over the stiffness ρc² of the element at an edge and its thickness (1/(Pa·m)).
    #[inline]
    pub(super) fn compliance(&self, edge: usize) -> f64 {
        self.compliance[edge]
    }

    /// The motion of a part along ξ, from that of its nodes: the mean by length, or that of nodes that supports hold.
    #[inline]
    pub(super) fn motion_of(&self, part: &Part, field: impl Fn(usize) -> f64) -> f64 {
        part.nodes.clone().map(|node| self.share[node] * field(node)).sum()
    }
}

/// Where a slave ends, or turns away from its master. Of a master, only its ends are right, and nothing asks for them.
fn corners([xi, eta]: [&[f64]; 2], edges: &[usize]) -> Vec<bool> {
    let has = |first: Option<usize>| first.filter(|first| edges.binary_search(first).is_ok());
    let slope = |first: usize| (eta[first + 1] - eta[first]).atan2(xi[first + 1] - xi[first]);
    let corner = |node: usize| match [has(node.checked_sub(1)), has(Some(node))] {
        [Some(before), Some(after)] => slope(after) - slope(before) > CORNER,
        _ => true,
    };
    (0..xi.len()).map(corner).collect()
}
