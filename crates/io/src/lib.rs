//! Files: meshes of Gmsh, and histories and estimates in temporal VTKHDF, which ParaView opens as it is and h5py reads and
//! writes. The layouts are described in `docs/history.md` and `docs/estimate.md`.
//!
//! A history file holds the mesh, the steps, and the statement of the problem as text in the language of
//! the case files; this crate stores that text and gives it back, but does not read it.

mod create;
mod error;
pub mod estimate_file;
pub mod gmsh;
mod held;
pub mod history;
mod kind;
mod library;
mod mesh;
mod names;
mod read;
mod steps;
mod write;

pub use create::Overwrite;
pub use error::{FileCause, FileError};
pub use kind::{Kind, kind};
pub use library::hdf5_version;
pub use read::is_hdf5;
pub use write::{Case, Provenance};
