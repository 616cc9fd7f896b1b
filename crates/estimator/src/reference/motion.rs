//! Displacement and velocity at the instants of a simulation.

use percute_core::history::{SinkError, State, StateSink};

/// Nodal displacements and velocities at all t_n; it takes them from the states of a simulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion<const D: usize> {
    /// t_n (s).
    pub times: Vec<f64>,
    /// u_n (m).
    pub displacement: Vec<Vec<[f64; D]>>,
    /// v_n (m/s).
    pub velocity: Vec<Vec<[f64; D]>>,
}

impl<const D: usize> StateSink<D> for Motion<D> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.times.push(state.step().time);
        self.displacement.push(state.step().displacement.to_vec());
        self.velocity.push(state.velocity());
        Ok(())
    }
}
