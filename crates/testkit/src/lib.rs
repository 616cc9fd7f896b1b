//! Shared by the tests of several crates: unstructured meshes, their images under motions and
//! renumbering, strategies that draw them, and a symmetric impact.
//!
//! Structured meshes hide errors: all stars are alike, diagonals line up with waves and
//! boundaries with axes. Everything here is the same on every run for the same arguments.

mod delaunay;
mod image;
mod random;
mod roof;
mod shape;
pub mod strategy;

pub use delaunay::{disc, random_rectangle};
pub use image::{Renumbering, mirrored, renumbered, rotated, translated, upside_down};
pub use random::Random;
pub use roof::Roof;
pub use shape::smallest_angle;

use percute_core::mesh::MeshError;

/// The cause of a failure to create a mesh.
#[derive(Debug)]
pub enum TestkitError {
    /// An argument out of range.
    Argument(&'static str),
    /// The triangulation failed.
    Triangulation(spade::InsertionError),
    /// The core refused the mesh.
    Mesh(MeshError),
    /// No seed tried gave a mesh without small angles (degrees).
    SmallAngles(f64),
}

impl std::fmt::Display for TestkitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Argument(what) => f.write_str(what),
            Self::Triangulation(cause) => write!(f, "the triangulation failed: {cause}"),
            Self::Mesh(cause) => write!(f, "the mesh was refused: {cause}"),
            Self::SmallAngles(best) => write!(f, "the best mesh has an angle of {best} degrees"),
        }
    }
}

impl std::error::Error for TestkitError {}

impl From<MeshError> for TestkitError {
    fn from(cause: MeshError) -> Self {
        Self::Mesh(cause)
    }
}

impl From<spade::InsertionError> for TestkitError {
    fn from(cause: spade::InsertionError) -> Self {
        Self::Triangulation(cause)
    }
}
