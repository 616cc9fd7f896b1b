//! Every way in which a mesh or a problem can be refused, with the numbers that the error names.

// What helpers unwrap makes a test fail too; the general allowance covers test functions only.
#![allow(clippy::unwrap_used)]

mod mesh;
mod parts;
mod problem;
mod time;
