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

use crate::border::vectors;
use crate::time::TimeGrid;

/// What the integrator hands on at t_n. Velocities and accelerations follow by the scheme, unless a
/// history of another program gives its own. Fields are numbers in rows, one for each node, with one number for each
/// dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a> {
    /// n.
    pub index: usize,
    /// t_n (s).
    pub time: f64,
    /// u_n at the nodes (m).
    pub displacement: &'a [f64],
    /// Reactions R_n on the nodes of the contact surface (N), global axes.
    pub reaction: &'a [f64],
    /// Touching status at t_n of the nodes of the contact surface.
    pub touching: &'a [bool],
    /// Internal variables of the elements at t_n, in rows; empty where no law has any, or where the history does not
    /// hold them: they then follow from the displacements of all steps.
    pub internal: &'a [f64],
    /// v_n at the nodes (m/s), if the history holds it.
    pub velocity: Option<&'a [f64]>,
    /// a_n at the nodes (m/s²), if the history holds it.
    pub acceleration: Option<&'a [f64]>,
}

/// Fields as vectors of the dimension of the body.
impl<'a> Step<'a> {
    /// u_n at the nodes (m).
    #[inline]
    #[must_use]
    pub fn displacement<const D: usize>(&self) -> &'a [[f64; D]] {
        vectors(self.displacement)
    }

    /// R_n on the nodes of the contact surface (N).
    #[inline]
    #[must_use]
    pub fn reaction<const D: usize>(&self) -> &'a [[f64; D]] {
        vectors(self.reaction)
    }
}

/// Why a sink could not take a step.
pub type SinkError = Box<dyn std::error::Error + Send + Sync>;

/// Takes the states of steps in order, from 0 on; with several threads, in one of them.
pub trait StateSink: Send {
    /// Takes one state.
    ///
    /// # Errors
    /// Whatever keeps the sink from taking it; the run then stops.
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError>;
}

/// Gives steps back in order.
pub trait StepSource {
    /// The instants of the steps; a history that ended early holds the first of them only.
    fn times(&self) -> &TimeGrid;

    /// Number of instants held, at most N + 1.
    fn count(&self) -> usize;

    /// Hands all steps to `take`. [`dynamics::replay`](crate::dynamics::replay) makes their states.
    ///
    /// # Errors
    /// What the source fails to read or `take` returns.
    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError>;
}

/// Discards all states.
#[derive(Clone, Copy, Debug, Default)]
pub struct Discard;

impl StateSink for Discard {
    fn accept(&mut self, _: &State<'_>) -> Result<(), SinkError> {
        Ok(())
    }
}

/// Two sinks side by side.
impl<A: StateSink, B: StateSink> StateSink for (A, B) {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.0.accept(state)?;
        self.1.accept(state)
    }
}

/// Any number of sinks side by side.
impl<S: StateSink> StateSink for Vec<S> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.iter_mut().try_for_each(|sink| sink.accept(state))
    }
}

/// A sink that may be left out.
impl<S: StateSink> StateSink for Option<S> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.as_mut().map_or(Ok(()), |sink| sink.accept(state))
    }
}

impl<S: StateSink + ?Sized> StateSink for Box<S> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        (**self).accept(state)
    }
}

impl<S: StateSink + ?Sized> StateSink for &mut S {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        (**self).accept(state)
    }
}
