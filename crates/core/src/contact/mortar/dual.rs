//! The dual basis on the covered part of an edge.

use super::partition::Segment;

/// The shape functions of the multipliers on the covered part of an edge of the slave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DualShape {
    /// Nothing of the edge is covered.
    None,
    /// A part of it is, from an end on.
    Part(EndPart),
    /// All of it is, or elsewhere at least half: ψ_k = Σ_i c_ki φ_i, biorthogonal to the hats φ on what is covered, and
    /// χ = φ.
    Both([[f64; 2]; 2]),
    /// Less than half of it is, elsewhere or short: ψ = χ = 1 of this node, and nothing of the other one.
    One(usize),
}

/// A part of an edge from an end on. ψ* and χ* are those of an edge that is this part alone: the conditions of ψ* are
/// those at its ends. Of the multiplier of the node that is not covered, ψ = sψ* and χ = sχ*; of the other
/// one ψ = 1 − sψ* and χ = 1 − sχ*. Without the multiplier of the uncovered node, s = 0, the part would be
/// [`DualShape::One`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndPart {
    /// The second hat of the edge at both ends of the part.
    ends: [f64; 2],
    /// Which of the nodes of the edge is not covered.
    uncovered: usize,
    /// s: how far the multiplier of the uncovered node has set in, up to 1.
    onset: f64,
}

/// The parts of an edge between which its second multiplier sets in. Short of that the conditions at the ends of the
/// part are nearly the same, and speeds that differ a little would turn the edge fast. A multiplier that set in at once
/// would push out the end of the master, which has entered the edge, in one step: with a force like 1/Δt².
const ONSET: [f64; 2] = [1.0 / 8.0, 3.0 / 4.0];

/// An onset nearer to its begin or end is there.
const ROUNDING: f64 = 1e-6;

/// The part of an edge from a corner of the slave on at which its second multiplier sets in, at once. The corner
/// touches first and stays: with conditions that give way, the estimate would be up to 6 times the true error of an
/// impact close to the end of a plate. From 0.04 of an edge on, it is 22 times that of a corner that slides off at
/// 400 m/s.
const CORNER_ONSET: f64 = 1.0 / 16.0;

/// ∫φ_i and ∫φ_2² over the covered part of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    hats: [f64; 2],
    square: f64,
    covered: f64,
    /// φ_2 at the ends of what is covered.
    ends: [f64; 2],
    /// Whether there is no hole in it.
    joined: bool,
}

impl Moments {
    /// Over segments of an edge from `ends[0]` to `ends[1]`, of which `inverse` is 1 over the length.
    pub(super) fn of(ends: [f64; 2], inverse: f64, segments: &[Segment]) -> Self {
        let (mut second, mut square, mut covered) = (0.0, 0.0, 0.0);
        let hat = |xi: f64| if xi == ends[1] { 1.0 } else { (xi - ends[0]) * inverse };
        for segment in segments {
            let hat = segment.ends.map(hat);
            let length = segment.ends[1] - segment.ends[0];
            covered += length;
            second += 0.5 * length * (hat[0] + hat[1]);
            square += length / 3.0 * (hat[0] * hat[0] + hat[0] * hat[1] + hat[1] * hat[1]);
        }
        let [first, last] = [segments.first(), segments.last()];
        let part = [first.map_or(0.0, |s| hat(s.ends[0])), last.map_or(0.0, |s| hat(s.ends[1]))];
        Self { hats: [covered - second, second], square, covered, ends: part, joined: is_joined(segments) }
    }

    /// How much of the edge is covered (m).
    pub(super) fn covered(&self) -> f64 {
        self.covered
    }

    /// Adds ∫ψφ, with these shape functions on the edge, to the rows of its nodes: the values at the node before, at
    /// the node and at the node after it.
    #[inline]
    pub(super) fn add(&self, shape: DualShape, first: &mut [f64; 3], second: &mut [f64; 3]) {
        let [one, two] = self.hats;
        match shape {
            DualShape::None => (),
            DualShape::Both(_) => {
                first[1] += one;
                second[1] += two;
            }
            DualShape::Part(part) => {
                let [[own, after], [before, other]] = part.coupling(self.covered, self.hats);
                first[1] += own;
                first[2] += after;
                second[0] += before;
                second[1] += other;
            }
            DualShape::One(0) => {
                first[1] += one;
                first[2] += two;
            }
            DualShape::One(_) => {
                second[0] += one;
                second[1] += two;
            }
        }
    }

    /// The shape functions on an edge of this length, and whether its nodes are corners.
    pub(super) fn shape(&self, length: f64, corners: [bool; 2]) -> DualShape {
        let Self { hats: [first, second], square, covered, ends, joined } = *self;
        if covered == length {
            return DualShape::WHOLE;
        }
        let from = [ends[0] == 0.0, ends[1] == 1.0];
        if joined && (from[0] || from[1]) {
            let onset = onset(covered / length, (from[0] && corners[0]) || (from[1] && corners[1]));
            let uncovered = usize::from(from[0]);
            return if onset > 0.0 {
                DualShape::Part(EndPart { ends, uncovered, onset })
            } else {
                DualShape::One(1 - uncovered)
            };
        }
        // All of an edge in two halves must not hang on rounding.
        if covered < 0.5 * length * (1.0 - 1e-12) {
            return DualShape::One(usize::from(second > first));
        }
        // D B⁻¹ with B = ∫φφᵀ.
        let mixed = second - square;
        let own = covered - 2.0 * second + square;
        let inverse = 1.0 / (own * square - mixed * mixed);
        let (one, two) = (first * inverse, second * inverse);
        DualShape::Both([[one * square, -one * mixed], [-two * mixed, two * own]])
    }
}

/// How far the second multiplier has set in where this share of an edge is covered, from a corner of the slave on or
/// not.
fn onset(share: f64, corner: bool) -> f64 {
    if corner {
        return f64::from(share > CORNER_ONSET);
    }
    // A part of just the first or the last share must not hang on rounding.
    match (share - ONSET[0]) / (ONSET[1] - ONSET[0]) {
        early if early < ROUNDING => 0.0,
        late if late > 1.0 - ROUNDING => 1.0,
        onset => onset,
    }
}

/// Whether segments cover all between two ends.
#[inline]
pub(super) fn covers(segments: &[Segment], ends: [f64; 2]) -> bool {
    let [Some(first), Some(last)] = [segments.first(), segments.last()] else { return false };
    first.ends[0] == ends[0] && last.ends[1] == ends[1] && is_joined(segments)
}

/// Whether segments have no hole between them.
fn is_joined(segments: &[Segment]) -> bool {
    segments.windows(2).all(|pair| pair[0].ends[1] == pair[1].ends[0])
}

impl EndPart {
    /// Which of the nodes of the edge is not covered, and how far it has set in.
    pub(super) fn uncovered(&self) -> (usize, f64) {
        (self.uncovered, self.onset)
    }

    /// D = ∫ψ_kφ_i over the part of this length, of which `hats` has ∫φ_i.
    pub(super) fn coupling(&self, length: f64, hats: [f64; 2]) -> [[f64; 2]; 2] {
        // Each ψ* stands for one end of the part: ∫ψ*f is f there times half of the length.
        let at_ends = self.ends.map(|second| [1.0 - second, second].map(|hat| 0.5 * length * self.onset * hat));
        let before = hats.map(|hat| (1.0 - self.onset) * hat);
        let mut rows = at_ends;
        (0..2).for_each(|i| rows[1 - self.uncovered][i] += before[i]);
        rows
    }

    /// sψ* or sχ* of the multiplier of the uncovered node, from ψ* or χ* of both where the second hat of the part has a
    /// value; of the other one 1 less that.
    fn of_both(&self, second: f64, shape: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
        let here = (second - self.ends[0]) / (self.ends[1] - self.ends[0]);
        let value = self.onset * shape(here)[self.uncovered];
        let mut both = [1.0 - value; 2];
        both[self.uncovered] = value;
        both
    }
}

impl DualShape {
    /// That of an edge of which all is covered: ∫ψφ is half of its length at each node.
    pub(super) const WHOLE: Self = Self::Both([[2.0, -1.0], [-1.0, 2.0]]);
    /// Its [lines](Self::lines).
    pub(super) const WHOLE_LINES: [[f64; 2]; 2] = [[2.0, -3.0], [-1.0, 3.0]];

    /// ψ of both nodes where the second hat is 0, and by how much it grows until the second hat is 1.
    #[inline]
    pub(super) fn lines(&self) -> [[f64; 2]; 2] {
        let [start, end] = [0.0, 1.0].map(|second| self.dual(second));
        [0, 1].map(|k| [start[k], end[k] - start[k]])
    }

    /// ψ of both nodes where the second hat has this value.
    #[inline]
    #[must_use]
    pub fn dual(&self, second: f64) -> [f64; 2] {
        match self {
            Self::None => [0.0; 2],
            Self::Both(c) => [0, 1].map(|k| c[k][0] + (c[k][1] - c[k][0]) * second),
            Self::Part(part) => part.of_both(second, |second| [2.0 - 3.0 * second, 3.0 * second - 1.0]),
            Self::One(node) => [0, 1].map(|k| f64::from(u8::from(k == *node))),
        }
    }

    /// χ of both nodes, the shape of the density, where the second hat has this value.
    #[inline]
    #[must_use]
    pub fn density(&self, second: f64) -> [f64; 2] {
        match self {
            Self::Both(_) => [1.0 - second, second],
            Self::Part(part) => part.of_both(second, |second| [1.0 - second, second]),
            other => other.dual(second),
        }
    }
}
