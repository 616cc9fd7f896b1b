//! Cases and their runs.

// Clippy allows this in test functions only; what they share is a test as well.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod adapt;
mod deformation;
mod numbering;
mod quantity;
mod schema;
mod seeds;
mod statement;
mod verdict;
mod yielding;
