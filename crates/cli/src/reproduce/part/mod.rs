//! The parts, in the order of the page.

mod bar_maps;
mod block;
mod effectivity;
mod parallel;
mod stress_maps;
mod table1;
mod time_steps;

use super::Part;

/// All parts, in the order of the page.
pub const PARTS: &[Part] =
    &[table1::PART, bar_maps::PART, stress_maps::PART, time_steps::PART, super::pack::PART, effectivity::PART];
