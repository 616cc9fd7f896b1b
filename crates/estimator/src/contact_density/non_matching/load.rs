//! The density on one edge of a non-matching interface.

use super::faces::EdgeFace;
use crate::concentrated::EdgeRest;
use crate::partition::Piece;

/// Break points nearer than this part of the edge are one where stresses are computed: an energy changes by as much,
/// and rings between two of them would lose all digits.
const NEAR: f64 = 1e-6;

/// Break points whose ways from a place differ by a smaller part are equally far where stresses are computed: a ring
/// between two of them, this part wide, loses up to eight digits of an energy, and one of a tenth of it all of them.
const THIN: f64 = 0.0103;

/// The density on an edge: between break points.
#[derive(Clone, Debug)]
pub(super) struct Load<const D: usize> {
    moments: [[f64; D]; 2],
    /// Places of the ends along the edge, from 0 to 1, and values there (N/m), in ascending order.
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
        // Another body of the slave may stand before those so far.
        let next = self.spans.partition_point(|(other, _)| other[0] <= places[0]);
        self.spans.insert(next, (places, values));
    }

    /// The same without spans too short for the stress of the load.
    pub(super) fn without_slivers(&self, edge: &EdgeFace) -> Self {
        let mut places: Vec<f64> = self.spans.iter().flat_map(|(places, _)| *places).chain([0.0, 1.0]).collect();
        places.sort_by(f64::total_cmp);
        // The first place, then each that is far enough above the last one kept; 1 stays, and draws those below it.
        places.dedup_by(|next, kept| *next - *kept < NEAR && *next < 1.0);
        let kept = |place: f64| {
            let after = places.partition_point(|other| *other <= place).max(1);
            if place > 1.0 - NEAR { 1.0 } else { places[after - 1] }
        };
        self.moved(kept, edge)
    }

    /// The same where break points almost equally far from a place, in parts of the ways from it to both ends, are
    /// equally far; and ∫d² of the difference d of both densities (N²/m). A span between two of them is left out, and
    /// counts in the difference.
    pub(super) fn with_equal_ways(&self, from: f64, edge: &EdgeFace) -> (Self, f64) {
        let end = |place: f64| if place > from { 1.0 } else { 0.0 };
        let way = |place: f64| if place == from { 0.0 } else { (place - from) / (end(place) - from) };
        let mut ways: Vec<f64> = self.spans.iter().flat_map(|(places, _)| places.map(way)).collect();
        ways.sort_by(|a, b| b.total_cmp(a));
        let mut kept = vec![1.0];
        for way in ways {
            if way < (1.0 - THIN) * kept[kept.len() - 1] {
                kept.push(way);
            }
        }
        let place_of = |place: f64| {
            let own = way(place);
            match kept.iter().find(|way| own >= (1.0 - THIN) * **way) {
                Some(1.0) => end(place),
                Some(way) if *way != own => from + way * (end(place) - from),
                _ => place,
            }
        };
        if self.spans.iter().all(|(places, _)| places.map(place_of) == *places) {
            return (self.clone(), 0.0);
        }
        let made = self.moved(place_of, edge);
        let difference = self.square_of_difference(&made, edge);
        (made, difference)
    }

    /// ∫d² of the difference d to another density (N²/m).
    fn square_of_difference(&self, other: &Self, edge: &EdgeFace) -> f64 {
        let mut places: Vec<f64> = self.spans.iter().chain(&other.spans).flat_map(|(places, _)| *places).collect();
        places.sort_by(f64::total_cmp);
        let difference = |ends: &[f64]| {
            let [own, other] = [self, other].map(|load| load.on([ends[0], ends[1]]));
            let apart: [[f64; D]; 2] = [0, 1].map(|k| std::array::from_fn(|c| own[k][c] - other[k][c]));
            square_of_linear((ends[1] - ends[0]) * edge.length, &apart)
        };
        places.windows(2).filter(|ends| ends[0] < ends[1]).map(difference).sum()
    }

    /// Values at both ends of a part of the edge that has no break point inside (N/m).
    fn on(&self, [start, end]: [f64; 2]) -> [[f64; D]; 2] {
        let middle = start.midpoint(end);
        let Some((places, values)) = self.spans.iter().find(|(places, _)| places[0] < middle && middle < places[1])
        else {
            return [[0.0; D]; 2];
        };
        let part = |at: f64| (at - places[0]) / (places[1] - places[0]);
        [start, end].map(|at| std::array::from_fn(|c| values[0][c] + part(at) * (values[1][c] - values[0][c])))
    }

    /// The same with its break points at other places, in the same order.
    fn moved(&self, to: impl Fn(f64) -> f64, edge: &EdgeFace) -> Self {
        let mut made = Self::default();
        for (ends, values) in &self.spans {
            let ends = ends.map(&to);
            let length = (ends[1] - ends[0]) * edge.length;
            if length > 0.0 {
                for c in 0..D {
                    let [f, g] = values.map(|value| value[c]);
                    let second = length / 6.0 * (ends[0] * (2.0 * f + g) + ends[1] * (f + 2.0 * g));
                    made.moments[0][c] += 0.5 * length * (f + g) - second;
                    made.moments[1][c] += second;
                }
                made.spans.push((ends, *values));
            }
        }
        made
    }

    /// The linear traction with the same moments, at a node (N).
    pub(super) fn nodal(&self, end: usize) -> [f64; D] {
        std::array::from_fn(|c| 4.0 * self.moments[end][c] - 2.0 * self.moments[1 - end][c])
    }

    /// ∫F² over the edge (N²/m).
    pub(super) fn square(&self, edge: &EdgeFace) -> f64 {
        let of = |(places, values): &([f64; 2], [[f64; D]; 2])| -> f64 {
            square_of_linear((places[1] - places[0]) * edge.length, values)
        };
        self.spans.iter().map(of).sum()
    }

    /// ∫r² over the edge (N²/m), with the difference r of the density and that linear traction.
    pub(super) fn rest(&self, edge: &EdgeFace) -> f64 {
        let (linear, length) = ([self.nodal(0), self.nodal(1)], edge.length);
        let at = |place: f64, c: usize| (linear[0][c] * (1.0 - place) + linear[1][c] * place) / length;
        let (mut sum, mut reached) = (0.0, 0.0);
        let mut add = |ends: [f64; 2], values: [[f64; D]; 2]| {
            let rest: [[f64; D]; 2] = [0, 1].map(|k| std::array::from_fn(|c| values[k][c] - at(ends[k], c)));
            sum += square_of_linear((ends[1] - ends[0]) * length, &rest);
        };
        for &(places, values) in &self.spans {
            add([reached, places[0]], [[0.0; D]; 2]);
            add(places, values);
            reached = places[1];
        }
        add([reached, 1.0], [[0.0; D]; 2]);
        sum
    }

    /// The places inside the edge where the density is largest, from 0 to 1; none if there are many.
    pub(super) fn peaks(&self) -> Vec<f64> {
        const SAME: f64 = 1.0 - 1e-9;
        const MANY: usize = 4;
        let size = |value: &[f64; D]| value.iter().map(|f| f * f).sum::<f64>();
        let ends = self.spans.iter().flat_map(|(places, values)| [0, 1].map(|k| (places[k], size(&values[k]))));
        let inside: Vec<_> = ends.filter(|(place, _)| 0.0 < *place && *place < 1.0).collect();
        let largest = inside.iter().fold(0.0, |most: f64, (_, size)| most.max(*size));
        // Rounding must not choose between equal ones.
        let mut peaks: Vec<f64> =
            inside.iter().filter(|(_, size)| *size >= SAME * largest).map(|(at, _)| *at).collect();
        peaks.dedup();
        if peaks.len() <= MANY { peaks } else { Vec::new() }
    }

    /// The part of the edge beside an end that has all of the load, at least twice as long as the way to a place.
    pub(super) fn part_at(&self, end: usize, place: f64) -> f64 {
        let from = |place: f64| if end == 0 { place } else { 1.0 - place };
        let reach = self.spans.iter().flat_map(|(places, _)| places.map(from)).fold(0.0, f64::max);
        reach.max(2.0 * from(place))
    }

    /// The load of a part of the edge beside an end, as if that part were an edge, and the load of the traction on the
    /// whole edge that is linear on this part and has the same moments.
    pub(super) fn spread_over(&self, part: f64, end: usize, edge: &EdgeFace) -> [Self; 2] {
        let start = if end == 0 { 0.0 } else { 1.0 - part };
        let scaled = |places: [f64; 2]| places.map(|place| place_in(part, end, place));
        let spans = self.spans.iter().map(|&(places, values)| (scaled(places), values)).collect();
        let moments: [[f64; D]; 2] = {
            let component = |c: usize| {
                let resultant = self.moments[0][c] + self.moments[1][c];
                let second = (self.moments[1][c] - start * resultant) / part;
                [resultant - second, second]
            };
            let all: [[f64; 2]; D] = std::array::from_fn(component);
            [0, 1].map(|k| all.map(|moments| moments[k]))
        };
        let beside = Self { moments, spans };
        let values = [0, 1].map(|k| beside.nodal(k).map(|f| f / (part * edge.length)));
        let whole = Self { moments: self.moments, spans: vec![([start, start + part], values)] };
        [beside, whole]
    }

    /// The density less that linear traction, seen from an end of the edge.
    pub(super) fn seen_from(&self, end: usize, edge: &EdgeFace) -> EdgeRest {
        let [from, to] = [[0.0, 1.0], [1.0, 0.0]][end];
        self.between([from, to], edge)
    }

    /// The same on both sides of a place inside: before it and after it.
    pub(super) fn around(&self, place: f64, edge: &EdgeFace) -> [EdgeRest; 2] {
        [0.0, 1.0].map(|end| self.between([place, end], edge))
    }

    /// The part of it from one place to another one, as if that were an edge.
    fn between(&self, [from, to]: [f64; 2], edge: &EdgeFace) -> EdgeRest {
        let part = (to - from).abs();
        let scaled = |value: [f64; D], length: f64| [0, D - 1].map(|c| value[c] * length * part);
        let [low, high] = [from.min(to), from.max(to)];
        let (mut points, mut reached) = (Vec::with_capacity(2 * self.spans.len()), None);
        let at = |place: f64| (place - from) / (to - from);
        for &(places, values) in &self.spans {
            if low <= places[0] && places[1] <= high {
                // Nothing acts in a hole.
                if let Some(end) = reached.filter(|end| *end < places[0]) {
                    points.extend([end, places[0]].map(|place| (at(place), [0.0; 2])));
                }
                reached = Some(places[1]);
                points.extend([0, 1].map(|k| (at(places[k]), scaled(values[k], edge.length))));
            }
        }
        if to < from {
            points.reverse();
        }
        let [first, second] = [self.nodal(0), self.nodal(1)];
        let linear = [from, to].map(|at| scaled(std::array::from_fn(|c| first[c] * (1.0 - at) + second[c] * at), 1.0));
        EdgeRest { points, linear }
    }
}

/// ∫f² of a function that is linear over a length (m), with these values at both ends.
fn square_of_linear<const D: usize>(length: f64, [from, to]: &[[f64; D]; 2]) -> f64 {
    let squares = from.iter().zip(to).map(|(a, b)| a * a + a * b + b * b);
    length / 3.0 * squares.sum::<f64>()
}

/// A place on an edge as one on the part of the edge beside an end.
pub(super) fn place_in(part: f64, end: usize, place: f64) -> f64 {
    let start = if end == 0 { 0.0 } else { 1.0 - part };
    ((place - start) / part).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EDGE: EdgeFace = EdgeFace { face: 0, ends: [0, 1], length: 0.3, spread: 1.0 };

    /// A load with a narrow peak and a hole, and its image with the ends of the edge exchanged.
    fn loads() -> [Load<2>; 2] {
        let spans = vec![
            ([0.02, 0.05], [[0.0, 0.0], [1.0, 9.0]]),
            ([0.05, 0.09], [[1.0, 9.0], [0.0, 2.0]]),
            ([0.11, 0.12], [[0.0, 1.0], [0.5, 3.0]]),
        ];
        let image = spans.iter().rev().map(|&([a, b], [f, g])| ([1.0 - b, 1.0 - a], [g, f])).collect();
        [spans, image].map(|spans| Load { moments: [[0.0; 2]; 2], spans }.without_slivers(&EDGE))
    }

    /// Moments of a load are those of its spans, and a part of the edge has those of a shorter edge.
    #[test]
    fn parts_keep_their_moments() {
        let same = |a: &Load<2>, b: &Load<2>| {
            let both = a.moments.as_flattened().iter().zip(b.moments.as_flattened());
            // Rounding of some sums.
            both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-14
        };
        for (end, load) in loads().iter().enumerate() {
            let [peak] = load.peaks()[..] else { panic!("one peak") };
            let part = load.part_at(end, peak);
            assert!((part - 0.12).abs() < 1e-15, "{part}");
            let [beside, whole] = load.spread_over(part, end, &EDGE);
            assert!(same(&whole, load) && same(&whole.without_slivers(&EDGE), load));
            let short = EdgeFace { length: part * EDGE.length, ..EDGE };
            assert!(same(&beside.without_slivers(&short), &beside));
            assert!(beside.spans.iter().any(|(places, _)| places[1] == place_in(part, end, peak)));
        }
    }

    /// Seen from the other end, the image is the load; nothing acts in its hole.
    #[test]
    fn images_and_holes() {
        let [load, image] = loads();
        let (one, other) = (load.seen_from(0, &EDGE), image.seen_from(1, &EDGE));
        assert_eq!(one.points.len(), other.points.len());
        for ((a, f), (b, g)) in one.points.iter().zip(&other.points) {
            assert!((a - b).abs() < 1e-15 && (0..2).all(|c| (f[c] - g[c]).abs() < 1e-15), "{a} {b}");
        }
        let hole: Vec<_> = one.points.iter().filter(|(_, value)| *value == [0.0; 2]).map(|(place, _)| *place).collect();
        assert_eq!(hole, [0.02, 0.09, 0.11]);
    }

    /// Break points that are almost equally far from a place, or from an end, become so. The difference is that of the
    /// densities: with a foot that moves by a part x of a hat of width w and height 1, x²w/3.
    #[test]
    fn ways_become_equal() {
        let load = |spans: &[([f64; 2], [f64; 2])]| {
            let spans = spans.iter().map(|(places, values)| (*places, values.map(|f| [f, 0.0]))).collect();
            Load { moments: [[0.0; 2]; 2], spans }.without_slivers(&EDGE)
        };
        let (width, part) = (0.1, 0.004);
        let foot = 0.5 + width * (1.0 - part);
        let hats = load(&[([0.4, 0.5], [0.0, 1.0]), ([0.5, foot], [1.0, 0.0])]);
        let (made, difference) = hats.with_equal_ways(0.5, &EDGE);
        assert!((made.spans[1].0[1] - 0.6).abs() < 1e-15 && made.spans[0] == hats.spans[0]);
        // To the first order in the part.
        let expected = part * part * width / 3.0 * EDGE.length;
        assert!((difference / expected - 1.0).abs() < 0.01, "{difference} {expected}");
        let (made, difference) = hats.with_equal_ways(0.0, &EDGE);
        assert!(made.spans == hats.spans && difference == 0.0);
        // A load beside the other end is none.
        let beside = load(&[([0.995, 1.0], [1.0, 1.0])]);
        let (made, difference) = beside.with_equal_ways(0.0, &EDGE);
        assert!(made.spans.is_empty() && (difference - beside.square(&EDGE)).abs() < 1e-15);
    }

    /// Break points nearer than a millionth of the edge are one, also beside its ends.
    #[test]
    fn slivers_are_left_out() {
        let value = [[1.0, 1.0]; 2];
        let spans = vec![([1e-8, 0.4], value), ([0.4, 0.4 + 1e-7], value), ([0.4 + 1e-7, 1.0 - 1e-8], value)];
        let load = Load { moments: [[0.0; 2]; 2], spans }.without_slivers(&EDGE);
        let places: Vec<_> = load.spans.iter().map(|(places, _)| *places).collect();
        assert_eq!(places, [[0.0, 0.4], [0.4, 1.0]]);
        assert!(load.nodal(0).iter().all(|f| (f - 0.3).abs() < 1e-15));
    }
}
