//! A history in memory.

use super::{SinkError, State, StateSink, Step, StepSource};
use crate::time::TimeGrid;
use thiserror::Error;

/// A history in memory: each field in one array, step after step.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    times: TimeGrid,
    count: usize,
    /// Numbers of a nodal field, of a field of the contact surface, and of its nodes.
    row: usize,
    contact_row: usize,
    contact_nodes: usize,
    displacement: Vec<f64>,
    reaction: Vec<f64>,
    touching: Vec<bool>,
    internal_row: usize,
    internal: Vec<f64>,
    velocity: Option<Vec<f64>>,
    acceleration: Option<Vec<f64>>,
}

/// Why a step does not fit into a history in memory.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum MemoryError {
    /// No room for all steps.
    #[error(
        "{bytes} bytes for {steps} steps of {numbers} displacements cannot be allocated in memory; store the history \
         in a file, whole or in part (`every`)"
    )]
    Full {
        /// Bytes wanted.
        bytes: usize,
        /// Instants.
        steps: usize,
        /// Displacements of a step.
        numbers: usize,
    },
    /// A field unlike that of the first step.
    #[error("step {step}: {field} has {given} values, but step 0 had {needed}")]
    Length {
        /// The step.
        step: usize,
        /// Which field.
        field: &'static str,
        /// Its length.
        given: usize,
        /// That of the first step.
        needed: usize,
    },
}

impl History {
    /// An empty history over these instants.
    #[must_use]
    pub fn new(times: &TimeGrid) -> Self {
        Self {
            times: times.clone(),
            count: 0,
            row: 0,
            contact_row: 0,
            contact_nodes: 0,
            displacement: Vec::new(),
            reaction: Vec::new(),
            touching: Vec::new(),
            internal_row: 0,
            internal: Vec::new(),
            velocity: None,
            acceleration: None,
        }
    }

    /// Number of instants held, at most N + 1.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether no step has been taken yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// u_n (m), node by node and step after step.
    #[must_use]
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// R_n (N) on the nodes of the contact surface, node by node and step after step.
    #[must_use]
    pub fn reaction(&self) -> &[f64] {
        &self.reaction
    }

    /// Touching status of the nodes of the contact surface, node by node and step after step.
    #[must_use]
    pub fn touching(&self) -> &[bool] {
        &self.touching
    }

    /// Internal variables of the elements, element by element and step after step; empty where no law has any.
    #[must_use]
    pub fn internal(&self) -> &[f64] {
        &self.internal
    }

    /// The step n.
    #[must_use]
    pub fn step(&self, n: usize) -> Option<Step<'_>> {
        if n >= self.count {
            return None;
        }
        let rows = |row: usize| n * row..(n + 1) * row;
        let nodes = rows(self.row);
        Some(Step {
            index: n,
            time: *self.times.instants().get(n)?,
            displacement: &self.displacement[nodes.clone()],
            reaction: &self.reaction[rows(self.contact_row)],
            touching: &self.touching[rows(self.contact_nodes)],
            internal: &self.internal[rows(self.internal_row)],
            velocity: self.velocity.as_ref().map(|v| &v[nodes.clone()]),
            acceleration: self.acceleration.as_ref().map(|a| &a[nodes]),
        })
    }

    /// Takes the sizes from the first step and makes room for all: what is not used is never touched.
    fn begin(&mut self, first: &Step<'_>) -> Result<(), MemoryError> {
        (self.row, self.contact_row) = (first.displacement.len(), first.reaction.len());
        (self.contact_nodes, self.internal_row) = (first.touching.len(), first.internal.len());
        let steps = self.times.step_count() + 1;
        let [nodal, contact, touching, internal] =
            [self.row, self.contact_row, self.contact_nodes, self.internal_row].map(|row| row.saturating_mul(steps));
        let numbers = nodal.saturating_add(contact).saturating_add(internal);
        let bytes = size_of::<f64>().saturating_mul(numbers).saturating_add(touching);
        let full = |_| MemoryError::Full { bytes, steps, numbers: self.row };
        self.displacement.try_reserve_exact(nodal).map_err(full)?;
        self.reaction.try_reserve_exact(contact).map_err(full)?;
        self.touching.try_reserve_exact(touching).map_err(full)?;
        self.internal.try_reserve_exact(internal).map_err(full)?;
        self.velocity = first.velocity.map(|_| Vec::new());
        self.acceleration = first.acceleration.map(|_| Vec::new());
        Ok(())
    }

    fn check(&self, step: &Step<'_>) -> Result<(), MemoryError> {
        let optional = |field: Option<&[f64]>| field.map_or(0, <[_]>::len);
        let expected = |there: bool| if there { self.row } else { 0 };
        let fields = [
            ("displacement", step.displacement.len(), self.row),
            ("reaction", step.reaction.len(), self.contact_row),
            ("touching", step.touching.len(), self.contact_nodes),
            ("internal", step.internal.len(), self.internal_row),
            ("velocity", optional(step.velocity), expected(self.velocity.is_some())),
            ("acceleration", optional(step.acceleration), expected(self.acceleration.is_some())),
        ];
        match fields.into_iter().find(|(_, given, needed)| given != needed) {
            Some((field, given, needed)) => Err(MemoryError::Length { step: step.index, field, given, needed }),
            None => Ok(()),
        }
    }
}

impl History {
    /// Appends a step.
    ///
    /// # Errors
    /// A step that does not fit the steps before, or no memory.
    pub fn push(&mut self, step: &Step<'_>) -> Result<(), SinkError> {
        if self.count == 0 {
            self.begin(step)?;
        }
        self.check(step)?;
        self.displacement.extend_from_slice(step.displacement);
        self.reaction.extend_from_slice(step.reaction);
        self.touching.extend_from_slice(step.touching);
        self.internal.extend_from_slice(step.internal);
        for (kept, given) in [(&mut self.velocity, step.velocity), (&mut self.acceleration, step.acceleration)] {
            if let (Some(kept), Some(given)) = (kept, given) {
                kept.extend_from_slice(given);
            }
        }
        self.count += 1;
        Ok(())
    }
}

impl StateSink for History {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        self.push(state.step())
    }
}

impl StepSource for History {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn count(&self) -> usize {
        self.count
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        (0..self.count).filter_map(|n| self.step(n)).try_for_each(|step| take(&step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const U: [f64; 4] = [1.0, 2.0, 3.0, 4.0];

    fn step(index: usize) -> Step<'static> {
        Step {
            index,
            time: index as f64,
            displacement: &U,
            reaction: &U[..2],
            touching: &[true],
            internal: &[],
            velocity: None,
            acceleration: Some(&U),
        }
    }

    #[test]
    fn steps_come_back_as_they_were() {
        let mut history = History::new(&TimeGrid::uniform(2.0, 2).unwrap());
        (0..3).for_each(|n| history.push(&step(n)).unwrap());
        assert_eq!((history.len(), history.displacement().len(), history.reaction().len()), (3, 12, 6));
        assert_eq!([0, 1, 2].map(|n| history.step(n)), [0, 1, 2].map(|n| Some(step(n))));
        assert_eq!(history.step(3), None);
        let mut again = History::new(history.times());
        history.replay(&mut |step| again.push(step)).unwrap();
        assert_eq!(again, history);
    }

    #[test]
    fn a_step_unlike_the_first_is_refused() {
        let mut history = History::new(&TimeGrid::uniform(2.0, 2).unwrap());
        history.push(&step(0)).unwrap();
        for wrong in [
            Step { displacement: &U[..2], ..step(1) },
            Step { touching: &[], ..step(1) },
            Step { velocity: Some(&U), ..step(1) },
            Step { acceleration: None, ..step(1) },
        ] {
            assert!(history.push(&wrong).is_err(), "{wrong:?}");
        }
        assert_eq!(history.len(), 1);
    }

    #[test]
    fn more_than_memory_can_hold_is_an_error() {
        let mut history = History::new(&TimeGrid::uniform(1.0, 50_000_000).unwrap());
        // 5e7 steps of 2e6 nodes: 1.6e15 bytes, beyond any address space.
        let u = vec![0.0; 4_000_000];
        let error = history.push(&Step { displacement: &u, acceleration: None, ..step(0) }).unwrap_err();
        assert!(matches!(error.downcast_ref(), Some(MemoryError::Full { .. })), "{error}");
    }
}
