//! Meshes of Gmsh: its own files in all formats, files written here, and files that are wrong.

mod common;
mod damage;
mod formats;
mod layouts;
mod refusals;
mod round_trip;
