//! The bodies, on coarse meshes that are refined by cutting each triangle into four.

use crate::reproduce::ReproduceError;
use percute_core::mesh::TriangleMesh;
use percute_io::gmsh::{MeshFile, parse};
use std::path::Path;

/// A body; the blocks are 50 × 40 mm, as in the paper's §7.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Body {
    /// A block in 5×4 cells, each cut in two.
    Structured,
    /// A block in unstructured triangles of 10 mm.
    Unstructured,
    /// A block whose lower corners are arcs of four edges with a radius of 15 mm, unstructured.
    Rounded,
    /// A disc with a radius of 25 mm whose outline has 24 edges. Refined, it stays that polygon, so that all meshes are of one body.
    Disc,
}

impl Body {
    /// The mesh after a number of refinements.
    pub(super) fn mesh(self, refinements: usize) -> Result<TriangleMesh, ReproduceError> {
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
fn embedded(name: &str, bytes: &[u8]) -> Result<TriangleMesh, ReproduceError> {
    match parse(Path::new(name), bytes, 1.0) {
        Ok(MeshFile::Plane(file)) => Ok(file.mesh),
        Ok(MeshFile::Bar(_)) => Err(ReproduceError::Unexpected(format!("{name} is no mesh of triangles"))),
        Err(error) => Err(ReproduceError::Unexpected(error.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::ids::ElementId;

    /// Blocks of 50 × 40 mm; each rounded corner lacks (1 − π/4) r² of its square and, as its arc is four chords of
    /// 22.5°, r²(π/4 − 2 sin 22.5°) more; the disc is a regular polygon of 24 sides, ½·24 r² sin 15°.
    #[test]
    fn bodies_have_their_areas() {
        let area = |body: Body, refinements| -> f64 {
            let mesh = body.mesh(refinements).unwrap();
            (0..mesh.element_count()).map(|e| mesh.cell_geometry(ElementId::new(e)).volume).sum()
        };
        let sin = |degrees: f64| degrees.to_radians().sin();
        let corner = 0.015 * 0.015 * (1.0 - 2.0 * sin(22.5));
        let exact = [
            (Body::Structured, 0.002),
            (Body::Unstructured, 0.002),
            (Body::Rounded, 0.002 - 2.0 * corner),
            (Body::Disc, 12.0 * 0.025 * 0.025 * sin(15.0)),
        ];
        for (body, exact) in exact {
            for refinements in [0, 2] {
                // The files hold 16 digits; rounding of a sum of a few thousand terms.
                let area = area(body, refinements);
                assert!((area - exact).abs() < 1e-12 * exact, "{body:?}: {area} {exact}");
            }
        }
    }
}
