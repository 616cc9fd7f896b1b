//! Planes that are moved away from the bodies, so that a body may start on one and move into it.

use super::start_of_contact::{strikes, striking};
use super::{InputError, Problem};

/// Steps may be longer than stated by 1e-6 of them, to fit the end of a run.
const SAFE: f64 = 1.0 + 1e-5;

/// A plane that was moved away from the bodies, because a body starts on it and moves into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedPlane {
    /// Which of the planes, from 0.
    pub plane: usize,
    /// By how much, against its normal (m).
    pub distance: f64,
    /// The speed at which the body moves into it (m/s).
    pub speed: f64,
    /// The first step (s).
    pub step: f64,
}

impl<const D: usize> Problem<D> {
    /// Refuses a body that starts on a plane and moves into it.
    ///
    /// # Errors
    /// [`StrikesAtStart`](super::Cause::StrikesAtStart).
    pub fn check_planes(&self) -> Result<(), InputError> {
        let starts = self.starts_of_contact();
        let first = striking(self, &starts).next();
        first.map_or(Ok(()), |at| Err(strikes(self, at, starts[at])))
    }

    /// The problem with planes moved away that a body is on and moves into, by the least gap that lets its nodes come
    /// to rest in a first step of this length (s). None if there is no such plane.
    #[must_use]
    pub fn with_planes_moved(&self, step: f64) -> Option<Self> {
        let starts = self.starts_of_contact();
        let nodes = self.surface().nodes();
        let mut moved: Vec<usize> = striking(self, &starts).map(|at| nodes[at].obstacle).collect();
        moved.dedup();
        if moved.is_empty() {
            return None;
        }
        let mut problem = self.clone();
        for plane in moved {
            // As a plane that is too near: see `dynamics::check_start`.
            let least = |speed: f64| (0.25 * SAFE * speed * step).max(2.0 * self.contact_tolerance());
            let approaching = (0..nodes.len()).filter(|&at| nodes[at].obstacle == plane && nodes[at].free);
            let approaching = approaching.map(|at| starts[at]).filter(|(_, normal)| *normal < 0.0);
            let [mut distance, mut speed] = [0.0_f64; 2];
            for (gap, normal) in approaching {
                distance = distance.max(least(-normal) - gap);
                speed = speed.max(-normal);
            }
            problem.surface.move_back(plane, distance);
            problem.model.moved_planes.push(MovedPlane { plane, distance, speed, step });
        }
        Some(problem)
    }
}
