//! Properties that every estimate has: admissible fields, defined edge cases, symmetries, the same
//! bits for all threads and windows, and sums that agree.

// What helpers unwrap makes a test fail too; the general allowance covers test functions only.
#![allow(clippy::unwrap_used)]

mod anything;
mod automatic;
#[path = "../common/beside.rs"]
mod beside;
mod bodies;
mod chatter;
mod consistency;
#[path = "../common/corner.rs"]
mod corner;
mod corners;
mod determinism;
mod edges;
mod estimating;
mod given;
mod half;
mod loads;
mod malformed;
mod maps;
mod pairs;
mod several;
mod shapes;
mod sliding;
mod sources;
mod symmetries;
