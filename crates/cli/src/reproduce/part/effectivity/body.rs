//! The bodies, on coarse meshes that are refined by cutting each triangle into four.

use super::Failure;
use percute_core::mesh::TriangleMesh;
use percute_io::gmsh::{MeshFile, parse};
use std::path::Path;

/// A body; the blocks are 50 × 40 mm, as in the paper's §7.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Body {
    /// A block in 5×4 cells, each cut in two.
    Structured,
    /// A block in unstructured triangles of 10 mm.
    Unstructured,
    /// A block whose lower corners are arcs of four edges with a radius of 10 mm, unstructured.
    Rounded,
    /// A disc with a radius of 25 mm whose outline has 24 edges. Refined, it stays that polygon, so that all meshes are of one body.
    Disc,
}

impl Body {
    /// The mesh after a number of refinements.
    pub(crate) fn mesh(self, refinements: usize) -> Result<TriangleMesh, Failure> {
        let mut mesh = match self {
            // The same triangles as by refinement, in rows, which a sweep over millions of them feels.
            Self::Structured => return Ok(TriangleMesh::rectangle(0.05, 0.04, 5 << refinements, 4 << refinements)?),
            Self::Unstructured => embedded("unstructured.msh", include_bytes!("unstructured.msh"))?,
            Self::Rounded => embedded("rounded.msh", include_bytes!("rounded.msh"))?,
            Self::Disc => TriangleMesh::disc(0.025, 4)?,
        };
        for _ in 0..refinements {
            mesh = mesh.refined()?;
        }
        Ok(mesh)
    }
}

/// A mesh file that is a part of the program.
fn embedded(name: &str, bytes: &[u8]) -> Result<TriangleMesh, Failure> {
    match parse(Path::new(name), bytes, 1.0)? {
        MeshFile::Plane(file) => Ok(file.mesh),
        MeshFile::Bar(_) => Err(format!("{name} is no mesh of triangles").into()),
    }
}
