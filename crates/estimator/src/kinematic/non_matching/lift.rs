//! Penetration of two surfaces, and the lifts that remove it.

use super::record::InterfaceMotion;
use crate::kinematic::normal_motions::Pair;
use crate::kinematic::window::least_of_parabola;
use crate::partition::{Piece, pieces};
use crate::residual::worse;
use percute_core::contact::NonMatchingSurfaces;

/// Instants in which a node rises or falls, at least.
const RISE: usize = 16;

/// How high a node is lifted (m), and from which instant to which one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lift {
    pub(super) height: f64,
    pub(super) instants: [usize; 2],
}

impl Lift {
    pub(super) const NONE: Self = Self { height: 0.0, instants: [usize::MAX, 0] };

    /// The higher of both, or their sum, over the instants of both.
    pub(super) fn with(&self, other: &Self, height: f64) -> Self {
        let ([a, b], [c, d]) = (self.instants, other.instants);
        Self { height, instants: [a.min(c), b.max(d)] }
    }

    /// Its speed (m/s) and height (m) at each instant at the ends of these half steps (s): it rises and falls evenly,
    /// in a time as long as it is needed.
    pub(super) fn motion(&self, halves: &[f64]) -> Vec<Pair> {
        let (mut motion, last) = (vec![[0.0; 2]; halves.len()], halves.len() - 1);
        if self.height == 0.0 {
            return motion;
        }
        let [first, until] = [self.instants[0].clamp(2, last.max(2)), self.instants[1]];
        let time = RISE.max(until.saturating_sub(first));
        let mut ramp = |from: usize, to: usize, height: f64| {
            // Speeds are linear between instants: those inside stand for half of both neighbours.
            let inside = from + 1..to.min(halves.len());
            let length: f64 = inside.clone().filter(|&j| j < last).map(|j| 0.5 * (halves[j] + halves[j + 1])).sum();
            inside.for_each(|j| motion[j][0] = height / length);
        };
        ramp(first.saturating_sub(time), first, self.height);
        if until + time <= last {
            ramp(until, until + time, -self.height);
        }
        for j in 1..halves.len() {
            motion[j][1] = motion[j - 1][1] + 0.5 * halves[j] * (motion[j - 1][0] + motion[j][0]);
        }
        motion
    }
}

/// Where a hat has less than this, its node does not move the place.
const BESIDE: f64 = 1e-9;

/// The penetration of two surfaces during the run.
#[derive(Clone, Debug)]
pub(super) struct Penetration {
    /// By how much each node of slave and master has to give way, and when.
    pub(super) lifts: [Vec<Lift>; 2],
    /// The deepest point at the instants and between them (m).
    pub(super) deepest: [f64; 2],
    shares: [f64; 2],
    /// The instant that is looked at, or the last one before.
    instant: usize,
    /// Depths below this are none (m).
    tolerance: f64,
}

impl Penetration {
    /// None so far, of surfaces with so many nodes. Of a depth, the slave takes this share.
    pub(super) fn new(nodes: [usize; 2], share: f64, tolerance: f64) -> Self {
        let lifts = nodes.map(|nodes| vec![Lift::NONE; nodes]);
        Self { lifts, deepest: [0.0; 2], shares: [share, 1.0 - share], instant: 0, tolerance }
    }

    /// Whether a lift is wanted.
    pub(super) fn is_found(&self) -> bool {
        self.lifts.iter().flatten().any(|lift| lift.height > 0.0)
    }

    /// Looks at an instant.
    pub(super) fn at<const D: usize>(
        &mut self,
        non_matching: &NonMatchingSurfaces<D>,
        motion: &InterfaceMotion,
        instant: usize,
    ) {
        self.instant = instant;
        let coupling = non_matching.coupling_at(&motion.places());
        for piece in pieces(non_matching, &coupling) {
            let gap = difference(&piece, &motion.eta);
            (0..2).for_each(|end| self.take_in(&piece, end, gap[end], 0));
        }
    }

    /// Looks at the half step of this length (s) between the last instant and the next one: the exact least gap of each
    /// point where the bodies do not slide, else those after each quarter of it.
    pub(super) fn between<const D: usize>(
        &mut self,
        non_matching: &NonMatchingSurfaces<D>,
        [from, to]: [&InterfaceMotion; 2],
        half: f64,
    ) {
        if from.shifts.iter().zip(&to.shifts).all(|([a, _], [b, _])| (b - a).abs() <= self.tolerance) {
            let coupling = non_matching.coupling_at(&to.places());
            for piece in pieces(non_matching, &coupling) {
                let [a, b] = [from, to].map(|at| [difference(&piece, &at.speed), difference(&piece, &at.eta)]);
                for end in 0..2 {
                    let [before, after] = [a, b].map(|[speed, gap]| (speed[end], gap[end]));
                    let (_, least) = least_of_parabola(before, after, half, 0);
                    self.take_in(&piece, end, least, 1);
                }
            }
            return;
        }
        for part in [0.25, 0.5, 0.75] {
            let motion = within(from, to, half, part);
            let coupling = non_matching.coupling_at(&motion.places());
            for piece in pieces(non_matching, &coupling) {
                let gap = difference(&piece, &motion.eta);
                (0..2).for_each(|end| self.take_in(&piece, end, gap[end], 1));
            }
        }
    }

    /// Lifts the nodes of both surfaces at a point of a piece with this gap (m): its node, or both of its edge.
    fn take_in(&mut self, piece: &Piece, end: usize, gap: f64, which: usize) {
        self.deepest[which] = worse(self.deepest[which], -gap);
        if gap >= -0.5 * self.tolerance {
            return;
        }
        // Between two instants it is wanted from the first one to the second one.
        let instants = [self.instant, self.instant + which];
        let edges = [(piece.slave[1], piece.on_slave[end]), (piece.master[1], piece.on_master[end])];
        for ((lifts, share), (first, second)) in self.lifts.iter_mut().zip(self.shares).zip(edges) {
            let nodes = [(first, 1.0 - second), (first + 1, second)].into_iter().filter(|(_, hat)| *hat > BESIDE);
            for (node, _) in nodes {
                let here = Lift { height: -gap * share, instants };
                lifts[node] = lifts[node].with(&here, lifts[node].height.max(here.height));
            }
        }
    }
}

/// The difference of a field on slave and master at the ends of a piece.
fn difference(piece: &Piece, field: &[Vec<f64>; 2]) -> [f64; 2] {
    let [slave, master] = [piece.slave_values(|node| field[0][node]), piece.master_values(|node| field[1][node])];
    [0, 1].map(|end| slave[end] - master[end])
}

/// The motion within a half step of this length (s), after a part of it: velocities are linear.
fn within(from: &InterfaceMotion, to: &InterfaceMotion, half: f64, part: f64) -> InterfaceMotion {
    let advance =
        |place: f64, [before, after]: [f64; 2]| place + half * part * (before + 0.5 * part * (after - before));
    let side = |k: usize| -> Vec<f64> {
        let speeds = from.speed[k].iter().zip(&to.speed[k]);
        from.eta[k].iter().zip(speeds).map(|(eta, (a, b))| advance(*eta, [*a, *b])).collect()
    };
    let shifts = from.shifts.iter().zip(&to.shifts);
    let shifts = shifts.map(|([place, before], [_, after])| [advance(*place, [*before, *after]), *after]).collect();
    InterfaceMotion { shifts, speed: Default::default(), eta: [side(0), side(1)] }
}
