//! Free vibration in one mode, and motions without any error.

// A failure is a failed test, in helpers too.
#![allow(clippy::unwrap_used)]

mod bar;
mod block;
mod nothing;
