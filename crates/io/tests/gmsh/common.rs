//! Files to read, and meshes to compare.

use percute_core::mesh::{AnyMesh, BarMesh, Mesh, TriangleMesh};
use percute_io::gmsh::{GmshError, MeshFile, parse};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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

/// A mesh of one dimension that was read, with the tags of the file.
pub(crate) struct Read<M> {
    pub(crate) mesh: Arc<M>,
    pub(crate) node_tags: Vec<u64>,
    pub(crate) element_tags: Vec<u64>,
}

pub(crate) fn plane(file: MeshFile) -> Read<TriangleMesh> {
    let MeshFile { mesh, node_tags, element_tags } = file;
    let AnyMesh::D2(mesh) = mesh else { panic!("triangles were to be read") };
    Read { mesh, node_tags, element_tags }
}

pub(crate) fn bar(file: MeshFile) -> Read<BarMesh> {
    let MeshFile { mesh, node_tags, element_tags } = file;
    let AnyMesh::D1(mesh) = mesh else { panic!("bars were to be read") };
    Read { mesh, node_tags, element_tags }
}

/// Everything of a mesh but its numbers: elements and facets by the bits of their corners, in an order of their own.
#[derive(Debug, PartialEq)]
pub(crate) struct Shape {
    cells: BTreeSet<Vec<Vec<u64>>>,
    groups: Vec<(String, BTreeSet<Vec<Vec<u64>>>)>,
}

impl Shape {
    /// Of coordinates that `of` may round.
    pub(crate) fn of<const D: usize, const N: usize>(mesh: &Mesh<D, N>, of: fn(f64) -> f64) -> Self {
        let bits = |node: usize| mesh.points()[node].iter().map(|&x| of(x).to_bits()).collect::<Vec<_>>();
        let cell = |cell: usize| {
            let mut corners: Vec<_> = mesh.cells()[cell].iter().map(|node| bits(node.index())).collect();
            let first = (0..N).min_by_key(|&k| corners[k].clone()).unwrap();
            corners.rotate_left(first);
            corners
        };
        let facet = |facet: usize| {
            let mut corners: Vec<_> = mesh.facets()[facet].nodes.iter().map(|node| bits(node.index())).collect();
            corners.sort();
            corners
        };
        let facets = mesh.facet_groups().iter();
        let facets =
            facets.map(|(name, all)| (format!("facets {name}"), all.iter().map(|f| facet(f.index())).collect()));
        let elements = mesh.element_groups().iter();
        let elements =
            elements.map(|(name, all)| (format!("cells {name}"), all.iter().map(|e| cell(e.index())).collect()));
        Self { cells: (0..mesh.element_count()).map(cell).collect(), groups: facets.chain(elements).collect() }
    }
}

/// The same bits in everything that a mesh is.
pub(crate) fn assert_same<const D: usize, const N: usize>(a: &Mesh<D, N>, b: &Mesh<D, N>) {
    let bits = |mesh: &Mesh<D, N>| mesh.points().iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>();
    assert_eq!(bits(a), bits(b));
    assert_eq!(a.cells(), b.cells());
    assert_eq!(a.facet_groups(), b.facet_groups());
    assert_eq!(a.element_groups(), b.element_groups());
}

/// Area of a group of elements.
pub(crate) fn area(mesh: &TriangleMesh, group: &str) -> f64 {
    mesh.element_groups()[group].iter().map(|&element| mesh.cell_geometry(element).volume).sum()
}
