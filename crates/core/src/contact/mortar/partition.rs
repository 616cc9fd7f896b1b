//! The partition of the common part of two surfaces.

use super::side::{Part, Side};

/// A part of the interface on one edge of each surface: its ends are nodes of one or the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The edge of the slave, among [`Side::edges`].
    pub slave: usize,
    /// The edge of the master.
    pub master: usize,
    /// ξ of both ends (m), as that of the slave in the undeformed mesh.
    pub ends: [f64; 2],
}

/// An edge of the master at an instant, with ξ as that of a part of the slave in the undeformed mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlacedEdge {
    /// Its first node.
    pub(super) first: usize,
    /// ξ of both ends (m).
    pub(super) ends: [f64; 2],
    /// 1 over the length (1/m).
    pub(super) inverse: f64,
}

impl PlacedEdge {
    /// From the first node and ξ of all nodes (m).
    #[inline]
    pub(super) fn new(first: usize, places: &[f64]) -> Self {
        let ends = [places[first], places[first + 1]];
        Self { first, ends, inverse: 1.0 / (ends[1] - ends[0]) }
    }
}

/// Puts the nodes of the master, at ξ less `shift`, among those of a part of the slave: where two are nearer than
/// `tolerance`, the place is that of the slave.
pub(super) fn place((slave, part): (&Side, &Part), master: &Side, shift: f64, tolerance: f64, places: &mut Vec<f64>) {
    let (xi, mut near) = (&slave.xi()[part.nodes.clone()], 0);
    places.extend(master.xi().iter().map(|place| {
        let place = place - shift;
        while near + 1 < xi.len() && (xi[near + 1] - place).abs() <= (xi[near] - place).abs() {
            near += 1;
        }
        if (xi[near] - place).abs() <= tolerance { xi[near] } else { place }
    }));
}

/// Finds the segments on an edge of the slave with these ends, in ascending order. Edges of the master before `next`
/// end before it; it grows with the edges of a part in ascending order.
#[inline]
pub(super) fn segments(
    (slave, own): (usize, [f64; 2]),
    edges: &[PlacedEdge],
    next: &mut usize,
    found: &mut Vec<Segment>,
) {
    while edges.get(*next).is_some_and(|edge| edge.ends[1] <= own[0]) {
        *next += 1;
    }
    for (master, edge) in (*next..).zip(&edges[*next..]) {
        if edge.ends[0] >= own[1] {
            break;
        }
        let ends = [larger(own[0], edge.ends[0]), smaller(own[1], edge.ends[1])];
        if ends[1] > ends[0] {
            found.push(Segment { slave, master, ends });
        }
    }
}

/// The larger of two numbers, in one instruction: [`f64::max`] looks for NaN.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller one.
#[inline(always)]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
