//! Free vibration in one mode, and motions without any error.

// Clippy allows this in test functions only; what they share is a test as well.
#![allow(clippy::unwrap_used)]

mod bar;
#[path = "../common/beside.rs"]
mod beside;
mod block;
mod nothing;
mod turning;

#[path = "../common/mod.rs"]
mod common;
