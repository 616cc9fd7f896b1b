//! The parts, in the order of the page.

mod bar_maps;
mod block;
mod effectivity;
mod parallel;
mod stress_maps;
mod table1;
mod time_steps;
mod tried;

use super::Part;

/// All parts, in the order of the page.
pub const PARTS: &[Part] = &[
    effectivity::PART,
    tried::PART,
    bar_maps::PART,
    table1::PART,
    stress_maps::PART,
    time_steps::PART,
    super::pack::PART,
];
