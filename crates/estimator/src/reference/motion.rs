//! Displacement and velocity at the instants of a simulation.

use percute_core::history::{SinkError, State, StateSink};

/// Nodal displacements and velocities at all t_n; it takes them from the states of a simulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// t_n (s).
    pub times: Vec<f64>,
    /// u_n (m), in rows.
    pub displacement: Vec<Vec<f64>>,
    /// v_n (m/s), in rows.
    pub velocity: Vec<Vec<f64>>,
    /// Internal variables of the elements at t_n, in rows; empty where no material yields.
    pub internal: Vec<Vec<f64>>,
}

impl StateSink for Motion {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.times.push(state.step().time);
        self.displacement.push(state.step().displacement.to_vec());
        self.velocity.push(state.velocity());
        self.internal.push(state.step().internal.to_vec());
        Ok(())
    }
}
