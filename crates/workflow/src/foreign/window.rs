//! The steps of a history with those before and after them.

use percute_core::border::{Vector, row};
use percute_core::history::{SinkError, Step, StepSource};
use std::collections::VecDeque;

/// A step with memory of its own, and its fields as vectors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Held {
    pub(crate) index: usize,
    pub(crate) time: f64,
    pub(crate) displacement: Vec<Vector>,
    pub(crate) reaction: Vec<Vector>,
    pub(crate) touching: Vec<bool>,
    pub(crate) velocity: Option<Vec<Vector>>,
    pub(crate) acceleration: Option<Vec<Vector>>,
    rows: Rows,
}

/// The fields of a step in rows.
#[derive(Clone, Debug, PartialEq)]
struct Rows {
    displacement: Vec<f64>,
    reaction: Vec<f64>,
    velocity: Option<Vec<f64>>,
    acceleration: Option<Vec<f64>>,
}

impl Held {
    fn of(step: &Step<'_>, dimension: usize) -> Self {
        let vectors = |rows: &[f64]| vectors_of(rows, dimension);
        Self {
            index: step.index,
            time: step.time,
            displacement: vectors(step.displacement),
            reaction: vectors(step.reaction),
            touching: step.touching.to_vec(),
            velocity: step.velocity.map(vectors),
            acceleration: step.acceleration.map(vectors),
            rows: Rows {
                displacement: step.displacement.to_vec(),
                reaction: step.reaction.to_vec(),
                velocity: step.velocity.map(<[f64]>::to_vec),
                acceleration: step.acceleration.map(<[f64]>::to_vec),
            },
        }
    }

    /// The step.
    pub(crate) fn step(&self) -> Step<'_> {
        Step {
            index: self.index,
            time: self.time,
            displacement: &self.rows.displacement,
            reaction: &self.rows.reaction,
            touching: &self.touching,
            internal: &[],
            velocity: self.rows.velocity.as_deref(),
            acceleration: self.rows.acceleration.as_deref(),
        }
    }
}

/// The vectors of a field in rows.
pub(crate) fn vectors_of(rows: &[f64], dimension: usize) -> Vec<Vector> {
    (0..rows.len() / dimension).map(|at| row(rows, at, dimension)).collect()
}

/// A field in rows.
pub(crate) fn rows_of(vectors: &[Vector], dimension: usize) -> Vec<f64> {
    vectors.iter().flat_map(|vector| &vector[..dimension]).copied().collect()
}

/// A step between its neighbours; the first has none before it, the last none after it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<'a> {
    pub(crate) before: Option<&'a Held>,
    pub(crate) now: &'a Held,
    pub(crate) after: Option<&'a Held>,
}

/// Hands each step with its neighbours to `take`, in order.
pub(crate) fn windows(
    source: &dyn StepSource,
    dimension: usize,
    take: &mut dyn FnMut(Window<'_>) -> Result<(), SinkError>,
) -> Result<(), SinkError> {
    let mut held: VecDeque<Held> = VecDeque::with_capacity(3);
    source.replay(&mut |step| {
        if held.len() == 3 {
            held.pop_front();
        }
        held.push_back(Held::of(step, dimension));
        match held.len() {
            2 => take(Window { before: None, now: &held[0], after: Some(&held[1]) }),
            3 => take(Window { before: Some(&held[0]), now: &held[1], after: Some(&held[2]) }),
            _ => Ok(()),
        }
    })?;
    match held.len() {
        0 => Ok(()),
        1 => take(Window { before: None, now: &held[0], after: None }),
        n => take(Window { before: Some(&held[n - 2]), now: &held[n - 1], after: None }),
    }
}
