//! Estimates in files.

mod maps;
mod open;
mod write;

pub use maps::{Field, Maps, maps};
pub use open::{AnyMesh, EstimateFile, open};
pub use write::write;
