//! A checked step with the fields that follow from it.

use super::Step;
use crate::contact::ContactSurface;

/// A step that fits its problem, with internal forces, acceleration and velocity by the scheme, eq. \[28\]–\[32\]. They are
/// computed once for all sinks. Velocities or accelerations that the step brings replace those of the scheme.
#[derive(Clone, Copy, Debug)]
pub struct State<'a, const D: usize> {
    /// The step.
    pub step: Step<'a, D>,
    /// Strain energy ½ u_n·K u_n (J).
    pub strain: f64,
    /// M a_n by the scheme (N).
    pub force: &'a [[f64; D]],
    /// The same but for contact at the nodes of the contact surface (N).
    pub force_before_contact: &'a [[f64; D]],
    /// Reaction of each prescribed component (N).
    pub support_reaction: &'a [f64],
    /// v_{n−½} (m/s), at the start v₀.
    pub half_step: &'a [[f64; D]],
    /// ½Δt_{n−1} (s), 0 at the start.
    pub back: f64,
    /// 1/m of each node (1/kg).
    pub inverse_mass: &'a [f64],
}

impl<const D: usize> State<'_, D> {
    /// a_n of a node (m/s²).
    #[inline]
    fn acceleration_of(&self, node: usize) -> [f64; D] {
        match self.step.acceleration {
            Some(given) => given[node],
            None => self.force[node].map(|f| self.inverse_mass[node] * f),
        }
    }

    /// a_n (m/s²).
    #[must_use]
    pub fn acceleration(&self) -> Vec<[f64; D]> {
        (0..self.force.len()).map(|node| self.acceleration_of(node)).collect()
    }

    /// M a_n by the scheme but for contact (N).
    #[must_use]
    pub fn force_without_contact(&self, surface: &ContactSurface<D>) -> Vec<[f64; D]> {
        let mut force = self.force.to_vec();
        for (contact, before) in surface.nodes().iter().zip(self.force_before_contact) {
            force[contact.node.index()] = *before;
        }
        force
    }

    /// v_n = v_{n−½} + ½Δt_{n−1} a_n (m/s), at the start v₀.
    #[must_use]
    pub fn velocity(&self) -> Vec<[f64; D]> {
        if let Some(given) = self.step.velocity {
            return given.to_vec();
        }
        let one = |node: usize| {
            let acceleration = self.acceleration_of(node);
            std::array::from_fn(|c| self.half_step[node][c] + self.back * acceleration[c])
        };
        (0..self.force.len()).map(one).collect()
    }

    /// Kinetic energy (J) and momentum (kg m/s), with these masses of the nodes (kg).
    #[must_use]
    pub fn energies(&self, mass: &[f64]) -> (f64, [f64; D]) {
        if self.step.velocity.is_none() && self.step.acceleration.is_none() {
            return energies(mass, self.half_step, self.back, self.force);
        }
        energies(mass, &self.velocity(), 0.0, self.force)
    }
}

/// Those of the velocities v + `back` a.
fn energies<const D: usize>(mass: &[f64], velocity: &[[f64; D]], back: f64, force: &[[f64; D]]) -> (f64, [f64; D]) {
    let (mut kinetic, mut momentum) = ([0.0; D], [0.0; D]);
    for ((v, f), mass) in velocity.iter().zip(force).zip(mass) {
        for c in 0..D {
            // m v_n without the inverse mass: one array less to read.
            let p = mass * v[c] + back * f[c];
            momentum[c] += p;
            kinetic[c] += p * p / mass;
        }
    }
    (0.5 * kinetic.iter().sum::<f64>(), momentum)
}
