//! The mesh of a plan by the program Gmsh.

use crate::failure::Failure;
use crate::message::{counted, short};
use crate::plan::{Basis, Plan, SizeField};
use percute_core::mesh::Mesh;
use percute_io::{Overwrite, gmsh};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

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

/// Bodies of a geometry and of the first mesh have areas that agree to this, relative: a disc in twelve sides lacks
/// 4.5 % of its area.
const SAME_BODY: f64 = 0.05;
/// Gmsh is stopped after so long (s): meshes within the limit of an adaptation take seconds.
const LONGEST: u64 = 120;

/// Makes sure that Gmsh can be started, and that it has its geometry.
///
/// # Errors
/// It cannot, there is no such file, or a scale that is none.
pub(super) fn check(geometry: &Geometry) -> Result<(), Failure> {
    if let Geometry::File(file, scale) = geometry {
        if !file.is_file() {
            return Err(Failure::Argument(format!("`geometry`: there is no file {}", file.display())));
        }
        if !(*scale > 0.0 && scale.is_finite()) {
            let told = format!("`scale` is {scale}; give metres per unit of length in the geometry, such as 1e-3");
            return Err(Failure::Argument(told));
        }
    }
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
pub(super) fn meshed(
    first: &Mesh,
    geometry: &Geometry,
    run: &Mesh,
    (basis, plan): (&Basis, &Plan),
    most: usize,
) -> Result<Mesh, Failure> {
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
    let mesh = read.mesh;
    if mesh.dimension() != first.dimension() {
        return Err(failed("the geometry is not that of a body of this dimension".into()));
    }
    let [made, stated] = [&mesh, first].map(|mesh| mesh.volumes().iter().sum::<f64>());
    if (made - stated).abs() > SAME_BODY * stated || mesh.parts() != first.parts() {
        return Err(failed(format!(
            "the geometry has an area of {} m² and {}, the first mesh {} m² and {}: is it the same body, and `scale` \
             its unit of length?",
            short(made, 3),
            counted(mesh.parts(), "body"),
            short(stated, 3),
            counted(first.parts(), "body")
        )));
    }
    Ok(mesh)
}

fn run_gmsh(geometry: &Path, sizes: &Path, mesh: &Path) -> Result<(), Failure> {
    let mut command = Command::new(PROGRAM);
    command.arg(geometry).args(["-2", "-nt", "1", "-v", "2", "-format", "msh41", "-bin"]);
    command.arg("-bgm").arg(sizes).arg("-o").arg(mesh).stdin(Stdio::null());
    OPTIONS.iter().for_each(|(name, value)| _ = command.args(["-setnumber", name, value]));
    let started = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = started.map_err(|error| Failure::Argument(format!("gmsh cannot be started: {error}")))?;
    let begun = Instant::now();
    while child.try_wait().is_ok_and(|ended| ended.is_none()) {
        if begun.elapsed().as_secs() > LONGEST {
            // One that has just ended needs no end.
            let _ = child.kill();
            let told = format!("gmsh took more than {LONGEST} s: is `scale` the unit of length of the geometry?");
            return Err(Failure::Argument(told));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    let output = child.wait_with_output().map_err(|error| Failure::Argument(format!("gmsh: {error}")))?;
    if output.status.success() && mesh.exists() {
        return Ok(());
    }
    let told = String::from_utf8_lossy(&[output.stderr, output.stdout].concat()).trim().to_string();
    let told = told.lines().next().unwrap_or("no message").to_string();
    Err(Failure::Argument(format!("gmsh did not mesh {}: {told}", geometry.display())))
}
