//! Summary of one node.

use crate::border::Vector;
use crate::contact::Status;

/// The contact of one node up to the last instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeSummary {
    /// The first t_n at which it touches (s).
    pub first_touch: Option<f64>,
    /// Time during which it was not free (s).
    pub time_in_contact: f64,
    /// Largest normal force (N).
    pub peak_normal_force: f64,
    /// Instant of that force (s); none without force.
    pub time_of_peak: Option<f64>,
    /// Largest pressure (Pa): of the normal component of the density, eq. \[45\].
    pub peak_pressure: f64,
    /// Impulse (N s), global axes.
    pub impulse: Vector,
    /// Energy dissipated by friction (J).
    pub friction_energy: f64,
}

impl NodeSummary {
    pub(super) fn new() -> Self {
        Self {
            first_touch: None,
            time_in_contact: 0.0,
            peak_normal_force: 0.0,
            time_of_peak: None,
            peak_pressure: 0.0,
            impulse: [0.0; 3],
            friction_energy: 0.0,
        }
    }

    /// Adds an instant.
    pub(super) fn at(&mut self, time: f64, touching: bool, normal_force: f64, area: f64) {
        if touching && self.first_touch.is_none() {
            self.first_touch = Some(time);
        }
        if normal_force > self.peak_normal_force {
            self.peak_normal_force = normal_force;
            self.time_of_peak = Some(time);
        }
        self.peak_pressure = self.peak_pressure.max(normal_force / area);
    }

    /// Adds a step of `dt` seconds with the forces and status at both ends. All integrals are trapezoids, like the
    /// impulse of the scheme.
    pub(super) fn over(&mut self, dt: f64, forces: [Vector; 2], status: [Status; 2]) {
        (0..3).for_each(|c| self.impulse[c] += 0.5 * dt * (forces[0][c] + forces[1][c]));
        let ends = status.iter().filter(|s| **s != Status::Free).count();
        self.time_in_contact += 0.5 * dt * ends as f64;
    }
}
