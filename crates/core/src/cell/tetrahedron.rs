//! The tetrahedron of four nodes.

use super::{Cell, CellKind, Child, Tetrahedron};
use std::f64::consts::PI;

/// b − a.
fn side(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| b[c] - a[c])
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The six edges, by their nodes.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

impl Cell<3, 4> for Tetrahedron {
    fn kind(&self) -> CellKind {
        CellKind::Tetrahedron
    }

    fn signed_volume(&self, points: &[[f64; 3]; 4]) -> f64 {
        let [a, b, c] = [1, 2, 3].map(|k| side(&points[0], &points[k]));
        dot(&a, &cross(&b, &c)) / 6.0
    }

    /// The vector product of two edges of the opposite face, over six times the volume.
    fn gradient(&self, points: &[[f64; 3]; 4], volume: f64, k: usize) -> [f64; 3] {
        let [b, c] = [k % 3 + 1, (k + 1) % 3 + 1].map(|other| side(&points[0], &points[other]));
        cross(&b, &c).map(|x| x / (6.0 * volume))
    }

    /// The normals of all faces, and the products of each edge of one with each edge of the other.
    fn separating_directions(&self, a: &[[f64; 3]; 4], b: &[[f64; 3]; 4]) -> Vec<[f64; 3]> {
        let edges = |t: &[[f64; 3]; 4]| EDGES.map(|[i, j]| side(&t[i], &t[j]));
        let (of_a, of_b) = (edges(a), edges(b));
        let faces = |of: &[[f64; 3]; 6]| [[0, 1], [0, 2], [1, 2], [3, 4]].map(|[i, j]| cross(&of[i], &of[j]));
        let products = of_a.iter().flat_map(|p| of_b.iter().map(move |q| cross(p, q)));
        // Edges that are parallel have none.
        faces(&of_a).into_iter().chain(faces(&of_b)).chain(products).filter(|n| *n != [0.0; 3]).collect()
    }

    /// No order goes around a node of a solid.
    fn faces_around(&self) -> [[Option<usize>; 2]; 4] {
        [[None; 2]; 4]
    }

    fn angle_around(&self, points: &[[f64; 3]; 4], nodes: &[usize]) -> f64 {
        match *nodes {
            // A. van Oosterom and J. Strackee, The solid angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983).
            [k] => {
                let [a, b, c] = [1, 2, 3].map(|i| side(&points[k], &points[(k + i) % 4]));
                let [x, y, z] = [&a, &b, &c].map(|side| dot(side, side).sqrt());
                let below = x * y * z + dot(&a, &b) * z + dot(&a, &c) * y + dot(&b, &c) * x;
                2.0 * dot(&a, &cross(&b, &c)).abs().atan2(below)
            }
            // On the edge of two nodes: twice the angle between the faces there.
            [j, k] => {
                let along = side(&points[j], &points[k]);
                let mut others =
                    (0..4).filter(|i| *i != j && *i != k).map(|i| cross(&along, &side(&points[j], &points[i])));
                let (a, b) = (others.next().unwrap_or(along), others.next().unwrap_or(along));
                let normal = cross(&a, &b);
                2.0 * dot(&normal, &normal).sqrt().atan2(dot(&a, &b))
            }
            [_, _, _] => 2.0 * PI,
            _ => 4.0 * PI,
        }
    }

    /// J. Bey, Tetrahedral grid refinement, Computing 55 (1995) 355–378: the octahedron in the middle is cut along the
    /// line between the middles of the edges 0–2 and 1–3. Parts of parts then have three shapes at the most. Two nodes
    /// of a part are exchanged where it would have the wrong orientation: 0 and 2, which keeps both pairs of edges.
    fn children(&self) -> &'static [Child<4>] {
        &[
            [[0, 0], [0, 1], [0, 2], [0, 3]],
            [[0, 1], [1, 1], [1, 2], [1, 3]],
            [[0, 2], [1, 2], [2, 2], [2, 3]],
            [[0, 3], [1, 3], [2, 3], [3, 3]],
            [[0, 1], [0, 2], [0, 3], [1, 3]],
            [[1, 2], [0, 2], [0, 1], [1, 3]],
            [[0, 2], [0, 3], [1, 3], [2, 3]],
            [[1, 3], [1, 2], [0, 2], [2, 3]],
        ]
    }

    fn face_children(&self) -> &'static [Child<3>] {
        &[[[0, 0], [0, 1], [0, 2]], [[0, 1], [1, 1], [1, 2]], [[0, 2], [1, 2], [2, 2]], [[0, 1], [0, 2], [1, 2]]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_testkit::Random;

    fn random(random: &mut Random) -> [[f64; 3]; 4] {
        let mut points: [[f64; 3]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)));
        if (Tetrahedron {}).signed_volume(&points) < 0.0 {
            points.swap(2, 3);
        }
        points
    }

    fn middle(points: &[[f64; 3]; 4], [i, j]: [usize; 2]) -> [f64; 3] {
        std::array::from_fn(|c| 0.5 * (points[i][c] + points[j][c]))
    }

    /// ∇φ of a linear field, and the divergence theorem: areas along the outward normals close.
    #[test]
    fn geometry_of_random_tetrahedra() {
        let mut numbers = Random::new(1);
        for _ in 0..50 {
            let points = random(&mut numbers);
            let cell = (Tetrahedron {}).geometry(&points);
            let field = |p: &[f64; 3]| 3.0 + 2.0 * p[0] - 5.0 * p[1] + 0.5 * p[2];
            // Rounding of quotients by a small volume.
            let tolerance = 1e-14 / cell.volume;
            for (c, expected) in [2.0, -5.0, 0.5].into_iter().enumerate() {
                let slope: f64 = (0..4).map(|i| field(&points[i]) * cell.gradients[i][c]).sum();
                assert!((slope - expected).abs() < tolerance, "{slope} against {expected}");
            }
            for k in 0..4 {
                let (normal, area) = cell.face_normal(k);
                let [a, b, c] = [1, 2, 3].map(|i| points[(k + i) % 4]);
                let twice = cross(&side(&a, &b), &side(&a, &c));
                assert!((area - 0.5 * dot(&twice, &twice).sqrt()).abs() < tolerance);
                assert!(dot(&normal, &side(&points[k], &a)) > 0.0);
            }
        }
    }

    /// The parts have the orientation of the whole and an eighth of its volume, and fill it: their outer faces are
    /// those of its faces, and each other face has two of them.
    #[test]
    fn parts_fill_the_whole() {
        let mut numbers = Random::new(2);
        let points = random(&mut numbers);
        let cell = Tetrahedron {};
        let mut faces: Vec<Vec<[usize; 2]>> = Vec::new();
        for child in cell.children() {
            let part = child.map(|pair| middle(&points, pair));
            assert!((cell.signed_volume(&part) / cell.signed_volume(&points) - 0.125).abs() < 1e-13, "{child:?}");
            for k in 0..4 {
                let mut face: Vec<_> = (0..4).filter(|i| *i != k).map(|i| child[i]).collect();
                face.sort_unstable();
                faces.push(face);
            }
        }
        faces.sort();
        let single = faces.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0].clone());
        let mut expected: Vec<Vec<[usize; 2]>> = Vec::new();
        for k in 0..4 {
            let nodes: Vec<usize> = (0..4).filter(|i| *i != k).collect();
            expected.extend(cell.face_children().iter().map(|child| {
                let mut face: Vec<_> = child.iter().map(|[i, j]| [nodes[*i], nodes[*j]]).collect();
                face.sort_unstable();
                face
            }));
        }
        expected.sort();
        assert_eq!(single.collect::<Vec<_>>(), expected);
    }

    /// Cut three times, the parts have three shapes at the most: six edges over the root of the volume, in order.
    #[test]
    fn parts_of_parts_have_few_shapes() {
        let mut numbers = Random::new(3);
        let mut parts = vec![random(&mut numbers)];
        for _ in 0..3 {
            let cut = |points: &[[f64; 3]; 4]| {
                (Tetrahedron {})
                    .children()
                    .iter()
                    .map(|child| child.map(|pair| middle(points, pair)))
                    .collect::<Vec<_>>()
            };
            parts = parts.iter().flat_map(cut).collect();
        }
        let shape = |points: &[[f64; 3]; 4]| {
            let scale = (Tetrahedron {}).signed_volume(points).cbrt();
            let mut edges = EDGES.map(|[i, j]| side(&points[i], &points[j])).map(|e| dot(&e, &e).sqrt() / scale);
            edges.sort_by(f64::total_cmp);
            edges.map(|edge| (1e9 * edge).round() as i64)
        };
        let mut shapes: Vec<_> = parts.iter().map(shape).collect();
        shapes.sort_unstable();
        shapes.dedup_by(|a, b| a.iter().zip(b.iter()).all(|(a, b)| (*a - *b).abs() < 1000));
        assert!(shapes.len() <= 3, "{shapes:?}");
    }
}
