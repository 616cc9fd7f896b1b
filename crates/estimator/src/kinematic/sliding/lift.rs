//! Penetration of two surfaces, and the lifts that remove it.

use super::path::Lift;
use super::record::Motion;
use crate::kinematic::window::least_of_parabola;
use crate::partition::{Piece, pieces};
use crate::residual::worse;
use percute_core::contact::{Coupling, SlidingSurfaces};

/// Where a hat has less than this, its node does not move the place.
const BESIDE: f64 = 1e-9;

/// The penetration of two surfaces during the run.
#[derive(Clone, Debug)]
pub(super) struct Penetration {
    /// How much higher each node of the slave has to be, and by which instant.
    pub(super) lifts: Vec<Lift>,
    /// The deepest point at the instants and between them (m).
    pub(super) deepest: [f64; 2],
    /// The instant that is looked at, or the last one before.
    instant: usize,
    /// Depths below this are none (m).
    tolerance: f64,
    size: f64,
}

impl Penetration {
    pub(super) fn new(nodes: usize, [size, tolerance]: [f64; 2]) -> Self {
        Self { lifts: vec![Lift::NONE; nodes], deepest: [0.0; 2], instant: 0, tolerance, size }
    }

    /// Whether a lift is wanted.
    pub(super) fn is_found(&self) -> bool {
        self.lifts.iter().any(|lift| lift.height > 0.0)
    }

    /// Looks at an instant.
    pub(super) fn at<const D: usize>(&mut self, sliding: &SlidingSurfaces<D>, motion: &Motion, instant: usize) {
        self.instant = instant;
        let coupling = sliding.coupling_at(motion.shift[0]);
        for piece in pieces(sliding, &coupling) {
            let gap = difference(&piece, &motion.eta);
            (0..2).for_each(|end| self.take_in(&coupling, &piece, end, gap[end], 0));
        }
    }

    /// Looks at the half step of this length (s) between the last instant and the next one: the exact least gap of each point where the
    /// bodies do not slide, else those after each quarter of it.
    pub(super) fn between<const D: usize>(
        &mut self,
        sliding: &SlidingSurfaces<D>,
        [from, to]: [&Motion; 2],
        half: f64,
    ) {
        if (to.shift[0] - from.shift[0]).abs() <= self.tolerance {
            let coupling = sliding.coupling_at(to.shift[0]);
            for piece in pieces(sliding, &coupling) {
                let [a, b] = [from, to].map(|at| [difference(&piece, &at.speed), difference(&piece, &at.eta)]);
                for end in 0..2 {
                    let [before, after] = [a, b].map(|[speed, gap]| (speed[end], gap[end]));
                    let (_, least) = least_of_parabola(before, after, half, 0);
                    self.take_in(&coupling, &piece, end, least, 1);
                }
            }
            return;
        }
        for part in [0.25, 0.5, 0.75] {
            let motion = within(from, to, half, part);
            let coupling = sliding.coupling_at(motion.shift[0]);
            for piece in pieces(sliding, &coupling) {
                let gap = difference(&piece, &motion.eta);
                (0..2).for_each(|end| self.take_in(&coupling, &piece, end, gap[end], 1));
            }
        }
    }

    /// Lifts the nodes of the slave at a point of a piece with this gap (m): its node, or both that have a multiplier.
    fn take_in(&mut self, coupling: &Coupling, piece: &Piece, end: usize, gap: f64, which: usize) {
        self.deepest[which] = worse(self.deepest[which], -gap);
        if gap >= -0.5 * self.tolerance {
            return;
        }
        let (first, second) = (piece.slave[1], piece.on_slave[end]);
        let acts = |(node, hat): &(usize, f64)| *hat > BESIDE && coupling.is_active(*node);
        let nodes = [(first, 1.0 - second), (first + 1, second)].into_iter().filter(acts);
        let all: f64 = nodes.clone().map(|(_, hat)| hat).sum();
        for (node, _) in nodes {
            // Depth is at most the size of the body: a tiny hat must not throw the node away.
            let lift = &mut self.lifts[node];
            *lift = Lift { height: lift.height.max((-gap / all).min(self.size)), by: lift.by.min(self.instant) };
        }
    }
}

/// The difference of a field on slave and master at the ends of a piece.
fn difference(piece: &Piece, field: &[Vec<f64>; 2]) -> [f64; 2] {
    let [slave, master] = [piece.slave_values(|node| field[0][node]), piece.master_values(|node| field[1][node])];
    [0, 1].map(|end| slave[end] - master[end])
}

/// The motion within a half step of this length (s), after a part of it: velocities are linear.
fn within(from: &Motion, to: &Motion, half: f64, part: f64) -> Motion {
    let advance =
        |place: f64, [before, after]: [f64; 2]| place + half * part * (before + 0.5 * part * (after - before));
    let side = |k: usize| -> Vec<f64> {
        let speeds = from.speed[k].iter().zip(&to.speed[k]);
        from.eta[k].iter().zip(speeds).map(|(eta, (a, b))| advance(*eta, [*a, *b])).collect()
    };
    let ([shift, before], [_, after]) = (from.shift, to.shift);
    Motion { shift: [advance(shift, [before, after]), after], speed: Default::default(), eta: [side(0), side(1)] }
}
