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

/// Finds the segments on an edge of the slave, in ascending order, with the nodes of the master at these places. Edges
/// of the master before `next` end before it; it grows with the edges of a part in ascending order.
pub(super) fn segments(
    (slave, edge): (&Side, usize),
    master: &Side,
    places: &[f64],
    next: &mut usize,
    found: &mut Vec<Segment>,
) {
    let first = slave.edges()[edge];
    let own = [slave.xi()[first], slave.xi()[first + 1]];
    while *next < master.edges().len() && places[master.edges()[*next] + 1] <= own[0] {
        *next += 1;
    }
    for (other, &first) in master.edges().iter().enumerate().skip(*next) {
        if places[first] >= own[1] {
            break;
        }
        let ends = [own[0].max(places[first]), own[1].min(places[first + 1])];
        if ends[1] > ends[0] {
            found.push(Segment { slave: edge, master: other, ends });
        }
    }
}
