//! A field of element sizes as a view of Gmsh (`.pos`), for `gmsh -bgm` and background fields.

use super::{GmshCause, GmshError};
use crate::create::{Overwrite, whole};
use percute_core::mesh::Mesh;
use std::fmt::Write;
use std::path::Path;

/// Edge of a bar over its length, of an equilateral triangle over the root of its area, 2/3^(1/4), and of a regular
/// tetrahedron over the cube root of its volume, (6√2)^(1/3); with their names.
const EDGES: [(f64, char); 3] = [(1.0, 'L'), (1.519_671_371_303_185_5, 'T'), (2.039_648_902_655_505_6, 'S')];

/// Writes sizes of elements at the nodes of a mesh (m), completely or not at all: elements with the length of edges at
/// their corners. A size is the root of the area of an element, or the cube root of its volume; lengths and places are
/// in units of `scale` metres.
///
/// # Errors
/// A file that cannot be created or exists already.
pub fn write_sizes(path: &Path, overwrite: Overwrite, mesh: &Mesh, size: &[f64], scale: f64) -> Result<(), GmshError> {
    let mut text = String::from("View \"size\" {\n");
    let (edge, name) = EDGES[mesh.dimension() - 1];
    for element in mesh.elements() {
        let places = mesh.cell_points(element).into_iter().flatten().map(|x| format!("{:?}", x / scale));
        let sizes = mesh.cell(element).iter().map(|node| format!("{:?}", edge * size[node.index()] / scale));
        let [places, sizes] = [places.collect::<Vec<_>>(), sizes.collect()].map(|numbers| numbers.join(","));
        let _ = writeln!(text, "S{name}({places}){{{sizes}}};");
    }
    text.push_str("};\n");
    let failed = |cause: GmshCause| GmshError { path: path.to_path_buf(), place: None, cause };
    whole(path, overwrite, text.as_bytes()).map_err(|cause| failed(cause.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;

    /// An equilateral triangle of area A has edges 1.52 √A; millimetres.
    #[test]
    fn sizes_are_lengths_of_edges() {
        let folder = tempfile::tempdir().unwrap();
        let (file, mesh) = (folder.path().join("h.pos"), Mesh::rectangle(0.05, 0.04, 1, 1).unwrap());
        let edge: f64 = 3e-3;
        let size = (3.0_f64.sqrt() / 4.0).sqrt() * edge;
        write_sizes(&file, Overwrite::allowed(false), &mesh, &[size; 4], 1e-3).unwrap();
        let text = std::fs::read_to_string(&file).unwrap();
        let first = text.lines().nth(1).unwrap();
        assert!(first.starts_with("ST(0.0,0.0,0.0,50.0,0.0,0.0,50.0,40.0,0.0){"), "{first}");
        let sizes = first.split_once('{').unwrap().1.trim_end_matches("};");
        // Rounding.
        assert!(sizes.split(',').all(|size| (size.parse::<f64>().unwrap() - 3.0).abs() < 1e-14), "{sizes}");
        assert!(write_sizes(&file, Overwrite::allowed(false), &mesh, &[size; 4], 1e-3).is_err());
    }
}
