//! Meshes in files of [Gmsh](https://gmsh.info): MSH 4.1 and 2.2, as texts and binary.
//!
//! Nodes and elements may have any numbering, and sections any order. Other sections are skipped. `docs/mesh.md`
//! describes the groups of the mesh and the refused files.

mod assemble;
mod cursor;
mod error;
mod faces;
mod groups;
mod header;
mod import_warnings;
mod kind;
mod names;
mod nodes;
mod outline;
mod raw;
mod sections;
mod size_field;
mod v2;
mod v4;
mod write;

pub use error::{FilePlace, GmshCause, GmshError};
pub use header::Version;
pub use kind::ElementKind;
pub use outline::outline;
pub use size_field::write_sizes;
pub use write::{MeshFormat, write};

use crate::error::FileCause;
use cursor::{Cursor, Form};
use percute_core::memory::can_be_had;
use percute_core::mesh::Mesh;
use std::io::ErrorKind;
use std::ops::RangeInclusive;
use std::path::Path;

/// Range of metres per unit of length: wider than for any body, and far from overflow of squared lengths.
const SCALES: RangeInclusive<f64> = 1e-12..=1e12;

/// Bytes of memory for each byte of a file beside the file, before the mesh itself asks for memory: with it, 5.2 to 7.9
/// were measured.
const RAW: u64 = 8;

/// A mesh from a file: of lines along x, of triangles in a plane z = const, or of tetrahedra. Its import warnings list
/// omitted parts.
#[derive(Clone, Debug)]
pub struct MeshFile {
    /// The mesh: nodes and elements in the order of their tags in the file.
    pub mesh: Mesh,
    /// The tag of each node in the file.
    pub node_tags: Vec<u64>,
    /// The tag of each element in the file.
    pub element_tags: Vec<u64>,
}

/// Reads a mesh. `scale` is metres per unit of length in the file, from 1e-12 to 1e12: 1e-3 for millimetres.
///
/// # Errors
/// A file that cannot be read or is not such a mesh, with the line or byte and the remedy in Gmsh.
pub fn read(path: &Path, scale: f64) -> Result<MeshFile, GmshError> {
    let whole = |cause: GmshCause| GmshError { path: path.to_path_buf(), place: None, cause };
    let bytes = bytes(path).map_err(|cause| whole(cause.into()))?;
    parse(path, &bytes, scale)
}

/// Reads a mesh from the bytes of a file, named `path` in errors.
///
/// # Errors
/// As for [`read`].
pub fn parse(path: &Path, bytes: &[u8], scale: f64) -> Result<MeshFile, GmshError> {
    if !SCALES.contains(&scale) {
        return Err(GmshError { path: path.to_path_buf(), place: None, cause: GmshCause::Scale { value: scale } });
    }
    let needed = RAW * bytes.len() as u64;
    if !can_be_had(needed) {
        return Err(GmshError { path: path.to_path_buf(), place: None, cause: GmshCause::NoMemory { needed } });
    }
    let mut cursor = Cursor::new(bytes);
    let mesh = sections::read(&mut cursor, path).and_then(|raw| assemble::mesh(raw, scale));
    let text = cursor.form == Form::Text;
    mesh.map_err(|fault| fault.of(path, bytes, text))
}

fn bytes(path: &Path) -> Result<Vec<u8>, FileCause> {
    let cause = |source: std::io::Error| match source.kind() {
        ErrorKind::NotFound => FileCause::Missing,
        _ => FileCause::Read { source },
    };
    // A device or a pipe might never end.
    if !std::fs::metadata(path).map_err(cause)?.is_file() {
        return Err(FileCause::NotAFile);
    }
    std::fs::read(path).map_err(cause)
}
