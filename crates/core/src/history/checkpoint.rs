//! The state from which a run goes on.

/// What the balance has summed up until an instant; `dynamics` alone knows the meaning of each number.
pub type Sums = [f64; SUMS];

/// Count of the numbers in [`Sums`].
pub const SUMS: usize = 24;

/// All that the scheme needs to go on from t_n; forces and contact at t_n follow from it, bit by bit.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// n.
    pub step: usize,
    /// u_n at the nodes (m), in rows.
    pub displacement: Vec<f64>,
    /// v_{n−½} at the nodes (m/s), at the start v₀, in rows.
    pub half_step: Vec<f64>,
    /// Internal variables of the elements at t_n, in rows; empty where no law has any.
    pub internal: Vec<f64>,
    /// Sums of the balance.
    pub sums: Sums,
}
