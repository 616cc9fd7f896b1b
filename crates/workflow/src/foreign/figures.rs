//! The figures of consistency.

use serde::Serialize;

/// The figures of consistency; each is 0 in a history that fits its problem exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Consistency {
    /// Largest component of M a + K u − F − R at any node and instant, over the largest of its terms. The acceleration
    /// is that of the history, else that of the displacements.
    pub balance: f64,
    /// The node of this component.
    pub node: usize,
    /// Its instant (s).
    pub time: f64,
    /// The same at the ends of steps that are 1.5 times as long as those beside them, or longer, less ten times that at
    /// all other instants; 0 without such steps, or if most instants are ends of them.
    pub long_step: f64,
    /// Largest difference of the given accelerations from those of the displacements, over the largest acceleration.
    pub acceleration: Option<f64>,
    /// Largest difference of the given velocities from those of the displacements, over the largest velocity.
    pub velocity: Option<f64>,
    /// Largest difference of u_0 from that of the problem, over the size of the body.
    pub initial_displacement: f64,
    /// Largest difference of v_0 from that of the problem, over the largest velocity at the start.
    pub initial_velocity: f64,
    /// Largest tension, or tangential force beyond Coulomb's limit, over the largest normal force.
    pub cone: f64,
    /// Largest difference between the sum of the contact forces on either side of a non-matching interface and that of
    /// the multipliers, over the largest sum of their sizes; none without such surfaces.
    pub interface_balance: Option<f64>,
    /// Misfit of Coulomb's law at nodes that slide, ∑(μR_n|w_t| + R_t·w_t)Δt over ∑μR_n|w_t|Δt, w_t of the step after
    /// t_n; none if no node slides with friction.
    pub slip: Option<f64>,
    /// Mean gap under a contact force, as far as it is nearly the same everywhere, over the element size.
    pub plane: f64,
    /// Largest product of a normal force at t_n and the gap at t_{n+1}, over the largest force and the element size.
    pub gap_under_force: f64,
    /// Largest penetration, over the element size.
    pub penetration: f64,
    /// ∑R p / √(∑R² ∑p²) of the normal forces R and the penetrations p at the same instant and node: 1 where a penalty
    /// makes forces in proportion to penetrations, at most 0 with multipliers; none without forces.
    pub penalty: Option<f64>,
    /// Number of nodes and instants at which touching status and contact force one step before disagree, over the
    /// number of changes of either.
    pub touching: f64,
    /// Largest error of the energy balance, over the largest energy or work.
    pub energy: f64,
}
