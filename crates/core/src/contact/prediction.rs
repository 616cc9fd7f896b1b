//! The motion of the contact nodes that a step would have without reactions.

/// That of one node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Predicted<const D: usize> {
    /// u_n (m).
    pub(crate) displacement: [f64; D],
    /// v_{n+½} (m/s).
    pub(crate) velocity: [f64; D],
}

impl<const D: usize> Predicted<D> {
    /// From u_n (m), v_{n−½} (m/s), v₀ at the start, the force F_n − K u_n (N) and h_n over the mass (s/kg).
    #[inline]
    pub(crate) fn new(displacement: [f64; D], before: &[f64; D], force: &[f64; D], over_mass: f64) -> Self {
        Self { displacement, velocity: std::array::from_fn(|c| before[c] + over_mass * force[c]) }
    }

    /// Less the motion of another node.
    #[inline]
    pub(super) fn against(&self, other: &Self) -> Self {
        let less = |own: &[f64; D], other: &[f64; D]| std::array::from_fn(|c| own[c] - other[c]);
        Self {
            displacement: less(&self.displacement, &other.displacement),
            velocity: less(&self.velocity, &other.velocity),
        }
    }
}

/// Those of all nodes of the contact surface, in its order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prediction<'a, const D: usize> {
    pub(crate) nodes: &'a [Predicted<D>],
    /// Δt_n and h_n (s).
    pub(crate) steps: [f64; 2],
    /// Gaps above minus this are no contact (m).
    pub(crate) tolerance: f64,
}
