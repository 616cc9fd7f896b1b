//! Closed-form elastodynamic fields, with their sources: what a simulation, or an estimate of its
//! error, is measured against.
//!
//! [`BarImpact`] is the impact of a bar on a rigid plane; [`BarMode`] and [`BlockMode`] are
//! standing waves of a bar and of a rectangle on rollers. All units are SI. The crate depends on
//! nothing, so that no error of the simulation can hide in its own yardstick.

mod bar_impact;
mod bar_mode;
mod block_mode;

pub use bar_impact::BarImpact;
pub use bar_mode::{BarEnds, BarMode};
pub use block_mode::{BlockMode, Wave};
