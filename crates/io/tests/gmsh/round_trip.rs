//! What is written is read again, bit by bit.

use crate::gmsh::common::*;
use percute_core::mesh::{ElementGroups, FaceGroups, Mesh};
use percute_io::gmsh::{GmshCause, MeshFile, MeshFormat, Version, read, write};
use percute_io::{FileCause, Overwrite};
use percute_testkit::{random_rectangle, rotated};
use proptest::prelude::*;

fn formats() -> impl Iterator<Item = MeshFormat> {
    [Version::V22, Version::V41]
        .into_iter()
        .flat_map(|version| [false, true].map(|binary| MeshFormat { version, binary }))
}

fn again(mesh: impl Into<Mesh>, format: MeshFormat) -> MeshFile {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.msh");
    write(&path, Overwrite::Refuse, &mesh.into(), format).unwrap();
    read(&path, 1.0).unwrap()
}

/// The same mesh with groups of elements that overlap, one of them empty, and groups of edges that share some.
fn grouped(mesh: &Mesh) -> Mesh {
    let count = mesh.element_count();
    let elements = ElementGroups::from([
        ("all".to_string(), (0..count).collect()),
        ("every third".to_string(), (0..count).step_by(3).collect()),
        ("none".to_string(), vec![]),
        ("3".to_string(), vec![count - 1]),
    ]);
    let boundary: Vec<_> = mesh.boundary().map(|f| mesh.face_nodes::<2>(f).map(|node| node.index())).collect();
    let faces = FaceGroups::from([
        ("all".to_string(), boundary.clone()),
        ("a = b, µ".to_string(), boundary.into_iter().step_by(2).collect()),
        ("nothing".to_string(), vec![]),
    ]);
    let cells: Vec<_> = mesh.nodes_of::<3>().iter().map(|cell| cell.map(|node| node.index())).collect();
    Mesh::new(mesh.points_in::<2>().to_vec(), &cells, &faces, &elements).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn triangles_come_back_bit_by_bit(seed in 0_u64..1000, angle in 0.0..6.0) {
        let mesh = grouped(&rotated(&random_rectangle(0.05, 0.04, 5, seed).unwrap(), angle).unwrap());
        for format in formats() {
            let read = plane(again(mesh.clone(), format));
            assert_same(&read.mesh, &mesh);
            prop_assert_eq!(read.mesh.reoriented_elements(), 0);
        }
    }
}

#[test]
fn extreme_coordinates_come_back_bit_by_bit() {
    let points = vec![[-0.0, f64::MIN_POSITIVE], [0.1 + 0.2, 5e-324], [1.0 / 3.0, 1e3]];
    let mesh = Mesh::new(points, &[[0, 1, 2]], &FaceGroups::new(), &ElementGroups::new()).unwrap();
    formats().for_each(|format| assert_same(&plane(again(mesh.clone(), format)).mesh, &mesh));
}

#[test]
fn bars_come_back_bit_by_bit() {
    let cells: Vec<_> = (0..7).map(|e| [e, e + 1]).collect();
    let points = (0..8).map(|i| [0.3 + 0.1 * f64::from(i)]).collect();
    let faces = FaceGroups::from([("ends".to_string(), vec![[0], [7]]), ("end".to_string(), vec![[7]])]);
    let elements = ElementGroups::from([("left".to_string(), vec![0, 1, 2])]);
    let mesh = Mesh::new(points, &cells, &faces, &elements).unwrap();
    formats().for_each(|format| assert_same(&bar(again(mesh.clone(), format)).mesh, &mesh));
}

#[test]
fn no_file_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.msh");
    let [one, two] = [1, 2].map(|n| Mesh::rectangle(1.0, 1.0, n, n).unwrap());
    write(&path, Overwrite::Refuse, &one, MeshFormat::default()).unwrap();
    let error = write(&path, Overwrite::Refuse, &two, MeshFormat::default()).unwrap_err();
    assert!(matches!(error.cause, GmshCause::File(FileCause::Exists)), "{error}");
    assert_eq!(plane(read(&path, 1.0).unwrap()).mesh.element_count(), 2);
    write(&path, Overwrite::Replace, &two, MeshFormat::default()).unwrap();
    assert_eq!(plane(read(&path, 1.0).unwrap()).mesh.element_count(), 8);
    let elsewhere = folder.path().join("nowhere/a.msh");
    assert!(write(&elsewhere, Overwrite::Refuse, &one, MeshFormat::default()).is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "something was left behind");
}

#[test]
fn names_that_the_format_cannot_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a \"b\"", "a\nb"] {
        let groups = FaceGroups::from([(name.to_string(), vec![[0]])]);
        let mesh = Mesh::new(vec![[0.0], [1.0]], &[[0, 1]], &groups, &ElementGroups::new()).unwrap();
        let error = write(&folder.path().join("a.msh"), Overwrite::Refuse, &mesh, MeshFormat::default()).unwrap_err();
        assert!(error.to_string().contains("no quotes and no line breaks"), "{error}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
