//! Problems that are refused, and the solution of the others.

// Clippy allows this in test functions only; what they share is a test as well.
#![allow(clippy::unwrap_used)]

mod found;
mod refusals;
mod solution;
