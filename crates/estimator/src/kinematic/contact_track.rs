//! The normal motion of a candidate node over the whole run: contact phases and the windows
//! between them.

use super::shape::solve;
use super::window::{FlightWindow, Path, least_of_parabola};
use crate::residual::{Residuals, worse};

/// Normal velocity (m/s) and gap (m) of a candidate node at the half-step instants known so far.
#[derive(Clone, Debug)]
pub(crate) struct ContactTrack {
    undeformed_gap: f64,
    /// Body size (m), which the residuals of distances refer to.
    size: f64,
    known: Vec<(f64, f64)>,
    /// Half steps and target velocities since the last known instant.
    lengths: Vec<f64>,
    target: Vec<f64>,
    touching: bool,
    /// The first instant whose motion is not that of the simulation.
    first_altered: usize,
    /// Whether contact is solved for; a prescribed node keeps its motion.
    free: bool,
    onset: f64,
    at_instants: f64,
    between_instants: f64,
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

impl ContactTrack {
    /// A node with this gap (m) and normal velocity (m/s) at t = 0.
    pub(crate) fn new(undeformed_gap: f64, size: f64, free: bool, start: (f64, f64), touching: bool) -> Self {
        Self {
            undeformed_gap,
            size,
            known: vec![(start.1, start.0)],
            lengths: Vec::new(),
            target: Vec::new(),
            touching,
            first_altered: usize::MAX,
            free,
            onset: 0.0,
            at_instants: 0.0,
            between_instants: 0.0,
        }
    }

    /// Takes in the step from t_{n−1} to t_n.
    pub(crate) fn push(&mut self, step: &NormalStep, tolerance: f64) {
        let arrives = step.touching && !self.touching && self.free;
        if step.touching && self.touching && self.free {
            // Within a phase: at rest on the plane.
            let (_, gap) = self.last();
            self.first_altered = self.first_altered.min(self.known.len());
            self.known.extend([(0.0, gap); 2]);
        } else {
            self.lengths.extend([step.half; 2]);
            self.target.extend(step.velocity);
            if arrives || !self.free {
                self.close(arrives, tolerance);
            }
        }
        self.touching = step.touching;
    }

    /// Solves the last window, which ends with the run.
    pub(crate) fn finish(&mut self, tolerance: f64) {
        if !self.lengths.is_empty() {
            self.close(false, tolerance);
        }
    }

    /// Solves the window since the last known instant.
    fn close(&mut self, arrives: bool, tolerance: f64) {
        let (velocity, gap) = self.last();
        let window = FlightWindow { start: (gap, velocity), lengths: &self.lengths, target: &self.target, arrives };
        // A prescribed node cannot be moved out of the way.
        let path = if self.free { solve(&window, tolerance) } else { window.integrate(&self.target) };
        self.record(path, arrives);
    }

    /// Takes the motion over the window as known and checks it.
    fn record(&mut self, path: Path, arrives: bool) {
        let (velocity, gap) = self.last();
        if arrives {
            // Also the way that the simulation would go: where nothing but rest is admissible, the
            // motion itself is its rounding.
            let way = |h: &f64, v: f64| h * v.abs();
            let least = self.lengths.iter().zip(&self.target).map(|(h, v)| way(h, *v)).sum::<f64>();
            let travelled = self.lengths.iter().zip(&path).map(|(h, (v, _))| way(h, *v)).sum::<f64>().max(least);
            let (_, end) = path[path.len() - 1];
            self.onset = worse(self.onset, end.abs() / (gap.abs() + travelled).max(f64::MIN_POSITIVE));
        }
        if arrives || !self.free || path.iter().zip(&self.target).any(|((v, _), target)| v != target) {
            self.first_altered = self.first_altered.min(self.known.len());
        }
        let mut before = (velocity, gap);
        for (m, &after) in path.iter().enumerate() {
            let (_, least) = least_of_parabola(before, after, self.lengths[m], m);
            self.at_instants = worse(self.at_instants, -after.1 / self.size);
            self.between_instants = worse(self.between_instants, -least / self.size);
            before = after;
        }
        self.known.extend(path);
        self.lengths.clear();
        self.target.clear();
    }

    fn last(&self) -> (f64, f64) {
        self.known[self.known.len() - 1]
    }

    /// Number of instants known so far.
    #[inline]
    pub(crate) fn known(&self) -> usize {
        self.known.len()
    }

    /// Normal velocity (m/s) and gap (m) at a known instant.
    #[inline]
    pub(crate) fn at(&self, instant: usize) -> (f64, f64) {
        self.known[instant]
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

    /// Adds the residuals of this node.
    pub(crate) fn report(&self, residuals: &mut Residuals) {
        residuals.onset = worse(residuals.onset, self.onset);
        residuals.penetration_at_instants = worse(residuals.penetration_at_instants, self.at_instants);
        residuals.penetration_between_instants = worse(residuals.penetration_between_instants, self.between_instants);
    }
}

#[cfg(test)]
mod tests;
