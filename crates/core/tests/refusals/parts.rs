//! Parts of a mesh that touch or overlap without common nodes, and parts that are apart.

use percute_core::mesh::{ElementGroups, FaceGroups, Mesh, MeshError};
use proptest::prelude::*;

type Body = (Vec<[f64; 2]>, Vec<[usize; 3]>);

fn rectangle(x: [f64; 2], y: [f64; 2], nx: usize, ny: usize) -> Body {
    let mesh = Mesh::rectangle(x[1] - x[0], y[1] - y[0], nx, ny).unwrap();
    let points = mesh.points_in::<2>().iter().map(|p| [x[0] + p[0], y[0] + p[1]]).collect();
    (points, mesh.nodes_of::<3>().iter().map(|cell| cell.map(|n| n.index())).collect())
}

/// The bodies in one mesh, one after the other.
fn together(bodies: &[Body]) -> Result<Mesh, MeshError> {
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for (places, elements) in bodies {
        cells.extend(elements.iter().map(|cell| cell.map(|n| n + points.len())));
        points.extend(places);
    }
    Mesh::new(points, &cells, &FaceGroups::new(), &ElementGroups::new())
}

/// Refused in either order, by one element of each; the elements of `a` come first.
fn refused(a: &Body, b: &Body) -> [usize; 2] {
    let pair = |first: &Body, second: &Body| {
        let MeshError::PartsTouch { elements } = together(&[first.clone(), second.clone()]).unwrap_err() else {
            panic!("refused for another reason");
        };
        assert!(elements[0] < first.1.len() && elements[1] >= first.1.len(), "{elements:?}");
        elements
    };
    pair(b, a);
    pair(a, b)
}

#[test]
fn a_common_side_without_a_common_node() {
    refused(&rectangle([0.0, 1.0], [0.0, 1.0], 4, 4), &rectangle([1.0, 2.0], [0.13, 0.63], 4, 2));
}

#[test]
fn squares_that_overlap() {
    let square = rectangle([0.0, 1.0], [0.0, 1.0], 5, 5);
    refused(&square, &rectangle([0.53, 1.53], [0.07, 1.07], 5, 5));
    // A cross: no corner of one lies in the other.
    refused(&rectangle([0.0, 3.0], [1.0, 2.0], 1, 1), &rectangle([1.1, 1.9], [0.0, 3.0], 1, 1));
}

/// Deep inside, in a single element, and across several.
#[test]
fn a_part_inside_another() {
    let large = rectangle([0.0, 1.0], [0.0, 1.0], 10, 10);
    refused(&large, &rectangle([0.57, 0.58], [0.51, 0.52], 3, 3));
    refused(&large, &rectangle([0.33, 0.69], [0.31, 0.77], 1, 1));
}

/// A corner in the middle of a side, and one that is beside it by rounding only.
#[test]
fn a_corner_on_a_side() {
    let square = rectangle([0.0, 1.0], [0.0, 1.0], 3, 3);
    for tip in [1.0, 1.0 + 1e-15, 1.0 - 1e-15] {
        refused(&square, &(vec![[tip, 0.5], [2.0, 0.2], [2.0, 0.9]], vec![[0, 1, 2]]));
    }
}

/// The bound is 1e-10 of the size, as for nodes.
#[test]
fn a_small_gap_is_a_gap() {
    let square = rectangle([0.0, 1.0], [0.0, 1.0], 3, 3);
    let beside = |gap: f64| rectangle([1.0 + gap, 2.0 + gap], [0.13, 0.63], 3, 2);
    let mesh = together(&[square.clone(), beside(1e-8), rectangle([5.0, 6.0], [-9.0, -8.0], 1, 1)]).unwrap();
    assert_eq!(mesh.parts(), 3);
    refused(&square, &beside(1e-12));
    assert_eq!(together(&[square]).unwrap().parts(), 1);
}

/// Bounding boxes overlap, a hole is no part of a body, and needles point at each other.
#[test]
fn parts_that_are_apart_are_accepted() {
    let (points, cells) = rectangle([0.0, 3.0], [0.0, 3.0], 3, 3);
    let ring = |cell: &[usize; 3]| {
        let centre = |c: usize| cell.iter().map(|&n| points[n][c]).sum::<f64>() / 3.0;
        !(1.0..2.0).contains(&centre(0)) || !(1.0..2.0).contains(&centre(1))
    };
    let ring = (points.clone(), cells.iter().copied().filter(ring).collect::<Vec<_>>());
    assert_eq!(ring.1.len(), 16);
    assert_eq!(together(&[ring.clone(), rectangle([1.01, 1.99], [1.01, 1.99], 7, 7)]).unwrap().parts(), 2);
    refused(&ring, &rectangle([1.01, 2.01], [1.01, 1.99], 7, 7));
    let lower = (vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[0, 1, 2]]);
    let upper = (vec![[1.0, 0.01], [1.0, 1.0], [0.01, 1.0]], vec![[0, 1, 2]]);
    assert_eq!(together(&[lower, upper]).unwrap().parts(), 2);
    let needle = |tip: f64, end: f64| (vec![[tip, 0.0], [end, -1e-8], [end, 1e-8]], vec![[0, 1, 2]]);
    assert_eq!(together(&[needle(-1e-4, -1.0), needle(1e-4, 1.0)]).unwrap().parts(), 2);
}

#[test]
fn bars() {
    let bars = |points: &[f64], cells: &[[usize; 2]]| {
        let points = points.iter().map(|&x| [x]).collect();
        Mesh::new(points, cells, &FaceGroups::new(), &ElementGroups::new())
    };
    let touch = |elements| MeshError::PartsTouch { elements };
    // The second inside the first; across its end; a third that covers both.
    assert_eq!(bars(&[0.0, 3.0, 1.0, 2.0], &[[0, 1], [2, 3]]).unwrap_err(), touch([0, 1]));
    assert_eq!(bars(&[0.0, 1.0, 2.0, 1.5, 3.0], &[[0, 1], [1, 2], [3, 4]]).unwrap_err(), touch([1, 2]));
    assert!(bars(&[0.0, 1.0, 2.0, 3.0, -1.0, 4.0], &[[0, 1], [2, 3], [4, 5]]).is_err());
    assert_eq!(bars(&[0.0, 1.0, 2.0, 3.0, 1.1, 1.9], &[[0, 1], [2, 3], [5, 4]]).unwrap().parts(), 3);
    assert_eq!(bars(&[0.0, 1.0, 2.0, 3.0, 4.0], &[[4, 3], [1, 0], [2, 3], [1, 2]]).unwrap().parts(), 1);
}

type Corners = [[i64; 2]; 3];

/// Twice the signed area, exact.
fn turn(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// Whether a point lies in a closed triangle.
fn inside(p: [i64; 2], t: &Corners) -> bool {
    let turns = [0, 1, 2].map(|k| turn(t[k], t[(k + 1) % 3], p));
    turns.iter().all(|&x| x >= 0) || turns.iter().all(|&x| x <= 0)
}

/// Whether two edges cross at an inner point of both.
fn cross(a: [[i64; 2]; 2], b: [[i64; 2]; 2]) -> bool {
    let splits =
        |p: [[i64; 2]; 2], q: [[i64; 2]; 2]| turn(p[0], p[1], q[0]).signum() * turn(p[0], p[1], q[1]).signum() < 0;
    splits(a, b) && splits(b, a)
}

fn intersect(a: &Corners, b: &Corners) -> bool {
    let edges = |t: &Corners| [0, 1, 2].map(|k| [t[k], t[(k + 1) % 3]]);
    a.iter().any(|&p| inside(p, b))
        || b.iter().any(|&p| inside(p, a))
        || edges(a).iter().any(|&e| edges(b).iter().any(|&f| cross(e, f)))
}

/// Triangles of very different sizes with whole coordinates.
fn triangle() -> impl Strategy<Value = Corners> {
    let shape = prop_oneof![6 => Just(5_i64), 1 => Just(40)];
    ([-40..40_i64, -40..40_i64], shape)
        .prop_flat_map(|(at, reach)| {
            proptest::array::uniform3([0..reach, 0..reach]).prop_map(move |t| t.map(|p| [at[0] + p[0], at[1] + p[1]]))
        })
        .prop_filter("degenerate", |t| turn(t[0], t[1], t[2]) != 0)
}

proptest! {
    /// Against every pair, in whole numbers.
    #[test]
    fn agrees_with_every_pair(triangles in proptest::collection::vec(triangle(), 2..12)) {
        let mut corners: Vec<_> = triangles.concat();
        corners.sort_unstable();
        corners.dedup();
        prop_assume!(corners.len() == 3 * triangles.len());
        let points = |t: &[[i64; 2]; 3]| t.map(|p| p.map(|x| x as f64)).to_vec();
        let bodies: Vec<Body> = triangles.iter().map(|t| (points(t), vec![[0, 1, 2]])).collect();
        let meet = |i: usize, j: usize| intersect(&triangles[i], &triangles[j]);
        let expected = (0..triangles.len()).any(|j| (0..j).any(|i| meet(i, j)));
        match together(&bodies) {
            Ok(mesh) => prop_assert!(!expected && mesh.parts() == triangles.len()),
            Err(MeshError::PartsTouch { elements: [i, j] }) => prop_assert!(i < j && meet(i, j)),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}
