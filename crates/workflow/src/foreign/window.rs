//! The steps of a history with those before and after them.

use percute_core::history::{SinkError, Step, StepSource};
use std::collections::VecDeque;

/// A step with memory of its own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Held<const D: usize> {
    pub(crate) index: usize,
    pub(crate) time: f64,
    pub(crate) displacement: Vec<[f64; D]>,
    pub(crate) reaction: Vec<[f64; D]>,
    pub(crate) touching: Vec<bool>,
    pub(crate) velocity: Option<Vec<[f64; D]>>,
    pub(crate) acceleration: Option<Vec<[f64; D]>>,
}

impl<const D: usize> Held<D> {
    fn of(step: &Step<'_, D>) -> Self {
        Self {
            index: step.index,
            time: step.time,
            displacement: step.displacement.to_vec(),
            reaction: step.reaction.to_vec(),
            touching: step.touching.to_vec(),
            velocity: step.velocity.map(<[_]>::to_vec),
            acceleration: step.acceleration.map(<[_]>::to_vec),
        }
    }

    /// The step.
    pub(crate) fn step(&self) -> Step<'_, D> {
        Step {
            index: self.index,
            time: self.time,
            displacement: &self.displacement,
            reaction: &self.reaction,
            touching: &self.touching,
            velocity: self.velocity.as_deref(),
            acceleration: self.acceleration.as_deref(),
        }
    }
}

/// A step between its neighbours; the first has none before it, the last none after it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<'a, const D: usize> {
    pub(crate) before: Option<&'a Held<D>>,
    pub(crate) now: &'a Held<D>,
    pub(crate) after: Option<&'a Held<D>>,
}

/// Hands each step with its neighbours to `take`, in order.
pub(crate) fn windows<const D: usize>(
    source: &dyn StepSource<D>,
    take: &mut dyn FnMut(Window<'_, D>) -> Result<(), SinkError>,
) -> Result<(), SinkError> {
    let mut held: VecDeque<Held<D>> = VecDeque::with_capacity(3);
    source.replay(&mut |step| {
        if held.len() == 3 {
            held.pop_front();
        }
        held.push_back(Held::of(step));
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
