//! The paper's figure 10: the error and the length of the step, and what is left when the step is small.

mod impact;
mod mass;
mod sweep;

use super::block::{Block, Gap, Impact};
use crate::reproduce::tally::weight as weight_of;
use crate::reproduce::{Effort, Part, ReproduceError, Section, Tally};
use percute_core::observer::Observer;
use percute_estimator::Reconstruction;

pub(super) const PART: Part = Part { key: "time-steps", title: "The paper's figure 10: the error and the step", make };

/// Δt/Δt_c.
const RATIOS: [f64; 10] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];
/// Those of the small effort.
const FEW: [f64; 2] = [1.0, 0.5];

/// The ratios of an effort.
fn ratios(effort: &Effort) -> &'static [f64] {
    effort.either(&FEW, &RATIOS)
}

/// The block without friction, as the paper has it, on 640 elements. The impact falls on the same fraction of a step
/// whatever the step is.
fn block(ratio: f64, fraction: f64) -> Block {
    let gap = Gap::Near { metres: 0.2e-3, fraction };
    Block { courant: ratio, friction: 0.0, gap, ..Block::new([20, 16]) }
}

/// The weight of runs that are estimated with each reading.
fn weight<T>(runs: &[(T, Impact)]) -> f64 {
    let one = |(_, impact): &(T, Impact)| weight_of(&impact.problem, &impact.times);
    runs.iter().map(one).sum::<f64>() * Reconstruction::ALL.len() as f64
}

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let sweep = sweep::impacts(effort)?;
    let impacts = impact::impacts(effort)?;
    let bars = mass::bars(effort)?;
    let total = weight(&sweep) + weight(&impacts) + mass::weight(&bars);
    let tally = &mut Tally::new(PART.key, total, observer);
    let mut section = Section::new(PART.key, PART.title);
    sweep::add(&mut section, effort, &sweep, tally)?;
    impact::add(&mut section, effort, &impacts, tally)?;
    mass::add(&mut section, effort, &bars, tally)?;
    Ok(section)
}
