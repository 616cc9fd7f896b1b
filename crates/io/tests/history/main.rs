//! History files: what comes back, what is refused, and what a kill leaves.

// What helpers unwrap makes a test fail too; the general allowance covers test functions only.
#![allow(clippy::unwrap_used)]

mod common;
mod damage;
mod foreign;
mod kill;
mod places;
mod refusals;
mod resume;
mod round_trip;
