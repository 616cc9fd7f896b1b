//! Estimates in files.

mod contact;
mod maps;
mod open;
mod sums;
mod write;

pub use contact::contact;
pub use maps::{Field, Maps, maps};
pub use open::{EstimateFile, open};
pub use write::{EstimateContents, write};
