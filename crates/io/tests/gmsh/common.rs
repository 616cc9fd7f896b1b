//! Files to read, and meshes to compare.

use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::mesh::Mesh;
use percute_io::gmsh::{GmshError, MeshFile, parse};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

pub(crate) const FORMATS: [&str; 4] = ["4.1", "4.1-binary", "2.2", "2.2-binary"];

/// Two triangles of two surfaces, a named edge of each kind, and a node that nobody uses.
pub(crate) const SQUARE: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 \"foot\"
2 5 \"lower\"
2 6 \"upper\"
$EndPhysicalNames
$Entities
0 1 2 0
1 0 0 0 1 0 0 1 1 0
1 0 0 0 1 1 0 1 5 0
2 0 0 0 1 1 0 1 6 0
$EndEntities
$Nodes
1 5 2 30
2 1 0 5
2
30
4
9
6
0 0 0
1 0 0
1 1 0
0 1 0
7 7 7
$EndNodes
$Elements
3 3 10 90
1 1 1 1
10 30 2
2 1 2 1
90 2 30 4
2 2 2 1
50 2 9 4
$EndElements
";

/// A committed file.
pub(crate) fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gmsh/files").join(name)
}

/// Reads bytes as the file `a.msh`.
pub(crate) fn of_bytes(bytes: &[u8]) -> Result<MeshFile, GmshError> {
    parse("a.msh".as_ref(), bytes, 1.0)
}

/// A file of triangles.
pub(crate) fn plane(file: MeshFile) -> MeshFile {
    assert_eq!(file.mesh.dimension(), 2, "triangles were to be read");
    file
}

/// A file of bars.
pub(crate) fn bar(file: MeshFile) -> MeshFile {
    assert_eq!(file.mesh.dimension(), 1, "bars were to be read");
    file
}

/// Everything of a mesh but its numbers: elements and faces by the bits of their corners, in an order of their own.
#[derive(Debug, PartialEq)]
pub(crate) struct Shape {
    cells: BTreeSet<Vec<Vec<u64>>>,
    groups: Vec<(String, BTreeSet<Vec<Vec<u64>>>)>,
}

impl Shape {
    /// Of coordinates that `of` may round.
    pub(crate) fn of(mesh: &Mesh, of: fn(f64) -> f64) -> Self {
        let bits = |node: NodeId| mesh.point(node).iter().map(|&x| of(x).to_bits()).collect::<Vec<_>>();
        let cell = |cell: ElementId| {
            let mut corners: Vec<_> = mesh.cell(cell).iter().map(|node| bits(*node)).collect();
            let first = (0..corners.len()).min_by_key(|&k| corners[k].clone()).unwrap();
            corners.rotate_left(first);
            corners
        };
        let face = |face: FaceId| {
            let mut corners: Vec<_> = mesh.face(face).nodes.iter().map(|node| bits(*node)).collect();
            corners.sort();
            corners
        };
        let faces = mesh.face_groups().iter();
        let faces = faces.map(|(name, all)| (format!("faces {name}"), all.iter().map(|f| face(*f)).collect()));
        let elements = mesh.element_groups().iter();
        let elements = elements.map(|(name, all)| (format!("cells {name}"), all.iter().map(|e| cell(*e)).collect()));
        Self { cells: mesh.elements().map(cell).collect(), groups: faces.chain(elements).collect() }
    }
}

/// The same bits in everything that a mesh is.
pub(crate) fn assert_same(a: &Mesh, b: &Mesh) {
    let bits = |mesh: &Mesh| mesh.points().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b));
    assert!(a.cell_rows() == b.cell_rows());
    assert_eq!(a.face_groups(), b.face_groups());
    assert_eq!(a.element_groups(), b.element_groups());
}

/// Area of a group of elements.
pub(crate) fn area(mesh: &Mesh, group: &str) -> f64 {
    mesh.element_groups()[group].iter().map(|&element| mesh.geometry::<2, 3>(element).volume).sum()
}
