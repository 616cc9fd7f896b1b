//! Properties that every estimate has: admissible fields, defined edge cases, symmetries, the same
//! bits for all threads and windows, and sums that agree.

mod anything;
mod automatic;
mod bodies;
mod chatter;
mod consistency;
mod corners;
mod determinism;
mod edges;
pub(crate) mod estimating;
mod half;
mod loads;
mod malformed;
mod maps;
mod non_matching;
mod pairs;
mod relative;
mod several;
mod shapes;
mod sources;
mod supplied;
mod symmetries;
