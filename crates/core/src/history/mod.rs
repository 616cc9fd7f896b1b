//! Steps, and who takes and gives them.

mod check;
mod memory;
mod state;

pub use check::{StepCheck, StepError};
pub use memory::{History, MemoryError};
pub use state::State;

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

/// Takes steps in order, from 0 on.
pub trait StepSink<const D: usize> {
    /// Takes one step.
    ///
    /// # Errors
    /// Whatever keeps the sink from taking it; the run then stops.
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError>;

    /// Takes one step that was checked and evaluated already. A sink that needs no more than the step itself need not
    /// implement this.
    ///
    /// # Errors
    /// As [`StepSink::push`].
    fn push_state(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.push(&state.step)
    }
}

/// Gives steps back in order.
pub trait StepSource<const D: usize> {
    /// The instants of the steps; a history that ended early holds the first of them only.
    fn times(&self) -> &TimeGrid;

    /// Number of instants held, at most N + 1.
    fn count(&self) -> usize;

    /// Hands all steps to a sink.
    ///
    /// # Errors
    /// What the source fails to read or the sink fails to take.
    fn replay(&self, sink: &mut dyn StepSink<D>) -> Result<(), SinkError>;
}

/// Discards all steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Discard;

impl<const D: usize> StepSink<D> for Discard {
    fn push(&mut self, _: &Step<'_, D>) -> Result<(), SinkError> {
        Ok(())
    }
}

/// Two sinks side by side.
impl<const D: usize, A: StepSink<D>, B: StepSink<D>> StepSink<D> for (A, B) {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        self.0.push(step)?;
        self.1.push(step)
    }

    fn push_state(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.0.push_state(state)?;
        self.1.push_state(state)
    }
}

/// Any number of sinks side by side.
impl<const D: usize, S: StepSink<D>> StepSink<D> for Vec<S> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        self.iter_mut().try_for_each(|sink| sink.push(step))
    }

    fn push_state(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.iter_mut().try_for_each(|sink| sink.push_state(state))
    }
}

/// A sink that may be left out.
impl<const D: usize, S: StepSink<D>> StepSink<D> for Option<S> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        self.as_mut().map_or(Ok(()), |sink| sink.push(step))
    }

    fn push_state(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        self.as_mut().map_or(Ok(()), |sink| sink.push_state(state))
    }
}

impl<const D: usize, S: StepSink<D> + ?Sized> StepSink<D> for &mut S {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        (**self).push(step)
    }

    fn push_state(&mut self, state: &State<'_, D>) -> Result<(), SinkError> {
        (**self).push_state(state)
    }
}
