//! Files: histories, estimates and meshes.

// Clippy allows this in test functions only; what they share is a test as well.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod estimate;
mod gmsh;
mod history;
