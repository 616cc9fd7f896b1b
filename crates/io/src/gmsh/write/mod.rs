//! Writes meshes for Gmsh, restored bit by bit on reading.

mod parts;
mod sink;
mod v2;
mod v4;

use super::error::{GmshCause, GmshError};
use super::header::Version;
use crate::create::{Overwrite, whole};
use parts::Parts;
use percute_core::mesh::Mesh;
use sink::Sink;
use std::path::Path;

/// Options for writing a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshFormat {
    /// Version of MSH.
    pub version: Version,
    /// Whether numbers are binary instead of text.
    pub binary: bool,
}

/// Writes a mesh in metres, completely or not at all. [`super::read`] restores the same mesh, bit by bit. Tags of nodes
/// and elements are their numbers plus 1. Elements of the same groups form one part of the geometry.
///
/// # Errors
/// A file that cannot be created or exists already, group names that the format does not allow.
pub fn write(path: &Path, overwrite: Overwrite, mesh: &Mesh, format: MeshFormat) -> Result<(), GmshError> {
    let failed = |cause| GmshError { path: path.to_path_buf(), place: None, cause };
    let groups = mesh.face_groups().keys().chain(mesh.element_groups().keys());
    for name in groups {
        if name.contains('"') || name.chars().any(char::is_control) {
            return Err(failed(GmshCause::Name { name: name.clone() }));
        }
    }
    whole(path, overwrite, &bytes(mesh, format)).map_err(|cause| failed(cause.into()))
}

/// The bytes of the file.
fn bytes(mesh: &Mesh, format: MeshFormat) -> Vec<u8> {
    let (mut out, parts) = (Sink::new(format.binary), Parts::of(mesh));
    let version = if format.version == Version::V22 { "2.2" } else { "4.1" };
    out.line("$MeshFormat");
    out.line(&format!("{version} {} 8", u8::from(format.binary)));
    if format.binary {
        out.int(1);
        out.line("");
    }
    out.line("$EndMeshFormat");
    if !parts.names.is_empty() {
        out.line("$PhysicalNames");
        out.line(&parts.names.len().to_string());
        parts.names.iter().for_each(|(dimension, tag, name)| out.line(&format!("{dimension} {tag} \"{name}\"")));
        out.line("$EndPhysicalNames");
    }
    match format.version {
        Version::V22 => v2::write(&mut out, mesh, &parts),
        Version::V41 => v4::write(&mut out, mesh, &parts),
    }
    out.bytes()
}
