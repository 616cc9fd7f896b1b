//! Meshes of Gmsh: its own files in all formats, files written here, and files that are wrong.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
mod damage;
mod formats;
mod layouts;
mod refusals;
mod round_trip;
