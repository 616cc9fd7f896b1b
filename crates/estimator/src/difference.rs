//! The difference of the simulation and the auxiliary solution at one level.

/// Energies at t_n (J), each ½x·Kx + ½y·M_c y of a difference of displacements x and of velocities y.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Difference {
    /// D: of the simulation and the auxiliary solution.
    pub(crate) energy: f64,
    /// Its part in the elements with a node that may touch.
    pub(crate) near: f64,
    /// The product of this difference with the one that the contact forces alone make.
    pub(crate) contact: f64,
    /// D under the contact force of the auxiliary solution.
    pub(crate) dispersion: f64,
    /// The same with a quarter of the dispersion, that of elements and steps half as long.
    pub(crate) halved_elements: f64,
    /// D of a simulation with steps half as long.
    pub(crate) halved_step: f64,
    /// Sum over nodes of F²k, and of F²: F the contact force (N), k the halvings of its hats.
    pub(crate) halvings: [f64; 2],
}

impl Difference {
    /// Adds so much of another.
    pub(crate) fn add(&mut self, weight: f64, other: &Self) {
        self.energy += weight * other.energy;
        self.near += weight * other.near;
        self.contact += weight * other.contact;
        self.dispersion += weight * other.dispersion;
        self.halved_elements += weight * other.halved_elements;
        self.halved_step += weight * other.halved_step;
        (0..2).for_each(|k| self.halvings[k] += weight * other.halvings[k]);
    }

    /// The mean of two.
    pub(crate) fn mean(&self, other: &Self) -> Self {
        let mut mean = Self::default();
        mean.add(0.5, self);
        mean.add(0.5, other);
        mean
    }
}
