//! The density on one edge of a surface that slides.

use super::facets::EdgeFacet;
use crate::concentrated::EdgeRest;
use crate::partition::Piece;

/// The density on an edge: between break points.
#[derive(Clone, Debug)]
pub(super) struct Load<const D: usize> {
    moments: [[f64; D]; 2],
    /// Places of the ends along the edge, from 0 to 1, and values there (N/m).
    spans: Vec<([f64; 2], [[f64; D]; 2])>,
}

impl<const D: usize> Default for Load<D> {
    fn default() -> Self {
        Self { moments: [[0.0; D]; 2], spans: Vec::new() }
    }
}

impl<const D: usize> Load<D> {
    /// Adds a piece, whose ends are at these places along the edge and have these values (N/m).
    pub(super) fn add(&mut self, piece: &Piece, places: [f64; 2], values: [[f64; D]; 2]) {
        let first = places.map(|place| 1.0 - place);
        for c in 0..D {
            let component = values.map(|value| value[c]);
            self.moments[0][c] += piece.product(first, component);
            self.moments[1][c] += piece.product(places, component);
        }
        self.spans.push((places, values));
    }

    /// The linear traction with the same moments, at a node (N).
    pub(super) fn nodal(&self, end: usize) -> [f64; D] {
        std::array::from_fn(|c| 4.0 * self.moments[end][c] - 2.0 * self.moments[1 - end][c])
    }

    /// ∫F² over the edge (N²/m).
    pub(super) fn square(&self, edge: &EdgeFacet) -> f64 {
        let of = |(places, values): &([f64; 2], [[f64; D]; 2])| -> f64 {
            let sum = (0..D).map(|c| [values[0][c], values[1][c]]).map(|[a, b]| a * a + a * b + b * b);
            (places[1] - places[0]) * edge.length / 3.0 * sum.sum::<f64>()
        };
        self.spans.iter().map(of).sum()
    }

    /// ∫r² over the edge (N²/m), with the difference r of the density and that linear traction.
    pub(super) fn rest(&self, edge: &EdgeFacet) -> f64 {
        let (linear, length) = ([self.nodal(0), self.nodal(1)], edge.length);
        let at = |place: f64, c: usize| (linear[0][c] * (1.0 - place) + linear[1][c] * place) / length;
        let (mut sum, mut reached) = (0.0, 0.0);
        let mut add = |[from, to]: [f64; 2], values: [[f64; D]; 2]| {
            for c in 0..D {
                let [a, b] = [values[0][c] - at(from, c), values[1][c] - at(to, c)];
                sum += (to - from) * length / 3.0 * (a * a + a * b + b * b);
            }
        };
        for &(places, values) in &self.spans {
            add([reached, places[0]], [[0.0; D]; 2]);
            add(places, values);
            reached = places[1];
        }
        add([reached, 1.0], [[0.0; D]; 2]);
        sum
    }

    /// The place inside the edge where the density is largest, from 0 to 1.
    pub(super) fn peak(&self) -> Option<f64> {
        let size = |value: &[f64; D]| value.iter().map(|f| f * f).sum::<f64>();
        let ends = self.spans.iter().flat_map(|(places, values)| [0, 1].map(|k| (places[k], size(&values[k]))));
        let inside = ends.filter(|(place, _)| 0.0 < *place && *place < 1.0);
        inside.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
    }

    /// The density less that linear traction, seen from an end of the edge.
    pub(super) fn from_end(&self, end: usize, edge: &EdgeFacet) -> EdgeRest {
        let [from, to] = [[0.0, 1.0], [1.0, 0.0]][end];
        self.between([from, to], edge)
    }

    /// The same on both sides of a place inside: before it and after it.
    pub(super) fn around(&self, place: f64, edge: &EdgeFacet) -> [EdgeRest; 2] {
        [0.0, 1.0].map(|end| self.between([place, end], edge))
    }

    /// The part of it from one place to another one, as if that were an edge.
    fn between(&self, [from, to]: [f64; 2], edge: &EdgeFacet) -> EdgeRest {
        let part = (to - from).abs();
        let scaled = |value: [f64; D], length: f64| [0, D - 1].map(|c| value[c] * length * part);
        let [low, high] = [from.min(to), from.max(to)];
        let mut points = Vec::with_capacity(2 * self.spans.len());
        for &(places, values) in &self.spans {
            if low <= places[0] && places[1] <= high {
                points.extend([0, 1].map(|k| (((places[k] - from) / (to - from)), scaled(values[k], edge.length))));
            }
        }
        if to < from {
            points.reverse();
        }
        // Where the density goes on, two spans have one point.
        points.dedup_by(|next, last| next.0 == last.0 && next.1 == last.1);
        let [first, second] = [self.nodal(0), self.nodal(1)];
        let linear = [from, to].map(|at| scaled(std::array::from_fn(|c| first[c] * (1.0 - at) + second[c] * at), 1.0));
        EdgeRest { points, linear }
    }
}
