//! The edges of two bodies that see each other.

use super::approach::dot;
use super::outline::{Edge, Outline, PlaneVector};
use crate::ids::FaceId;
use crate::problem::alignment::FOUND;

/// Lengths below this part of the size of a body, or of an edge, are rounding, wherever the origin is.
const TOUCH: f64 = 1e-9;

/// All bodies as they are at a time, seen along a direction.
pub(super) struct View<'o> {
    outlines: &'o [Outline],
    time: f64,
    /// From the first body to the second one.
    normal: PlaneVector,
}

/// An edge in such a view: where it lies across (ξ) and along (η) the direction (m).
#[derive(Clone, Copy)]
struct SeenEdge {
    /// Ascending in ξ.
    xi: [f64; 2],
    eta: [f64; 2],
}

impl SeenEdge {
    /// η at a ξ that the edge has between its ends, or at one of them.
    fn eta_at(&self, xi: f64) -> Option<f64> {
        let [low, high] = self.xi;
        let room = TOUCH * (high - low);
        (low - room <= xi && xi <= high + room).then(|| {
            let part = (xi - low) / (high - low);
            (1.0 - part) * self.eta[0] + part * self.eta[1]
        })
    }
}

/// The edges of one body that face another one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct EdgesInView {
    /// Those that see it, as places in the outline, ascending, each with how far it is (m).
    pub(super) seeing: Vec<(usize, f64)>,
    /// Those beside it, with nothing in front, each with its distance across (m).
    pub(super) beside: Vec<(usize, f64)>,
}

impl<'o> View<'o> {
    pub(super) fn new(outlines: &'o [Outline], time: f64, normal: PlaneVector) -> Self {
        Self { outlines, time, normal }
    }

    /// The edges of each of two bodies that face the other one; those with a node that is held across are left out.
    pub(super) fn facing(&self, pair: [usize; 2], held: impl Fn(&Edge, &PlaneVector) -> bool) -> [EdgesInView; 2] {
        let towards = [self.normal, self.normal.map(|x| -x)];
        let sides: [Vec<(usize, SeenEdge)>; 2] = std::array::from_fn(|k| {
            let edges = self.outlines[pair[k]].edges.iter().enumerate();
            let faces = edges.filter(|(_, edge)| dot(&edge.normal, &towards[k]) >= FOUND);
            faces.map(|(at, edge)| (at, self.seen(pair[k], edge, &towards[k]))).collect()
        });
        std::array::from_fn(|k| {
            let range = sides[1 - k].iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, seen)| {
                // The other side is seen in the opposite direction.
                [low.min(-seen.xi[1]), high.max(-seen.xi[0])]
            });
            let mut facing = EdgesInView::default();
            for (at, seen) in &sides[k] {
                let edge = &self.outlines[pair[k]].edges[*at];
                if !edge.free || held(edge, &self.normal) {
                    continue;
                }
                let common = [seen.xi[0].max(range[0]), seen.xi[1].min(range[1])];
                let aside = (range[0] - seen.xi[1]).max(seen.xi[0] - range[1]);
                if common[1] - common[0] > TOUCH * (seen.xi[1] - seen.xi[0]) {
                    let xi = 0.5 * (common[0] + common[1]);
                    match self.in_front((pair[k], *at), seen, xi, &towards[k]) {
                        Some((body, distance)) if body == pair[1 - k] => facing.seeing.push((*at, distance)),
                        _ => {}
                    }
                } else {
                    let xi = 0.5 * (seen.xi[0] + seen.xi[1]);
                    // A side of the other body that is too steep to count may be in front, as above a corner.
                    let third = |(body, _): &(usize, f64)| *body != pair[1 - k];
                    if self.in_front((pair[k], *at), seen, xi, &towards[k]).filter(third).is_none() {
                        facing.beside.push((*at, aside));
                    }
                }
            }
            facing
        })
    }

    /// Of the edges that see each other, the two that are nearest; of several at a corner, the most opposite ones.
    pub(super) fn nearest(&self, pair: [usize; 2], sides: &[EdgesInView; 2]) -> Option<[FaceId; 2]> {
        let edges = pair.map(|body| &self.outlines[body].edges);
        // All along the direction from the first body to the second one.
        let seen = [0, 1].map(|k| {
            let places = sides[k].seeing.iter().map(|&(at, _)| at);
            places.map(|at| (at, self.seen(pair[k], &edges[k][at], &self.normal))).collect::<Vec<_>>()
        });
        let room = TOUCH * pair.map(|body| self.outlines[body].size).into_iter().fold(0.0, f64::max);
        let mut best: Option<(f64, f64, [FaceId; 2])> = None;
        for (own, one) in &seen[0] {
            for (other, two) in &seen[1] {
                let common = [one.xi[0].max(two.xi[0]), one.xi[1].min(two.xi[1])];
                let distance = common.into_iter().filter_map(|xi| Some(two.eta_at(xi)? - one.eta_at(xi)?));
                let distance = distance.fold(f64::INFINITY, f64::min);
                if common[1] < common[0] - room || distance == f64::INFINITY {
                    continue;
                }
                let (own, other) = (&edges[0][*own], &edges[1][*other]);
                let opposite = -dot(&own.normal, &other.normal);
                let nearer = |&(least, most, _): &(f64, f64, [FaceId; 2])| {
                    distance < least - room || (distance <= least + room && opposite > most)
                };
                if best.as_ref().is_none_or(nearer) {
                    best = Some((distance, opposite, [own.face, other.face]));
                }
            }
        }
        best.map(|(_, _, faces)| faces)
    }

    fn seen(&self, body: usize, edge: &Edge, towards: &PlaneVector) -> SeenEdge {
        let along = [-towards[1], towards[0]];
        let mut ends = edge.ends.map(|end| {
            let place = self.outlines[body].moved(&end, self.time);
            [dot(&place, &along), dot(&place, towards)]
        });
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        SeenEdge { xi: ends.map(|end| end[0]), eta: ends.map(|end| end[1]) }
    }

    /// The body that is next in front of a point of an edge, and how far (m).
    fn in_front(
        &self,
        (own, at): (usize, usize),
        seen: &SeenEdge,
        xi: f64,
        towards: &PlaneVector,
    ) -> Option<(usize, f64)> {
        let eta = seen.eta_at(xi)?;
        let mut nearest: Option<(usize, f64)> = None;
        for (body, outline) in self.outlines.iter().enumerate() {
            for (other, edge) in outline.edges.iter().enumerate() {
                // The outside of an edge is seen, and not that of the edge itself.
                if (body, other) == (own, at) || dot(&edge.normal, towards) >= -TOUCH {
                    continue;
                }
                let Some(distance) = self.seen(body, edge, towards).eta_at(xi).map(|found| found - eta) else {
                    continue;
                };
                let room = TOUCH * outline.size.max(self.outlines[own].size);
                if distance >= -room && nearest.is_none_or(|(_, least)| distance < least) {
                    nearest = Some((body, distance.max(0.0)));
                }
            }
        }
        nearest
    }
}
