//! Estimates in files.

mod open;
mod write;

pub use open::{EstimateFile, open};
pub use write::write;
