//! The mesh of a plan by the program Gmsh.

use crate::failure::Failure;
use crate::plan::{Basis, Plan, SizeField};
use percute_core::mesh::Mesh;
use percute_core::simplex::ByDimension;
use percute_io::{Overwrite, gmsh};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The program.
const PROGRAM: &str = "gmsh";
/// Sizes come from the field alone, and triangles from the frontal method.
const OPTIONS: [(&str, &str); 4] = [
    ("Mesh.MeshSizeFromPoints", "0"),
    ("Mesh.MeshSizeFromCurvature", "0"),
    ("Mesh.MeshSizeExtendFromBoundary", "0"),
    ("Mesh.Algorithm", "6"),
];

/// The geometry that Gmsh meshes.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// The outline of the first mesh: polygons.
    Outline,
    /// A file (.geo, .step), with metres per unit of length in it.
    File(PathBuf, f64),
}

/// Makes sure that Gmsh can be started.
///
/// # Errors
/// It cannot.
pub(super) fn check() -> Result<(), Failure> {
    let found = Command::new(PROGRAM).arg("-version").stdin(Stdio::null()).output();
    match found {
        Ok(output) if output.status.success() => Ok(()),
        _ => Err(Failure::Argument(
            "the mesher \"gmsh\" needs the program gmsh, which cannot be started: pip install gmsh, or install it from \
             gmsh.info, and put it on the PATH"
                .to_string(),
        )),
    }
}

/// Makes the mesh of a plan for the mesh of a run.
pub(super) fn meshed<const D: usize, const N: usize>(
    first: &Mesh<D, N>,
    geometry: &Geometry,
    run: &Mesh<D, N>,
    (basis, plan): (&Basis, &Plan),
    most: usize,
) -> Result<Mesh<D, N>, Failure> {
    let field = SizeField::new(run, basis, plan, most);
    let field = field.map_err(|error| Failure::Argument(format!("the size field cannot be refined: {error}")))?;
    let failed = |what: String| Failure::Argument(format!("gmsh: {what}"));
    let folder = tempfile::tempdir().map_err(|error| failed(error.to_string()))?;
    let at = |name: &str| folder.path().join(name);
    let (file, scale) = match geometry {
        Geometry::File(file, scale) => (file.clone(), *scale),
        Geometry::Outline => {
            let text = gmsh::outline(first).ok_or_else(|| {
                failed("the outline of this mesh cannot be meshed again; give a `geometry`, or bisect the mesh".into())
            })?;
            std::fs::write(at("outline.geo"), text).map_err(|error| failed(error.to_string()))?;
            (at("outline.geo"), 1.0)
        }
    };
    let written = gmsh::write_sizes(&at("size.pos"), Overwrite::allowed(false), &field.mesh, &field.size, scale);
    written.map_err(|error| failed(error.to_string()))?;
    run_gmsh(&file, &at("size.pos"), &at("mesh.msh"))?;
    let read = gmsh::read(&at("mesh.msh"), scale).map_err(|error| failed(error.to_string()))?;
    of_dimension(read).ok_or_else(|| failed("the geometry is not that of a body of this dimension".into()))
}

fn run_gmsh(geometry: &Path, sizes: &Path, mesh: &Path) -> Result<(), Failure> {
    let mut command = Command::new(PROGRAM);
    command.arg(geometry).args(["-2", "-nt", "1", "-v", "2", "-format", "msh41", "-bin"]);
    command.arg("-bgm").arg(sizes).arg("-o").arg(mesh).stdin(Stdio::null());
    OPTIONS.iter().for_each(|(name, value)| _ = command.args(["-setnumber", name, value]));
    let output = command.output().map_err(|error| Failure::Argument(format!("gmsh cannot be started: {error}")))?;
    if output.status.success() && mesh.exists() {
        return Ok(());
    }
    let told = String::from_utf8_lossy(&[output.stderr, output.stdout].concat()).trim().to_string();
    let told = told.lines().next().unwrap_or("no message").to_string();
    Err(Failure::Argument(format!("gmsh did not mesh {}: {told}", geometry.display())))
}

/// The mesh that was read, if it has this dimension.
fn of_dimension<const D: usize, const N: usize>(read: gmsh::MeshFile) -> Option<Mesh<D, N>> {
    let mesh: Box<dyn std::any::Any> = match read {
        ByDimension::Bar(read) => Box::new(read.mesh),
        ByDimension::Plane(read) => Box::new(read.mesh),
    };
    mesh.downcast().ok().map(|mesh| *mesh)
}
