//! The matrices D and M of an instant.

use super::dual::{DualShape, Moments};
use super::normal::largest;
use super::partition::{Segment, place, segments};
use super::rows::Rows;
use super::side::{Part, Side};

/// A multiplier with a smaller part of the largest weight does not act.
const LEAST_WEIGHT: f64 = 1e-9;
/// A force smaller than this part of the one that causes it is rounding, or that of a surface that ends there.
pub(in crate::contact) const LEAST_PART: f64 = 1e-9;

/// D = ∫ψφ, M = ∫ψN and the weights w = ∫ψ of the multipliers (m), on the partition at an instant. The multipliers are
/// those of the nodes of the slave; N are the hats of the master.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coupling {
    segments: Vec<Segment>,
    /// Segments of the edges before each edge of the slave, and of all.
    before: Vec<usize>,
    shapes: Vec<DualShape>,
    /// How far each part of the slave has moved along the tangent against the master (m).
    shifts: Vec<f64>,
    /// For each part of the slave, ξ of the nodes of the master (m), as that of this part in the undeformed mesh.
    places: Vec<f64>,
    /// For each part of the slave, 1 over the length of each edge of the master (1/m).
    inverse: Vec<f64>,
    /// Number of nodes of the master.
    masters: usize,
    /// Rows of D: the values at the node before, at the node and at the node after it.
    slave: Vec<[f64; 3]>,
    /// M.
    rows: Rows,
    weights: Vec<f64>,
    least: f64,
}

impl Coupling {
    /// Computes all anew, in the same memory: each part of the slave has moved so far (m) along the tangent against the
    /// master. Nodes nearer than `tolerance` (m) are at one place.
    pub(super) fn update(&mut self, [slave, master]: [&Side; 2], shifts: &[f64], tolerance: f64) {
        self.clear(slave.len());
        self.shifts.extend_from_slice(shifts);
        self.masters = master.len();
        for (part, &shift) in slave.parts().iter().zip(shifts) {
            self.cut((slave, part), master, shift, tolerance);
        }
        self.before.push(self.segments.len());
        self.rows.open();
        for (index, part) in slave.parts().iter().enumerate() {
            part.edges.clone().for_each(|edge| self.add_edge((index, edge), slave, master));
        }
        self.weights.extend(self.slave.iter().map(|row| row[0] + row[1] + row[2]));
        self.least = LEAST_WEIGHT * largest(self.weights.iter().copied());
    }

    fn clear(&mut self, multipliers: usize) {
        self.segments.clear();
        self.before.clear();
        self.shapes.clear();
        self.shifts.clear();
        self.places.clear();
        self.inverse.clear();
        self.slave.clear();
        self.slave.resize(multipliers, [0.0; 3]);
        self.rows.reset(multipliers);
        self.weights.clear();
    }

    /// Finds the segments of a part of the slave. The multipliers of both nodes of an edge act on all nodes of the
    /// master with a segment on it.
    fn cut(&mut self, (slave, part): (&Side, &Part), master: &Side, shift: f64, tolerance: f64) {
        let start = self.places.len();
        place((slave, part), master, shift, tolerance, &mut self.places);
        let (places, edges) = (&self.places[start..], master.edges());
        self.inverse.extend(edges.iter().map(|&first| 1.0 / (places[first + 1] - places[first])));
        let mut next = 0;
        for edge in part.edges.clone() {
            let before = self.segments.len();
            self.before.push(before);
            segments((slave, edge), master, places, &mut next, &mut self.segments);
            if let [low, ..] = self.segments[before..] {
                let high = self.segments[self.segments.len() - 1];
                let columns = edges[low.master]..edges[high.master] + 2;
                let first = slave.edges()[edge];
                (first..first + 2).for_each(|node| self.rows.widen(node, &columns));
            }
        }
    }

    /// Adds one edge of a part of the slave.
    fn add_edge(&mut self, (part, edge): (usize, usize), slave: &Side, master: &Side) {
        let (first, inverse) = (slave.edges()[edge], slave.inverse()[edge]);
        let ends = [slave.xi()[first], slave.xi()[first + 1]];
        let segments = &self.segments[self.before[edge]..self.before[edge + 1]];
        let moments = Moments::of(ends, inverse, segments);
        let shape = moments.shape(ends[1] - ends[0], slave.corners(edge));
        self.shapes.push(shape);
        let [one, two] = moments.hats;
        match shape {
            DualShape::None => return,
            DualShape::Both(_) => {
                self.slave[first][1] += one;
                self.slave[first + 1][1] += two;
            }
            DualShape::Part(hats) => {
                // Each multiplier stands for one end of the part: ∫ψ_k f = f there times half of the length.
                let half = 0.5 * moments.covered;
                self.slave[first][1] += half * (1.0 - hats[0]);
                self.slave[first][2] += half * hats[0];
                self.slave[first + 1][0] += half * (1.0 - hats[1]);
                self.slave[first + 1][1] += half * hats[1];
            }
            DualShape::One(0) => {
                self.slave[first][1] += one;
                self.slave[first][2] += two;
            }
            DualShape::One(_) => {
                self.slave[first + 1][0] += one;
                self.slave[first + 1][1] += two;
            }
        }
        let places = &self.places[part * self.masters..][..self.masters];
        let inverses = &self.inverse[part * master.edges().len()..][..master.edges().len()];
        let ([lines, after_lines], [(own, row), (after, after_row)]) = (shape.lines(), self.rows.pair_mut(first));
        for &Segment { master: other, ends: [from, to], .. } in segments {
            let low = master.edges()[other];
            let (place, scale) = (places[low], inverses[other]);
            let hat = [(from - place) * scale, (to - place) * scale];
            let second = [(from - ends[0]) * inverse, (to - ends[0]) * inverse];
            // Both factors are linear: Simpson's rule is exact.
            let sixth = (to - from) * (1.0 / 6.0);
            let upper = [sixth * (2.0 * hat[0] + hat[1]), sixth * (hat[0] + 2.0 * hat[1])];
            let lower = upper.map(|upper| 3.0 * sixth - upper);
            let add = |values: &mut [f64], [start, slope]: [f64; 2]| {
                let [f, g] = second.map(|second| start + slope * second);
                values[0] += lower[0] * f + lower[1] * g;
                values[1] += upper[0] * f + upper[1] * g;
            };
            add(&mut row[low - own..][..2], lines);
            add(&mut after_row[low - after..][..2], after_lines);
        }
    }

    /// Number of multipliers, one for each node of the slave.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    /// The weight w_k of a multiplier (m), ∫ψ_k = ∫χ_k.
    #[inline]
    #[must_use]
    pub fn weight(&self, node: usize) -> f64 {
        self.weights[node]
    }

    /// Whether the multiplier of a node acts: the master covers enough of its edges.
    #[inline]
    #[must_use]
    pub fn is_active(&self, node: usize) -> bool {
        self.weights[node] > self.least
    }

    /// The segments, in ascending order of ξ on each part of the slave.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The segments on an edge of the slave.
    #[must_use]
    pub fn segments_of(&self, edge: usize) -> &[Segment] {
        &self.segments[self.before[edge]..self.before[edge + 1]]
    }

    /// The shape functions of the multipliers on an edge of the slave.
    #[must_use]
    pub fn shape(&self, edge: usize) -> DualShape {
        self.shapes[edge]
    }

    /// ξ of the nodes of the master (m), as that of a part of the slave in the undeformed mesh.
    #[must_use]
    pub fn places(&self, part: usize) -> &[f64] {
        &self.places[part * self.masters..][..self.masters]
    }

    /// How far each part of the slave has moved along the tangent against the master (m).
    #[must_use]
    pub fn shifts(&self) -> &[f64] {
        &self.shifts
    }

    /// The row of D of a multiplier (m): its values at the node before, at the node itself and at the one after it.
    /// Where the master ends on an edge, one of its neighbours may have a value that is not 0.
    #[inline]
    #[must_use]
    pub fn slave_row(&self, node: usize) -> [f64; 3] {
        self.slave[node]
    }

    /// The row of M of a multiplier (m): the node of the master that its first value belongs to, and the values.
    #[inline]
    #[must_use]
    pub fn master_row(&self, node: usize) -> (usize, &[f64]) {
        self.rows.row(node)
    }

    /// M.
    #[inline]
    pub(super) fn master(&self) -> &Rows {
        &self.rows
    }

    /// The nodes of the master on which a multiplier acts, but for rounding.
    pub(super) fn acts_on(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let ((first, row), least) = (self.master_row(node), LEAST_PART * self.weights[node]);
        row.iter().enumerate().filter(move |(_, value)| value.abs() > least).map(move |(at, _)| first + at)
    }

    /// (D f − M f')_k of a field on the slave and one on the master.
    #[inline]
    #[must_use]
    pub fn difference(&self, node: usize, slave: impl Fn(usize) -> f64, master: impl Fn(usize) -> f64) -> f64 {
        let [before, own, after] = self.slave[node];
        let mut sum = own * slave(node);
        if before != 0.0 {
            sum += before * slave(node - 1);
        }
        if after != 0.0 {
            sum += after * slave(node + 1);
        }
        let (first, row) = self.master_row(node);
        (first..).zip(row).fold(sum, |sum, (at, value)| sum - value * master(at))
    }

    /// The same of several fields, from their values on all nodes.
    #[inline]
    pub(super) fn differences<const W: usize>(&self, node: usize, slave: &[[f64; W]], master: &[[f64; W]]) -> [f64; W] {
        let (own, (first, row)) = (self.slave[node], self.master_row(node));
        let mut sums = slave[node].map(|value| own[1] * value);
        let mut add = |factor: f64, values: &[f64; W]| (0..W).for_each(|w| sums[w] += factor * values[w]);
        if own[0] != 0.0 {
            add(own[0], &slave[node - 1]);
        }
        if own[2] != 0.0 {
            add(own[2], &slave[node + 1]);
        }
        row.iter().zip(&master[first..]).for_each(|(factor, values)| add(-factor, values));
        sums
    }

    /// The multipliers λ (N/m) of forces Dᵀλ on the nodes of the slave (N), one component of each. Those that do not
    /// act are 0.
    #[must_use]
    pub fn multipliers(&self, force: &[f64]) -> Vec<f64> {
        let mut rest = force.to_vec();
        let active = |node: usize| self.is_active(node);
        // An edge joins two multipliers one way only: no multiplier waits for itself.
        for node in 1..rest.len() {
            let after = self.slave[node - 1][2];
            if after != 0.0 && active(node - 1) {
                rest[node] -= after * rest[node - 1] / self.slave[node - 1][1];
            }
        }
        for node in (0..rest.len()).rev() {
            if node + 1 < rest.len() && self.slave[node + 1][0] != 0.0 && active(node + 1) {
                rest[node] -= self.slave[node + 1][0] * rest[node + 1];
            }
            rest[node] = if active(node) { rest[node] / self.slave[node][1] } else { 0.0 };
        }
        rest
    }
}
