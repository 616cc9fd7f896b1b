//! The surfaces of bodies that could touch each other, from their shapes and velocities.
//!
//! Each two bodies are looked at along one direction, when nothing else has met either of them: the one in which they
//! meet with their velocities at the start or, if they do not, in which they are furthest apart. Edges see the other
//! body if nothing else is between.

mod approach;
mod contact;
mod outline;
#[cfg(test)]
mod tests;
mod view;

pub use contact::{Between, Contact};

use super::Cause;
use crate::ids::{FaceId, NodeId};
use approach::{Approach, ROUNDING, approach, dot};
use outline::{Edge, Outline, PlaneVector};
pub(super) use outline::{Start, outlines};
use std::collections::{BTreeMap, BTreeSet};
use view::{EdgesInView, View};

/// Surfaces reach beyond what faces the other body at first by this part of the smaller one of the two, and by twice
/// the way that bodies slide while they touch.
const BEYOND: f64 = 0.5;
/// Two pairs meet at once if their times differ by less than this part.
const AT_ONCE: f64 = 0.1;
/// A surface of a body is common to two pairs if the cosine of their directions is at least this.
pub(super) const ONE_DIRECTION: f64 = 0.9;
/// Bodies touch for about so many passages of a wave through both: there and back.
const PASSAGES: f64 = 2.0;

/// Two bodies, by their numbers, whose surfaces are wanted; `named` if the user named them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) pair: [usize; 2],
    pub(super) named: bool,
    /// The coefficient of friction, and whether nodes may slide.
    pub(super) friction: f64,
    pub(super) slides: bool,
}

/// The surfaces of two bodies that could touch.
#[derive(Debug)]
pub(super) struct Found {
    /// Its place among the wanted ones.
    pub(super) wanted: usize,
    pub(super) pair: [usize; 2],
    /// The faces that see the other body, ascending, and those beside them.
    pub(super) seeing: [Vec<FaceId>; 2],
    pub(super) beside: [Vec<FaceId>; 2],
    /// Those of both bodies that are nearest to each other when they meet.
    pub(super) nearest: Option<[FaceId; 2]>,
    /// Pairs of one number have a surface of a body in common.
    pub(super) shared: usize,
    /// How far they slide along each other while they touch, with their velocities at the start (m).
    pub(super) slide: f64,
    /// Of halves, the direction across which their line of symmetry stands.
    pub(super) across: Option<usize>,
}

/// Two bodies in the view in which they could meet.
struct Candidates<'w> {
    at: usize,
    wanted: &'w Wanted,
    /// From the first body to the second one.
    normal: PlaneVector,
    /// When they are looked at (s).
    time: f64,
    gap: f64,
    /// When they meet with their velocities at the start, if they do (s).
    meets: Option<f64>,
    slide: f64,
    across: Option<usize>,
    sides: [EdgesInView; 2],
}

/// The surfaces of all wanted pairs; none for a pair that is not named and does not see each other. `held` says which
/// components of a node are prescribed, `taken` are nodes of other surfaces, `facing_planes` faces that may touch one.
///
/// # Errors
/// What is wrong with a wanted pair, by its place.
pub(super) fn find(
    outlines: &[Outline],
    wanted: &[Wanted],
    held: impl Fn(NodeId) -> [bool; 2],
    taken: &BTreeSet<NodeId>,
    facing_planes: &BTreeSet<FaceId>,
) -> Result<Vec<Found>, (usize, Cause)> {
    let ways = Ways::new(outlines);
    let held = |edge: &Edge, normal: &PlaneVector| {
        edge.nodes.iter().any(|&node| (0..2).any(|c| held(node)[c] && normal[c].abs() > ROUNDING))
    };
    let mut all = Vec::new();
    for (at, one) in wanted.iter().enumerate() {
        let names = || one.pair.map(|body| outlines[body].name.clone());
        let Some((normal, time, way)) = ways.view(one.pair) else {
            let [first, second] = one.pair.map(|body| &outlines[body]);
            return Err((at, Cause::Interlocked { bodies: names(), halves: first.line_with(second).is_some() }));
        };
        let sides = View::new(outlines, time, normal).facing(one.pair, held);
        if sides.iter().any(|side| side.seeing.is_empty()) {
            if one.named {
                return Err((at, Cause::NothingSees { bodies: names() }));
            }
            continue;
        }
        let slide = slide(one.pair.map(|body| &outlines[body]), &normal);
        all.push(Candidates {
            at,
            wanted: one,
            normal,
            time,
            gap: way.gap,
            meets: way.meeting.map(|(_, time)| time),
            slide,
            across: way.across,
            sides,
        });
    }
    all.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    leave_corners(outlines, &mut all, facing_planes);
    claimed(outlines, all, taken)
}

/// Takes edges at a corner from pairs that do not meet, if the other side of that corner faces a plane or belongs to a
/// pair that meets.
fn leave_corners(outlines: &[Outline], all: &mut [Candidates<'_>], facing_planes: &BTreeSet<FaceId>) {
    let edges = outlines.iter().flat_map(|outline| &outline.edges);
    let on_planes: BTreeSet<NodeId> =
        edges.filter(|edge| facing_planes.contains(&edge.face)).flat_map(|edge| edge.nodes.iter().copied()).collect();
    let nodes = |pair: &Candidates<'_>, side: usize| -> BTreeSet<NodeId> {
        let edges = &outlines[pair.wanted.pair[side]].edges;
        pair.sides[side].seeing.iter().flat_map(|&(at, _)| edges[at].nodes.iter().copied()).collect()
    };
    let meeting = |pair: &&Candidates<'_>| pair.meets.is_some();
    let taken: Vec<(usize, PlaneVector, BTreeSet<NodeId>)> = all
        .iter()
        .filter(meeting)
        .flat_map(|pair| [0, 1].map(|side| (pair.wanted.pair[side], pair.outward(side), nodes(pair, side))))
        .collect();
    for pair in all.iter_mut().filter(|pair| pair.meets.is_none()) {
        for side in 0..2 {
            let (body, outward) = (pair.wanted.pair[side], pair.outward(side));
            let others = taken.iter().filter(|(of, normal, _)| *of == body && dot(normal, &outward) < ONE_DIRECTION);
            let others: Vec<&BTreeSet<NodeId>> = others.map(|(_, _, nodes)| nodes).collect();
            let free = |&(at, _): &(usize, f64)| {
                let edge = &outlines[body].edges[at];
                let on_plane = |node: &NodeId| on_planes.contains(node) && !facing_planes.contains(&edge.face);
                edge.nodes.iter().all(|node| !on_plane(node) && others.iter().all(|taken| !taken.contains(node)))
            };
            pair.sides[side].seeing.retain(free);
        }
    }
}

/// How far two bodies slide along each other while they touch (m).
fn slide([first, second]: [&Outline; 2], normal: &PlaneVector) -> f64 {
    let relative: PlaneVector = std::array::from_fn(|c| second.velocity[c] - first.velocity[c]);
    dot(&relative, &[-normal[1], normal[0]]).abs() * PASSAGES * (first.passage + second.passage)
}

impl Candidates<'_> {
    /// The surfaces, with the edges beside them.
    fn found(&self, outlines: &[Outline], beside: [Vec<FaceId>; 2], shared: usize) -> Found {
        let Self { at, wanted, normal, time, slide, across, sides, .. } = self;
        let seeing = [0, 1].map(|side| {
            let edges = &outlines[wanted.pair[side]].edges;
            let mut faces: Vec<FaceId> = sides[side].seeing.iter().map(|&(at, _)| edges[at].face).collect();
            faces.sort_unstable();
            faces
        });
        Found {
            wanted: *at,
            pair: wanted.pair,
            seeing,
            beside,
            nearest: View::new(outlines, *time, *normal).nearest(wanted.pair, sides),
            shared,
            slide: *slide,
            across: *across,
        }
    }

    /// Whether both pairs meet at about one time.
    fn meets_with(&self, other: &Self) -> bool {
        self.meets.zip(other.meets).is_some_and(|(a, b)| (a - b).abs() <= AT_ONCE * a.max(b))
    }

    /// The direction from a side to the other one.
    fn outward(&self, side: usize) -> PlaneVector {
        if side == 0 { self.normal } else { self.normal.map(|x| -x) }
    }

    /// Whether a surface of the body of a side may be common to both pairs.
    fn shares(&self, other: &Self, side: usize) -> bool {
        let (own, its) = (self.wanted, other.wanted);
        let Some(there) = its.pair.iter().position(|body| *body == own.pair[side]) else { return false };
        let alike = own.friction == its.friction && own.slides && its.slides;
        alike && dot(&self.outward(side), &other.outward(there)) >= ONE_DIRECTION
    }

    /// How far surfaces reach beyond what faces the other body at first (m).
    fn room(&self, outlines: &[Outline]) -> f64 {
        let lengths = [0, 1].map(|side| {
            let edges = &outlines[self.wanted.pair[side]].edges;
            self.sides[side].seeing.iter().map(|&(at, _)| length(&edges[at])).sum::<f64>()
        });
        BEYOND * lengths[0].min(lengths[1]) + 2.0 * self.slide
    }
}

/// Whether a length is less than another one by more than rounding, wherever the origin is.
fn less(length: f64, other: f64) -> bool {
    length < (1.0 - ROUNDING) * other
}

fn length(edge: &Edge) -> f64 {
    let [a, b] = edge.ends;
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Pairs that have some surface of one body in common.
struct Shared {
    /// A pair that stands for all those that a pair belongs to.
    of: Vec<usize>,
    /// The common body of those that a pair stands for.
    body: Vec<Option<usize>>,
}

impl Shared {
    fn new(pairs: usize) -> Self {
        Self { of: (0..pairs).collect(), body: vec![None; pairs] }
    }

    /// Whether two pairs belong together.
    fn contains(&self, pair: usize, other: usize) -> bool {
        self.of.get(other) == Some(&self.of[pair])
    }

    /// Puts two pairs together that have a surface of a body in common, unless one shares another one's already.
    fn add(&mut self, pair: usize, other: usize, body: usize) {
        let [one, two] = [pair, other].map(|k| self.of[k]);
        if [one, two].iter().all(|&k| self.body[k].is_none_or(|common| common == body)) {
            self.of.iter_mut().filter(|of| **of == one).for_each(|of| *of = two);
            self.body[two] = Some(body);
        }
    }

    /// Puts a pair together with earlier ones that own nodes of its edges.
    fn find(&mut self, outlines: &[Outline], all: &[Candidates<'_>], k: usize, owner: &BTreeMap<NodeId, usize>) {
        for (side, &body) in all[k].wanted.pair.iter().enumerate() {
            for &(at, distance) in &all[k].sides[side].seeing {
                let edge = &outlines[body].edges[at];
                for other in edge.nodes.iter().filter_map(|node| owner.get(node).copied()).filter(|&other| other < k) {
                    // The earlier pair is nearer.
                    let both = less(distance, length(edge)) || all[k].meets_with(&all[other]);
                    if both && all[k].shares(&all[other], side) {
                        self.add(k, other, body);
                    }
                }
            }
        }
    }
}

/// Gives each node to one pair: where surfaces of several see each other, to the nearest, unless one body has the same
/// surface against several; those beside get the rest.
fn claimed(
    outlines: &[Outline],
    mut all: Vec<Candidates<'_>>,
    taken: &BTreeSet<NodeId>,
) -> Result<Vec<Found>, (usize, Cause)> {
    let mut owner: BTreeMap<NodeId, usize> = taken.iter().map(|&node| (node, usize::MAX)).collect();
    let mut shared = Shared::new(all.len());
    for k in 0..all.len() {
        shared.find(outlines, &all, k, &owner);
        let Candidates { at: place, wanted, meets, sides, .. } = &mut all[k];
        for (side, &body) in sides.iter_mut().zip(&wanted.pair) {
            let edges = &outlines[body].edges;
            let is_other = |node: &NodeId| owner.get(node).is_some_and(|&of| !shared.contains(k, of));
            let other = |at: usize| edges[at].nodes.iter().find(|node| is_other(node));
            // Two bodies that are both about to touch an edge would need a node at two surfaces.
            let near = |at: usize, distance: f64| meets.is_some() && less(distance, length(&edges[at]));
            let contested = |&&(at, distance): &&(usize, f64)| near(at, distance) && other(at).is_some();
            if let Some(&(at, _)) = side.seeing.iter().find(contested) {
                let bodies = Box::new(wanted.pair.map(|body| outlines[body].name.clone()));
                let nodes = edges[at].nodes.iter().map(|node| node.index()).collect();
                let stated = other(at).and_then(|node| owner.get(node)) == Some(&usize::MAX);
                return Err((*place, Cause::Contested { nodes, bodies, stated }));
            }
            side.seeing.retain(|&(at, _)| other(at).is_none());
            owner.extend(side.seeing.iter().flat_map(|&(at, _)| &edges[at].nodes).map(|&node| (node, k)));
        }
    }
    let mut found = with_edges_beside(outlines, &all, &shared, owner);
    found.sort_by_key(|found| found.wanted);
    Ok(found)
}

/// The surfaces of all pairs that have edges, with those beside them that no other pair owns.
fn with_edges_beside(
    outlines: &[Outline],
    all: &[Candidates<'_>],
    shared: &Shared,
    mut owner: BTreeMap<NodeId, usize>,
) -> Vec<Found> {
    let mut found = Vec::new();
    for (k, candidates) in all.iter().enumerate() {
        let (room, Candidates { wanted, sides, .. }) = (candidates.room(outlines), candidates);
        let beside = [0, 1].map(|side| {
            let edges = &outlines[wanted.pair[side]].edges;
            let near = sides[side].beside.iter().filter(|(_, aside)| !less(room, *aside)).map(|&(at, _)| &edges[at]);
            let mut chosen = Vec::new();
            for edge in near {
                if edge.nodes.iter().all(|node| owner.get(node).is_none_or(|&of| shared.contains(k, of))) {
                    owner.extend(edge.nodes.iter().map(|&node| (node, k)));
                    chosen.push(edge.face);
                }
            }
            chosen.sort_unstable();
            chosen
        });
        if sides.iter().all(|side| !side.seeing.is_empty()) {
            found.push(candidates.found(outlines, beside, shared.of[k]));
        }
    }
    found
}

/// How all bodies come together.
struct Ways {
    of_pair: BTreeMap<[usize; 2], Option<Approach>>,
    /// When each body first meets another one (s).
    first: Vec<f64>,
}

impl Ways {
    fn new(outlines: &[Outline]) -> Self {
        let (mut of_pair, mut first) = (BTreeMap::new(), vec![f64::INFINITY; outlines.len()]);
        for a in 0..outlines.len() {
            for b in a + 1..outlines.len() {
                let way = approach(&outlines[a], &outlines[b]);
                if let Some(Approach { meeting: Some((_, time)), .. }) = way {
                    [a, b].into_iter().for_each(|body| first[body] = f64::min(first[body], time));
                }
                of_pair.insert([a, b], way);
            }
        }
        Self { of_pair, first }
    }

    /// The direction and the time (s) at which to look at two bodies; none if no straight line separates them.
    fn view(&self, [a, b]: [usize; 2]) -> Option<(PlaneVector, f64, &Approach)> {
        let way = self.of_pair.get(&[a.min(b), a.max(b)])?.as_ref()?;
        let reliable = |time: f64| [a, b].iter().all(|&body| time <= (1.0 + ROUNDING) * self.first[body]);
        let (normal, time) = way.meeting.filter(|(_, time)| reliable(*time)).unwrap_or((way.normal, 0.0));
        Some((if a < b { normal } else { normal.map(|x| -x) }, time, way))
    }
}
