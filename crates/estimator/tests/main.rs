//! The estimate against mathematics, true errors and figures of other programs.

// Clippy allows this in test functions only; what they share is a test as well.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod bar;
mod block_on_two;
mod common;
mod corner;
mod effectivity;
mod finite;
mod graded;
mod properties;
mod sliding_blocks;
mod solids;
mod table1;
mod two_blocks;
mod vibration;
mod yielding;
