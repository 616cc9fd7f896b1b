//! Steps, their sources and their sinks.

mod check;
mod checkpoint;
mod memory;
mod state;

pub(crate) use check::StepCheck;
pub use check::StepError;
pub use checkpoint::{Checkpoint, SUMS, Sums};
pub use memory::{History, MemoryError};
pub use state::State;
pub(crate) use state::{StepForces, half_of_last};

use crate::time::TimeGrid;

/// What the integrator hands on at t_n. Velocities and accelerations follow by the scheme, unless a
/// history of another program gives its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a, const D: usize> {
    /// n.
    pub index: usize,
    /// t_n (s).
    pub time: f64,
    /// u_n at the nodes (m).
    pub displacement: &'a [[f64; D]],
    /// Reactions R_n on the nodes of the contact surface (N), global axes.
    pub reaction: &'a [[f64; D]],
    /// Touching status at t_n of the nodes of the contact surface.
    pub touching: &'a [bool],
    /// v_n at the nodes (m/s), if the history holds it.
    pub velocity: Option<&'a [[f64; D]]>,
    /// a_n at the nodes (m/s²), if the history holds it.
    pub acceleration: Option<&'a [[f64; D]]>,
}

/// Why a sink could not take a step.
pub type SinkError = Box<dyn std::error::Error + Send + Sync>;

/// Takes the states of steps in order, from 0 on; with several threads, in one of them.
pub trait StateSink<const D: usize>: Send {
    /// Takes one state.
    ///
    /// # Errors
    /// Whatever keeps the sink from taking it; the run then stops.
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError>;
}

/// Gives steps back in order.
pub trait StepSource<const D: usize> {
    /// The instants of the steps; a history that ended early holds the first of them only.
    fn times(&self) -> &TimeGrid;

    /// Number of instants held, at most N + 1.
    fn count(&self) -> usize;

    /// Hands all steps to `take`. [`dynamics::replay`](crate::dynamics::replay) makes their states.
    ///
    /// # Errors
    /// What the source fails to read or `take` returns.
    fn replay(&self, take: &mut dyn FnMut(&Step<'_, D>) -> Result<(), SinkError>) -> Result<(), SinkError>;
}

/// Discards all states.
#[derive(Clone, Copy, Debug, Default)]
pub struct Discard;

impl<const D: usize> StateSink<D> for Discard {
    fn accept(&mut self, _: &State<'_, D>) -> Result<(), SinkError> {
        Ok(())
    }
}

/// Two sinks side by side.
impl<const D: usize, A: StateSink<D>, B: StateSink<D>> StateSink<D> for (A, B) {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.0.accept(state)?;
        self.1.accept(state)
    }
}

/// Any number of sinks side by side.
impl<const D: usize, S: StateSink<D>> StateSink<D> for Vec<S> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.iter_mut().try_for_each(|sink| sink.accept(state))
    }
}

/// A sink that may be left out.
impl<const D: usize, S: StateSink<D>> StateSink<D> for Option<S> {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.as_mut().map_or(Ok(()), |sink| sink.accept(state))
    }
}

impl<const D: usize, S: StateSink<D> + ?Sized> StateSink<D> for &mut S {
    fn accept(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        (**self).accept(state)
    }
}
