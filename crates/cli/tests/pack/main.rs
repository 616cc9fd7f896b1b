//! The pack of exact and published cases: each quantity converges at the rate that theory predicts, and is as near as it should be.

// What helpers unwrap makes a test fail too; the general allowance covers test functions only.
#![allow(clippy::unwrap_used)]

mod bars;
mod blocks;
mod rows;
mod vibrations;
