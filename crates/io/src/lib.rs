//! Files: meshes of Gmsh, and histories and estimates in temporal VTKHDF for ParaView and h5py. `docs/history.md` and
//! `docs/estimate.md` describe the layouts.
//!
//! A history file holds the mesh, the steps, and the statement of the problem as text in the language of
//! the case files. This crate stores and returns that text, but does not parse it.

mod checksum;
mod create;
mod driver;
mod error;
pub mod estimate_file;
pub mod export;
pub mod gmsh;
pub mod history;
mod kind;
mod library;
mod lock;
mod mesh;
mod names;
mod read;
mod seal;
mod steps;
mod temporary;
mod unfinished;
mod write;

pub use create::{Overwrite, check_folder, write_bytes};
pub use error::{FileCause, FileError};
pub use kind::{Kind, is_named_pipe, is_vtkhdf_name};
pub use library::hdf5_version;
pub use read::is_hdf5;
pub use read::kind;
pub use unfinished::remove_unfinished;
pub use write::{Case, Provenance};
