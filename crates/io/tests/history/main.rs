//! History files: what comes back, what is refused, and what a kill leaves.

mod common;
mod round_trip;
