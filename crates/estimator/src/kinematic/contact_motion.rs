//! The normal motion of a candidate node over the whole run: contact phases and the windows
//! between them.

use super::normal_motions::{NormalMotions, Pair};
use super::shape::solve;
use super::window::{FlightWindow, Path, least_of_parabola};
use crate::residual::{Residuals, worse};
use crate::scratch_file::ScratchError;

/// Normal velocity (m/s) and gap (m) of a candidate node at the half-step instants known so far.
///
/// They are stored with those of the other nodes. Since the last known instant the store has the target velocity
/// instead, and the half step that ends there (s).
#[derive(Clone, Debug)]
pub(crate) struct ContactMotion {
    /// Its number in the store.
    node: usize,
    undeformed_gap: f64,
    /// Body size (m), which the residuals of distances refer to.
    size: f64,
    /// Number of known instants, and the motion at the last one.
    known: usize,
    last: (f64, f64),
    /// The first of the instants at which the motion is at hand, and the motion there.
    shown_from: usize,
    shown: Vec<Pair>,
    touching: bool,
    /// The first instant whose motion is not that of the simulation.
    first_altered: usize,
    /// Whether contact is solved for; a prescribed node keeps its motion.
    free: bool,
    onset: f64,
    at_instants: f64,
    between_instants: f64,
}

/// Instants of a window that ends with the run which are worked on at once; few in tests, so that their windows have
/// some pieces.
const PIECE: usize = if cfg!(test) { 3 } else { 4096 };

/// A motion as it is stored.
fn stored(path: Path) -> Vec<Pair> {
    path.into_iter().map(|(velocity, gap)| [velocity, gap]).collect()
}

/// The normal motion of a candidate node over one step of the simulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalStep {
    /// Length of each of its two half steps (s).
    pub(crate) half: f64,
    /// Normal velocity at t_{n−½} and t_n (m/s).
    pub(crate) velocity: [f64; 2],
    /// Touching status at t_n.
    pub(crate) touching: bool,
}

impl ContactMotion {
    /// The node of this number, with this gap (m) and normal velocity (m/s) at t = 0, where it is at hand.
    pub(super) fn new(
        node: usize,
        (undeformed_gap, size): (f64, f64),
        free: bool,
        start: (f64, f64),
        touching: bool,
    ) -> Self {
        let (gap, velocity) = start;
        Self {
            node,
            undeformed_gap,
            size,
            known: 1,
            last: (velocity, gap),
            shown_from: 0,
            shown: vec![[velocity, gap]],
            touching,
            first_altered: usize::MAX,
            free,
            onset: 0.0,
            at_instants: 0.0,
            between_instants: 0.0,
        }
    }

    /// A node whose motion comes all at once: at instants that are shown, the change from the simulation.
    pub(super) fn of_change(node: usize) -> Self {
        Self::new(node, (0.0, 1.0), false, (0.0, 0.0), false)
    }

    /// Takes in that the store has its motion at so many instants.
    pub(super) fn reach(&mut self, count: usize) {
        self.known = count;
    }

    /// A node that has this motion at an instant, other than in the simulation.
    #[cfg(test)]
    pub(crate) fn altered(undeformed_gap: f64, instant: usize, motion: Pair) -> Self {
        let track = Self::new(0, (undeformed_gap, 1.0), false, (0.0, 0.0), false);
        Self { shown_from: instant, shown: vec![motion], first_altered: 0, ..track }
    }

    /// Takes in the step from t_{n−1} to t_n, for which the store has place.
    pub(super) fn push(
        &mut self,
        store: &mut NormalMotions,
        step: &NormalStep,
        tolerance: f64,
    ) -> Result<(), ScratchError> {
        let arrives = step.touching && !self.touching && self.free;
        let rests = step.touching && self.touching && self.free;
        self.touching = step.touching;
        let from = store.count() - 2;
        if rests {
            // Within a phase: at rest on the plane.
            let (_, gap) = self.last;
            self.first_altered = self.first_altered.min(self.known);
            self.last = (0.0, gap);
            self.known += 2;
            return store.write(self.node, from, &[[0.0, gap]; 2]);
        }
        store.write(self.node, from, &step.velocity.map(|velocity| [velocity, step.half]))?;
        if arrives || !self.free { self.close(store, arrives, tolerance) } else { Ok(()) }
    }

    /// Solves the last window, which ends with the run.
    pub(super) fn finish(&mut self, store: &mut NormalMotions, tolerance: f64) -> Result<(), ScratchError> {
        if self.penetrates(store, tolerance)? {
            return self.close(store, false, tolerance);
        }
        // Without a contact at its end the window has the motion of the simulation, piece by piece.
        while self.known < store.count() {
            let (first, target, lengths) = self.window(store, PIECE)?;
            let (velocity, gap) = self.last;
            let window = FlightWindow { start: (gap, velocity), lengths: &lengths, target: &target, arrives: false };
            let path = window.integrate(&target);
            self.record(&window, &path);
            store.write(self.node, first, &stored(path))?;
        }
        Ok(())
    }

    /// Whether the motion of the simulation since the last known instant is deeper than the tolerance (m).
    fn penetrates(&self, store: &mut NormalMotions, tolerance: f64) -> Result<bool, ScratchError> {
        let mut ahead = self.clone();
        while ahead.known < store.count() {
            let (_, target, lengths) = ahead.window(store, PIECE)?;
            let (velocity, gap) = ahead.last;
            let window = FlightWindow { start: (gap, velocity), lengths: &lengths, target: &target, arrives: false };
            let path = window.integrate(&target);
            let (_, least) = window.deepest(&path);
            if least.is_nan() || least < -tolerance {
                return Ok(true);
            }
            let (velocity, gap) = path[path.len() - 1];
            (ahead.last, ahead.known) = ((velocity, gap), ahead.known + path.len());
        }
        Ok(false)
    }

    /// The first instant that is not known, with target velocities and half steps from there on: at most so many.
    fn window(&self, store: &mut NormalMotions, most: usize) -> Result<(usize, Vec<f64>, Vec<f64>), ScratchError> {
        let count = most.min(store.count() - self.known);
        let mut steps = Vec::with_capacity(count);
        store.read(self.node, self.known..self.known + count, &mut steps)?;
        let (target, lengths) = steps.into_iter().map(|[velocity, half]| (velocity, half)).unzip();
        Ok((self.known, target, lengths))
    }

    /// Solves the window since the last known instant.
    fn close(&mut self, store: &mut NormalMotions, arrives: bool, tolerance: f64) -> Result<(), ScratchError> {
        // A window may be as long as the run: there is one copy of it at a time.
        let (first, target, lengths) = self.window(store, usize::MAX)?;
        let (velocity, gap) = self.last;
        let window = FlightWindow { start: (gap, velocity), lengths: &lengths, target: &target, arrives };
        // A prescribed node cannot be moved out of the way.
        let path = if self.free { solve(&window, tolerance) } else { window.integrate(&target) };
        self.record(&window, &path);
        store.write(self.node, first, &stored(path))
    }

    /// Takes the motion over the window as known and checks it.
    fn record(&mut self, window: &FlightWindow<'_>, path: &Path) {
        let FlightWindow { start: (gap, velocity), lengths, target, arrives } = *window;
        if arrives {
            // Also the way that the simulation would go: where nothing but rest is admissible, the
            // motion itself is its rounding.
            let way = |h: &f64, v: f64| h * v.abs();
            let least = lengths.iter().zip(target).map(|(h, v)| way(h, *v)).sum::<f64>();
            let travelled = lengths.iter().zip(path).map(|(h, (v, _))| way(h, *v)).sum::<f64>().max(least);
            let (_, end) = path[path.len() - 1];
            self.onset = worse(self.onset, end.abs() / (gap.abs() + travelled).max(f64::MIN_POSITIVE));
        }
        if arrives || !self.free || path.iter().zip(target).any(|((v, _), target)| v != target) {
            self.first_altered = self.first_altered.min(self.known);
        }
        let mut before = (velocity, gap);
        for (m, &after) in path.iter().enumerate() {
            let (_, least) = least_of_parabola(before, after, lengths[m], m);
            self.at_instants = worse(self.at_instants, -after.1 / self.size);
            self.between_instants = worse(self.between_instants, -least / self.size);
            before = after;
        }
        self.last = before;
        self.known += path.len();
    }

    /// Has the motion at hand at known instants, from the first to the last one.
    pub(super) fn show(&mut self, store: &mut NormalMotions, [first, last]: [usize; 2]) -> Result<(), ScratchError> {
        self.shown_from = first;
        self.shown.clear();
        store.read(self.node, first..last + 1, &mut self.shown)
    }

    /// Number of instants known so far.
    #[inline]
    pub(crate) fn known(&self) -> usize {
        self.known
    }

    /// Normal velocity (m/s) and gap (m) at an instant at which they are at hand.
    #[inline]
    pub(crate) fn at(&self, instant: usize) -> (f64, f64) {
        let [velocity, gap] = self.shown[instant - self.shown_from];
        (velocity, gap)
    }

    /// Whether the motion at a known instant differs from that of the simulation.
    #[inline]
    pub(crate) fn is_altered(&self, instant: usize) -> bool {
        instant >= self.first_altered
    }

    /// Gap of the node's place in the undeformed mesh (m).
    #[inline]
    pub(crate) fn undeformed_gap(&self) -> f64 {
        self.undeformed_gap
    }

    /// Adds the residual of its onsets.
    pub(super) fn report_onset(&self, residuals: &mut Residuals) {
        residuals.onset = worse(residuals.onset, self.onset);
    }

    /// Adds the residuals of this node.
    pub(crate) fn report(&self, residuals: &mut Residuals) {
        residuals.onset = worse(residuals.onset, self.onset);
        residuals.penetration_at_instants = worse(residuals.penetration_at_instants, self.at_instants);
        residuals.penetration_between_instants = worse(residuals.penetration_between_instants, self.between_instants);
    }
}

#[cfg(test)]
mod tests;
