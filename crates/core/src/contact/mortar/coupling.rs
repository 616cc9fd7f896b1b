//! The matrices D and M of an instant.

use super::dual::{DualShape, Moments};
use super::normal::largest;
use super::partition::{Segment, place, segments};
use super::side::Side;

/// A multiplier with a smaller part of the largest weight does not act.
const LEAST_WEIGHT: f64 = 1e-9;
/// A force smaller than this part of the one that causes it is rounding.
const LEAST_PART: f64 = 1e-9;

/// A row of M has room for so many values at least: most surfaces need no more.
pub(super) const SHORT: usize = 4;

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
    /// Rows of M.
    rows: Vec<Row>,
    master: Vec<f64>,
    weights: Vec<f64>,
    least: f64,
}

/// A row of M: its first node of the master, the one after the last, and the place of the first value. Room that is
/// left has zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    first: usize,
    end: usize,
    start: usize,
}

impl Coupling {
    /// Computes all anew, in the same memory: each part of the slave has moved so far (m) along the tangent against the
    /// master. Nodes nearer than `tolerance` (m) are at one place.
    pub(super) fn update(&mut self, [slave, master]: [&Side; 2], shifts: &[f64], tolerance: f64) {
        self.clear(slave.len());
        self.shifts.extend_from_slice(shifts);
        self.masters = master.len();
        for (index, (part, &shift)) in slave.parts().iter().zip(shifts).enumerate() {
            place((slave, part), master, shift, tolerance, &mut self.places);
            let places = &self.places[index * self.masters..];
            self.inverse.extend(master.edges().iter().map(|&first| 1.0 / (places[first + 1] - places[first])));
            let mut next = 0;
            for edge in part.edges.clone() {
                self.before.push(self.segments.len());
                let places = &self.places[index * self.masters..];
                segments((slave, edge), master, places, &mut next, &mut self.segments);
                self.open_rows(slave.edges()[edge], self.before[edge], master);
                self.add_edge((index, edge), slave, master);
            }
        }
        self.before.push(self.segments.len());
        self.open_row(slave.len() - 1, 0);
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
        self.rows.clear();
        self.master.clear();
        self.weights.clear();
    }

    /// Makes room in the rows of both nodes of an edge, the first of which may have values of the edge before: from the
    /// first to the last node of the master with a segment on it, of those from `start` on.
    fn open_rows(&mut self, first: usize, start: usize, master: &Side) {
        let [Some(low), Some(high)] = [self.segments[start..].first(), self.segments[start..].last()] else { return };
        let [low, high] = [low, high].map(|segment| master.edges()[segment.master]);
        for node in first..first + 2 {
            self.open_row(node, low);
            let row = &mut self.rows[node];
            row.end = high + 2;
            self.master.resize(row.start + (row.end - row.first).max(SHORT), 0.0);
        }
    }

    /// Begins a row at this node of the master, unless it has begun. Rows before it that have not are empty.
    fn open_row(&mut self, node: usize, first: usize) {
        while self.rows.len() <= node {
            let start = self.master.len();
            self.rows.push(Row { first, end: first, start });
            self.master.resize(start + SHORT, 0.0);
        }
    }

    /// Adds one edge of a part of the slave.
    fn add_edge(&mut self, (part, edge): (usize, usize), slave: &Side, master: &Side) {
        let (first, inverse) = (slave.edges()[edge], slave.inverse()[edge]);
        let ends = [slave.xi()[first], slave.xi()[first + 1]];
        let segments = &self.segments[self.before[edge]..];
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
        let (lines, count) = (shape.lines(), master.edges().len());
        let (places, inverses) = (&self.places[part * self.masters..], &self.inverse[part * count..]);
        // The rows of both nodes, the last ones so far.
        let [own, after] = [self.rows[first], self.rows[first + 1]];
        let (before, last) = self.master.split_at_mut(after.start);
        let mut rows = [(own.first, &mut before[own.start..], lines[0]), (after.first, last, lines[1])];
        for segment in segments {
            let low = master.edges()[segment.master];
            let (from, scale) = (places[low], inverses[segment.master]);
            let hat = segment.ends.map(|end| (end - from) * scale);
            let second = segment.ends.map(|end| (end - ends[0]) * inverse);
            let sixth = (segment.ends[1] - segment.ends[0]) * (1.0 / 6.0);
            for (first, row, [start, slope]) in &mut rows {
                let [f, g] = second.map(|second| *start + *slope * second);
                // Both factors are linear: exact.
                let upper = sixth * (f * (2.0 * hat[0] + hat[1]) + g * (hat[0] + 2.0 * hat[1]));
                let values = &mut row[low - *first..][..2];
                values[0] += 3.0 * sixth * (f + g) - upper;
                values[1] += upper;
            }
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
        let Row { first, end, start } = self.rows[node];
        (first, &self.master[start..][..end - first])
    }

    /// The same with the zeros behind it, at least [`SHORT`] values.
    #[inline]
    pub(super) fn room_of_row(&self, node: usize) -> (usize, &[f64]) {
        let Row { first, end, start } = self.rows[node];
        (first, &self.master[start..][..(end - first).max(SHORT)])
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
