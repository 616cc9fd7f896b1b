//! Readers of files from anywhere, given any bytes: no panic, no endless loop, and memory in proportion to the input.

pub mod entry;
mod memory;

pub use memory::{in_proportion, keep_objects};
