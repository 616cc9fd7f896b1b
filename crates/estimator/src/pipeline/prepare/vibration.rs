//! The energy of deformation and vibration, to which errors are relative.

use percute_core::problem::{Problem, RigidMotion};

/// The largest energies at sampled levels: a common velocity or spin of a body is no part of them.
#[derive(Clone, Debug)]
pub(crate) struct Vibration {
    rigid: RigidMotion,
    /// Of the strain energy (J).
    pub(crate) strain: f64,
    /// Of the kinetic energy relative to the rigid motion of each body (J).
    pub(crate) kinetic: f64,
    /// Of the sum of both and of the plastic work (J).
    pub(crate) total: f64,
}

impl Vibration {
    pub(super) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        Self { rigid: RigidMotion::new(problem), strain: 0.0, kinetic: 0.0, total: 0.0 }
    }

    /// Takes in the strain energy and the plastic work (J), and the velocities (m/s) of a level.
    pub(super) fn take(&mut self, [strain, plastic]: [f64; 2], velocity: &[f64]) {
        let kinetic = self.rigid.relative_kinetic_energy(velocity);
        self.strain = self.strain.max(strain);
        self.kinetic = self.kinetic.max(kinetic);
        self.total = self.total.max(strain + plastic + kinetic);
    }
}
