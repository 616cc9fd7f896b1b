//! Each [`MeshError`] from a bad mesh.

use percute_core::mesh::{ElementGroups, FaceGroups, Mesh, MeshError};

fn triangles(points: &[[f64; 2]], cells: &[[usize; 3]]) -> Result<Mesh, MeshError> {
    Mesh::new(points.to_vec(), cells, &FaceGroups::new(), &ElementGroups::new())
}

fn bars(points: &[[f64; 1]], cells: &[[usize; 2]]) -> Result<Mesh, MeshError> {
    Mesh::new(points.to_vec(), cells, &FaceGroups::new(), &ElementGroups::new())
}

/// The corners of a unit square, and (2, 0).
const CORNERS: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0]];

fn square_with(faces: &[(&str, [usize; 2])], elements: &[(&str, usize)]) -> Result<Mesh, MeshError> {
    let faces = faces.iter().map(|(name, nodes)| (name.to_string(), vec![*nodes])).collect();
    let elements = elements.iter().map(|(name, element)| (name.to_string(), vec![*element])).collect();
    Mesh::new(CORNERS[..4].to_vec(), &[[0, 1, 2], [0, 2, 3]], &faces, &elements)
}

#[test]
fn empty() {
    assert_eq!(bars(&[], &[]).unwrap_err(), MeshError::Empty { nodes: 0, elements: 0 });
    assert_eq!(triangles(&CORNERS, &[]).unwrap_err(), MeshError::Empty { nodes: 5, elements: 0 });
}

#[test]
fn generators() {
    let (allowed, counts) = ("a positive length in metres", "a number of elements from 1 to 20 000 000");
    let name = |error: MeshError| match error {
        MeshError::Generator { name, value, allowed } => (name, value, allowed),
        other => panic!("{other}"),
    };
    assert_eq!(name(Mesh::uniform_bar(-2.0, 3).unwrap_err()), ("length", -2.0, allowed));
    assert_eq!(name(Mesh::rectangle(0.0, 1.0, 1, 1).unwrap_err()), ("width", 0.0, allowed));
    assert_eq!(name(Mesh::rectangle(1.0, f64::INFINITY, 1, 1).unwrap_err()), ("height", f64::INFINITY, allowed));
    assert_eq!(name(Mesh::disc(-1.0, 1).unwrap_err()), ("radius", -1.0, allowed));
    for rings in [0, 1826] {
        let (what, value, _) = name(Mesh::disc(1.0, rings).unwrap_err());
        assert_eq!((what, value), ("rings", rings as f64));
    }
    assert_eq!(name(Mesh::uniform_bar(1.0, 0).unwrap_err()).0, "elements");
    assert_eq!(name(Mesh::rectangle(1.0, 1.0, 0, 1).unwrap_err()).0, "nx");
    assert_eq!(name(Mesh::rectangle(1.0, 1.0, 1, 200_000_000).unwrap_err()), ("ny", 2e8, counts));
    let (what, value, _) = name(Mesh::rectangle(1.0, 1.0, 20_000, 20_000).unwrap_err());
    assert_eq!((what, value), ("nx * ny", 4e8));
}

#[test]
fn coordinates_that_are_not_finite() {
    let error = bars(&[[0.0], [f64::INFINITY]], &[[0, 1]]).unwrap_err();
    assert_eq!(error, MeshError::NotFinite { node: 1, value: f64::INFINITY });
    let mut points = CORNERS;
    points[3][1] = f64::NAN;
    assert!(matches!(triangles(&points, &[[0, 1, 2]]), Err(MeshError::NotFinite { node: 3, value }) if value.is_nan()));
}

#[test]
fn missing_and_unused_nodes() {
    let error = triangles(&CORNERS, &[[0, 1, 2], [0, 2, 9]]).unwrap_err();
    assert_eq!(error, MeshError::NoSuchNode { element: 1, node: 9, last: 4 });
    assert_eq!(triangles(&CORNERS, &[[0, 1, 2]]).unwrap_err(), MeshError::UnusedNodes { first: 3, count: 2 });
}

/// At 1e-12 of the size nodes are duplicates, at 1e-8 they are not: the bound is 1e-10.
#[test]
fn duplicate_nodes() {
    let split = |gap: f64| bars(&[[0.0], [1.0], [1.0 + gap], [2.0]], &[[0, 1], [2, 3], [1, 2]]);
    let MeshError::DuplicateNodes { first, second, distance } = split(1e-12).unwrap_err() else {
        panic!("not found to be duplicates");
    };
    // 1 + 1e-12 is rounded to 1e-16.
    assert_eq!((first, second), (1, 2));
    assert!((distance - 1e-12).abs() < 3e-16, "{distance}");
    assert!(split(1e-8).is_ok());
}

#[test]
fn degenerate_elements() {
    let points = [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [1.0, 1.0]];
    let error = triangles(&points, &[[0, 1, 3], [0, 1, 2]]).unwrap_err();
    let nodes = vec![0, 1, 2];
    assert_eq!(error, MeshError::Degenerate { element: 1, nodes, volume: 0.0, diameter: 3.0 });
    // The same node twice.
    let error = triangles(&CORNERS[..3], &[[0, 1, 2], [1, 1, 2]]).unwrap_err();
    assert!(matches!(error, MeshError::Degenerate { element: 1, volume: 0.0, diameter: 1.0, .. }), "{error}");
}

#[test]
fn faces_of_three_elements() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.5, 1.0], [0.5, -1.0], [0.5, 2.0]];
    let error = triangles(&points, &[[0, 1, 2], [0, 3, 1], [0, 1, 4]]).unwrap_err();
    assert_eq!(error, MeshError::NonManifoldFace { nodes: vec![0, 1], elements: vec![0, 1, 2] });
    let error = bars(&[[0.0], [1.0], [2.0], [3.0]], &[[0, 1], [1, 2], [1, 3]]).unwrap_err();
    assert_eq!(error, MeshError::NonManifoldFace { nodes: vec![1], elements: vec![0, 1, 2] });
}

/// A bow tie of two and one triangles.
#[test]
fn parts_that_hang_together_by_a_point() {
    let points = [[0.0, 0.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, 2.0]];
    let error = triangles(&points, &[[0, 2, 1], [0, 3, 4], [0, 1, 5]]).unwrap_err();
    let MeshError::NonManifoldNode { node, elements, reached } = error else { panic!("{error}") };
    assert_eq!((node, elements), (0, 3));
    assert!(reached == 1 || reached == 2, "{reached}");
}

#[test]
fn groups_of_what_is_not_there() {
    let missing = |nodes: [usize; 2]| MeshError::NoSuchFace { group: "side".to_string(), nodes: nodes.to_vec() };
    // Inside, across the other diagonal, a node too many; the order of the nodes does not matter.
    assert_eq!(square_with(&[("side", [0, 2])], &[]).unwrap_err(), missing([0, 2]));
    assert_eq!(square_with(&[("side", [1, 3])], &[]).unwrap_err(), missing([1, 3]));
    assert_eq!(square_with(&[("side", [0, 7])], &[]).unwrap_err(), missing([0, 7]));
    assert!(square_with(&[("side", [1, 0])], &[]).is_ok());
    let error = square_with(&[], &[("core", 2)]).unwrap_err();
    assert_eq!(error, MeshError::NoSuchElement { group: "core".to_string(), element: 2, last: 1 });
}

/// Wrong orientation is reoriented, counted, and changes nothing else.
#[test]
fn orientation_is_corrected() {
    let mesh = triangles(&CORNERS[..4], &[[0, 2, 1], [0, 2, 3]]).unwrap();
    assert_eq!(mesh.reoriented_elements(), 1);
    assert_eq!(mesh.nodes_of::<3>()[0].map(|n| n.index()), [0, 1, 2]);
    assert_eq!(bars(&[[1.0], [0.0]], &[[0, 1]]).unwrap().reoriented_elements(), 1);
}

/// Two elements on the same side of the face they share cover each other: the boundary between
/// them is none, and normals are wrong.
#[test]
fn elements_that_cover_each_other() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.4, 1.0], [0.6, 0.7]];
    let accepted = [
        ("two triangles above the same edge", triangles(&points, &[[0, 1, 2], [0, 1, 3]]).is_ok()),
        ("the same triangle twice", triangles(&CORNERS[..3], &[[0, 1, 2], [1, 2, 0]]).is_ok()),
        ("two bars to the right of a point", bars(&[[0.0], [1.0], [2.0]], &[[0, 1], [0, 2]]).is_ok()),
    ];
    let accepted: Vec<_> = accepted.iter().filter(|(_, ok)| *ok).map(|(what, _)| what).collect();
    assert!(accepted.is_empty(), "accepted: {accepted:?}");
}
