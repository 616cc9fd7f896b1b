//! Steps, and who takes and gives them.

use crate::time::TimeGrid;

/// What the integrator hands on at t_n. Velocities and accelerations follow by the scheme.
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
}

/// Gives steps back in order.
pub trait StepSource<const D: usize> {
    /// The instants of the steps.
    fn times(&self) -> &TimeGrid;

    /// Hands all steps to a sink.
    ///
    /// # Errors
    /// What the source fails to read or the sink fails to take.
    fn replay(&self, sink: &mut dyn StepSink<D>) -> Result<(), SinkError>;
}

/// Takes steps and forgets them.
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
}

impl<const D: usize, S: StepSink<D> + ?Sized> StepSink<D> for &mut S {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        (**self).push(step)
    }
}

/// A history in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct History<const D: usize> {
    times: TimeGrid,
    displacement: Vec<Vec<[f64; D]>>,
    reaction: Vec<Vec<[f64; D]>>,
    touching: Vec<Vec<bool>>,
}

impl<const D: usize> History<D> {
    /// An empty history over these instants.
    #[must_use]
    pub fn new(times: &TimeGrid) -> Self {
        Self { times: times.clone(), displacement: Vec::new(), reaction: Vec::new(), touching: Vec::new() }
    }

    /// Number of instants held, at most N + 1.
    #[must_use]
    pub fn len(&self) -> usize {
        self.displacement.len()
    }

    /// Whether no step has been taken yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.displacement.is_empty()
    }

    /// The step n.
    #[must_use]
    pub fn step(&self, n: usize) -> Option<Step<'_, D>> {
        Some(Step {
            index: n,
            time: *self.times.instants().get(n)?,
            displacement: self.displacement.get(n)?,
            reaction: self.reaction.get(n)?,
            touching: self.touching.get(n)?,
        })
    }
}

impl<const D: usize> StepSink<D> for History<D> {
    fn push(&mut self, step: &Step<'_, D>) -> Result<(), SinkError> {
        self.displacement.push(step.displacement.to_vec());
        self.reaction.push(step.reaction.to_vec());
        self.touching.push(step.touching.to_vec());
        Ok(())
    }
}

impl<const D: usize> StepSource<D> for History<D> {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn replay(&self, sink: &mut dyn StepSink<D>) -> Result<(), SinkError> {
        (0..self.len()).filter_map(|n| self.step(n)).try_for_each(|step| sink.push(&step))
    }
}
