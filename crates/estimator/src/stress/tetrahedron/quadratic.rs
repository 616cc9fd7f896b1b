//! Quadratic functions on tetrahedra, and the four sub-tetrahedra around a centroid.

/// Nodes of a quadratic tetrahedron: its corners, then the middles of its edges.
pub(super) const NODES: usize = 10;

/// The corners beside each middle.
const ENDS: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// The node between two corners, or at both.
const fn between(i: usize, j: usize) -> usize {
    match (i, j) {
        (0, 1) | (1, 0) => 4,
        (0, 2) | (2, 0) => 5,
        (0, 3) | (3, 0) => 6,
        (1, 2) | (2, 1) => 7,
        (1, 3) | (3, 1) => 8,
        (2, 3) | (3, 2) => 9,
        _ => i,
    }
}

/// The nodes of the face of three corners: these, then the middles between them.
const fn face_nodes([a, b, c]: [usize; 3]) -> [usize; 6] {
    [a, b, c, between(a, b), between(a, c), between(b, c)]
}

/// Nodes of a sub-tetrahedron on its outer face.
pub(super) const OUTER: [usize; 6] = face_nodes([0, 1, 2]);

/// Values of the linear shape functions of the corners of a face at its nodes.
pub(super) const OUTER_SHARES: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]];

/// The face between two sub-tetrahedra.
pub(super) struct InnerFace {
    /// The nodes of the tetrahedron on it; its third corner is the centroid.
    pub(super) ends: [usize; 2],
    /// Each sub-tetrahedron, and its nodes on the face.
    pub(super) sides: [(usize, [usize; 6]); 2],
}

/// The six inner faces.
pub(super) fn inner_faces() -> [InnerFace; 6] {
    ENDS.map(|ends| {
        let mut subs = (0..4).filter(|s| !ends.contains(s));
        let sides = [(); 2].map(|()| {
            let sub = subs.next().unwrap_or_default();
            // Corner p of sub-tetrahedron s is node s + 1 + p (mod 4).
            let [a, b] = ends.map(|node| (node + 3 - sub) % 4);
            (sub, face_nodes([a, b, 3]))
        });
        InnerFace { ends, sides }
    })
}

/// Corners of sub-tetrahedron `s`, whose outer face lies opposite to node `s`.
pub(super) fn corners(s: usize, vertices: &[[f64; 3]; 4], centroid: [f64; 3]) -> [[f64; 3]; 4] {
    [vertices[(s + 1) % 4], vertices[(s + 2) % 4], vertices[(s + 3) % 4], centroid]
}

/// The mean of the corners.
pub(super) fn centroid(vertices: &[[f64; 3]; 4]) -> [f64; 3] {
    std::array::from_fn(|c| 0.25 * vertices.iter().map(|v| v[c]).sum::<f64>())
}

/// A normal of a face times its area.
pub(super) fn area_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v): ([f64; 3], [f64; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
    [0.5 * (u[1] * v[2] - u[2] * v[1]), 0.5 * (u[2] * v[0] - u[0] * v[2]), 0.5 * (u[0] * v[1] - u[1] * v[0])]
}

/// Outward normal of face `k` times its area, of a tetrahedron of positive orientation. The order of the nodes of
/// the face turns with k.
pub(super) fn outward_normal(k: usize, corners: &[[f64; 3]; 4]) -> [f64; 3] {
    let normal = area_normal([corners[(k + 1) % 4], corners[(k + 2) % 4], corners[(k + 3) % 4]]);
    if k.is_multiple_of(2) { normal } else { normal.map(|n| -n) }
}

/// Gradients of the barycentric coordinates, for corners of any orientation.
pub(super) fn barycentric_gradients(corners: &[[f64; 3]; 4]) -> [[f64; 3]; 4] {
    let normals: [[f64; 3]; 4] = std::array::from_fn(|k| outward_normal(k, corners));
    // Three times the volume.
    let triple: f64 = (0..3).map(|c| normals[0][c] * (corners[1][c] - corners[0][c])).sum();
    normals.map(|normal| normal.map(|n| -n / triple))
}

/// Gradients of the ten quadratic shape functions at corner `at`.
pub(super) fn quadratic_gradients(at: usize, barycentric: &[[f64; 3]; 4]) -> [[f64; 3]; NODES] {
    let l: [f64; 4] = std::array::from_fn(|i| f64::from(u8::from(i == at)));
    let mut gradients = [[0.0; 3]; NODES];
    for c in 0..3 {
        for i in 0..4 {
            gradients[i][c] = (4.0 * l[i] - 1.0) * barycentric[i][c];
        }
        for (m, [i, j]) in ENDS.into_iter().enumerate() {
            gradients[4 + m][c] = 4.0 * (l[i] * barycentric[j][c] + l[j] * barycentric[i][c]);
        }
    }
    gradients
}

/// Mass matrix of the quadratic shape functions on a tetrahedron of volume 1.
pub(super) fn quadratic_mass() -> [[f64; NODES]; NODES] {
    let entry = |i: usize, j: usize| match (i.min(j), i.max(j)) {
        (a, b) if b < 4 => [1.0, 6.0][usize::from(a == b)],
        (a, b) if a < 4 => [-6.0, -4.0][usize::from(ENDS[b - 4].contains(&a))],
        // By the ends that two middles share.
        (a, b) => [8.0, 16.0, 32.0][ENDS[a - 4].iter().filter(|end| ENDS[b - 4].contains(end)).count()],
    };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j) / 420.0))
}

/// Value of the linear shape function of node `i` of the tetrahedron at a corner of a sub-tetrahedron.
pub(super) fn load_share(sub: usize, corner: usize, i: usize) -> f64 {
    match corner {
        3 => 0.25,
        _ if (sub + 1 + corner) % 4 == i => 1.0,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// Products of monomials of degree 2 on the reference tetrahedron: ∫x^a y^b z^c = a! b! c!/(a + b + c + 3)!.
    #[test]
    fn mass_matrix_integrates_products_of_quadratics() {
        let place = |m: usize| if m < 4 { [m, m] } else { ENDS[m - 4] };
        let point =
            |m: usize| -> [f64; 3] { std::array::from_fn(|c| place(m).iter().map(|&end| 0.5 * CORNERS[end][c]).sum()) };
        let (mass, factorials) = (quadratic_mass(), [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0]);
        let powers = [[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1], [1, 0, 0], [0, 0, 0]];
        let value = |power: &[usize; 3], m: usize| {
            let x = point(m);
            (0..3).map(|c| x[c].powi(power[c] as i32)).product::<f64>()
        };
        for p in &powers {
            for q in &powers {
                let sum: f64 =
                    (0..100).map(|k| value(p, k / 10) * mass[k / 10][k % 10] * value(q, k % 10)).sum::<f64>() / 6.0;
                let both: [usize; 3] = std::array::from_fn(|c| p[c] + q[c]);
                let exact =
                    both.iter().map(|n| factorials[*n]).product::<f64>() / factorials[both.iter().sum::<usize>() + 3];
                assert!((sum - exact).abs() < 1e-15, "{p:?} {q:?}: {sum} {exact}");
            }
        }
    }

    /// x² + 2yz has the gradient (2x, 2z, 2y), also on corners of negative orientation.
    #[test]
    fn gradients_of_a_quadratic() {
        let points = [[0.1, 0.3, -0.2], [1.2, 0.1, 0.3], [0.2, 0.9, 0.1], [0.4, 0.2, 1.1]];
        for order in [[0, 1, 2, 3], [1, 0, 2, 3]] {
            let corners = order.map(|i: usize| points[i]);
            let gradients = barycentric_gradients(&corners);
            let at = |m: usize| -> [f64; 3] {
                let [i, j] = if m < 4 { [m, m] } else { ENDS[m - 4] };
                std::array::from_fn(|c| 0.5 * (corners[i][c] + corners[j][c]))
            };
            for corner in 0..4 {
                let shape = quadratic_gradients(corner, &gradients);
                let sum = |c: usize| {
                    (0..NODES).map(|m| (at(m)[0].powi(2) + 2.0 * at(m)[1] * at(m)[2]) * shape[m][c]).sum::<f64>()
                };
                let [x, y, z] = corners[corner];
                for (c, exact) in [2.0 * x, 2.0 * z, 2.0 * y].into_iter().enumerate() {
                    assert!((sum(c) - exact).abs() < 1e-13, "{} {exact}", sum(c));
                }
            }
        }
    }
}
