//! Closed-form elastodynamic fields with their sources, as references for simulations and for estimates
//! of their errors.
//!
//! [`BarImpact`] is the impact of a bar on a rigid plane, [`BouncingBar`] the periodic impact under gravity,
//! [`ClampedRod`] a rod that springs back against an obstacle; [`BarRow`] are bars that strike each other;
//! [`BarRamp`] is a bar under a growing traction;
//! [`BarMode`] and [`BlockMode`] are standing waves of a bar and of a rectangle on rollers; [`RigidSlide`] is a rigid
//! block with dry friction. All units are SI. The crate has no dependencies, so it shares no error with the simulation.

mod bar_impact;
mod bar_mode;
mod bar_ramp;
mod bar_row;
mod block_mode;
mod bouncing_bar;
mod clamped_rod;
mod rigid_slide;

pub use bar_impact::BarImpact;
pub use bar_mode::{BarEnds, BarMode};
pub use bar_ramp::BarRamp;
pub use bar_row::{BarRow, RowBar};
pub use block_mode::{BlockMode, Wave};
pub use bouncing_bar::BouncingBar;
pub use clamped_rod::ClampedRod;
pub use rigid_slide::RigidSlide;
