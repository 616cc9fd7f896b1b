//! The matrices D and M of an instant.

use super::band::Band;
use super::dual::{DualShape, Moments, covers};
use super::normal::largest;
use super::onset::Onset;
use super::partition::{PlacedEdge, Segment, place, segments};
use super::rows::Rows;
use super::side::{Part, Side};

/// A multiplier with a smaller part of the largest weight does not act.
const LEAST_WEIGHT: f64 = 1e-9;
/// A force smaller than this part of the one that causes it is rounding, or that of a surface that ends there.
pub(crate) const LEAST_PART: f64 = 1e-9;

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
    /// The edges of the master at the places for the last part.
    edges: Vec<PlacedEdge>,
    /// Number of nodes of the master.
    masters: usize,
    /// Rows of D: the values at the node before, at the node and at the node after it.
    slave: Vec<[f64; 3]>,
    /// M.
    rows: Rows,
    weights: Vec<f64>,
    least: f64,
    onsets: Vec<Onset>,
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
            part.edges.clone().for_each(|edge| self.add_edge([slave, master], edge));
        }
        self.weights.extend(self.slave.iter().map(|row| row[0] + row[1] + row[2]));
        self.least = LEAST_WEIGHT * largest(self.weights.iter().copied());
    }

    fn clear(&mut self, multipliers: usize) {
        self.segments.clear();
        self.before.clear();
        self.before.push(0);
        self.shapes.clear();
        self.shifts.clear();
        self.places.clear();
        self.slave.clear();
        self.slave.resize(multipliers, [0.0; 3]);
        self.rows.reset(multipliers);
        self.weights.clear();
        self.onsets.clear();
    }

    /// Finds the segments of a part of the slave.
    fn cut(&mut self, (slave, part): (&Side, &Part), master: &Side, shift: f64, tolerance: f64) {
        let start = self.places.len();
        place((slave, part), master, shift, tolerance, &mut self.places);
        let places = &self.places[start..];
        self.edges.clear();
        self.edges.extend(master.edges().iter().map(|&first| PlacedEdge::new(first, places)));
        let mut next = 0;
        for edge in part.edges.clone() {
            let ends = slave.ends(slave.edges()[edge]);
            segments((edge, ends), &self.edges, &mut next, &mut self.segments);
            self.before.push(self.segments.len());
        }
    }

    /// Adds one edge of a part of the slave.
    fn add_edge(&mut self, [slave, master]: [&Side; 2], edge: usize) {
        let first = slave.edges()[edge];
        let (ends, segments) = (slave.ends(first), self.segments_of(edge));
        if segments.is_empty() {
            self.shapes.push(DualShape::None);
        } else if covers(segments, ends) {
            let half = 0.5 * (ends[1] - ends[0]);
            self.slave[first][1] += half;
            self.slave[first + 1][1] += half;
            self.shapes.push(DualShape::WHOLE);
            self.add_master(slave, edge, DualShape::WHOLE_LINES);
        } else {
            self.add_cut([slave, master], edge);
        }
    }

    /// Adds an edge of which the master covers a part.
    #[cold]
    fn add_cut(&mut self, [slave, master]: [&Side; 2], edge: usize) {
        let first = slave.edges()[edge];
        let ends = slave.ends(first);
        let moments = Moments::of(ends, slave.inverse()[edge], self.segments_of(edge));
        let shape = moments.shape(ends[1] - ends[0], slave.corners(edge));
        if let [one, two] = &mut self.slave[first..first + 2] {
            moments.add(shape, one, two);
        }
        self.shapes.push(shape);
        if let DualShape::Part(part) = shape {
            let onset = Onset::new((slave, edge), (&part, moments.covered()), master, self.segments_of(edge));
            self.onsets.extend(onset);
        }
        self.add_master(slave, edge, shape.lines());
    }

    /// Adds ∫ψN over the segments of an edge, with these ψ. The multipliers of both of its nodes act on all nodes of
    /// the master with a segment on it.
    #[inline]
    fn add_master(&mut self, slave: &Side, edge: usize, lines: [[f64; 2]; 2]) {
        let (first, inverse) = (slave.edges()[edge], slave.inverse()[edge]);
        let (start, segments) = (slave.xi()[first], &self.segments[self.before[edge]..self.before[edge + 1]]);
        let [Some(low), Some(high)] = [segments.first(), segments.last()] else { return };
        let columns = self.edges[low.master].first..self.edges[high.master].first + 2;
        let (values, rows) = self.rows.widen(first, columns);
        for segment in segments {
            let [from, to] = segment.ends;
            let other = &self.edges[segment.master];
            let hat = [from, to].map(|xi| (xi - other.ends[0]) * other.inverse);
            let second = [from, to].map(|xi| (xi - start) * inverse);
            // Both factors are linear: Simpson's rule is exact.
            let sixth = (to - from) * (1.0 / 6.0);
            let upper = [sixth * (2.0 * hat[0] + hat[1]), sixth * (hat[0] + 2.0 * hat[1])];
            let lower = upper.map(|upper| 3.0 * sixth - upper);
            let dual = lines.map(|[start, slope]| second.map(|second| start + slope * second));
            for (column, hat) in [(other.first, lower), (other.first + 1, upper)] {
                for (row, dual) in rows.iter().zip(&dual) {
                    values[row.wrapping_add(column)] += hat[0] * dual[0] + hat[1] * dual[1];
                }
            }
        }
    }

    /// Whether any multiplier sets in.
    #[inline]
    pub(super) fn sets_in(&self) -> bool {
        !self.onsets.is_empty()
    }

    /// Adds what the conditions give way, times a rate (1/s²), to the matrix of their problem.
    pub(super) fn soften(&self, matrix: &mut Band, rate: f64) {
        for (first, compliance) in self.onsets.iter().map(Onset::softens) {
            matrix.add_difference(first, rate * compliance);
        }
    }

    /// Whether a multiplier acts and does not just set in: its condition is to hold.
    #[must_use]
    pub fn binds(&self, node: usize) -> bool {
        self.is_active(node) && self.onsets.iter().all(|onset| onset.uncovered() != node)
    }

    /// How far the condition of a node gives way under these multipliers (N/m), in m²: its weighted gap times w_k is
    /// not less than minus this.
    #[must_use]
    pub fn give(&self, node: usize, multiplier: impl Fn(usize) -> f64) -> f64 {
        self.onsets.iter().map(|onset| onset.give(node, &multiplier)).sum()
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

    /// A smaller value of a multiplier at a node of the master is rounding (m).
    #[inline]
    pub(super) fn least_part(&self, node: usize) -> f64 {
        LEAST_PART * self.weights[node]
    }

    /// The nodes of the master on which a multiplier acts, but for rounding.
    pub(super) fn acts_on(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        let ((first, row), least) = (self.master_row(node), self.least_part(node));
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
        let (mut rest, mut above) = (force.to_vec(), vec![0.0; force.len()]);
        let joins = |node: usize, part: f64| if self.is_active(node) { part } else { 0.0 };
        for node in 0..rest.len() {
            if !self.is_active(node) {
                rest[node] = 0.0;
                continue;
            }
            let mut pivot = self.slave[node][1];
            if node > 0 {
                let before = joins(node - 1, self.slave[node - 1][2]);
                pivot -= before * above[node - 1];
                rest[node] -= before * rest[node - 1];
            }
            rest[node] /= pivot;
            if node + 1 < rest.len() {
                above[node] = joins(node + 1, self.slave[node + 1][0]) / pivot;
            }
        }
        for node in (1..rest.len()).rev() {
            rest[node - 1] -= above[node - 1] * rest[node];
        }
        rest
    }
}
