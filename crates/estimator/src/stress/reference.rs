//! The macro-element on the reference triangle: stresses that are quadratic and symmetric on the
//! three sub-triangles around the centroid.
//!
//! An affine map carries them to any triangle by σ = B σ̂ Bᵀ / J, which keeps symmetry and turns
//! tractions and divergence by the same B: everything but the energy is solved here, once.

use super::conditions::solutions;
use nalgebra::DMatrix;
use std::sync::OnceLock;

/// Values of a loading: |e|F̂ on 3 edges × 2 nodes, Γ_DA − f_d at 3 nodes, two components each.
pub(crate) const LOADS: usize = 18;
/// Coefficients of a stress: 3 sub-triangles × 6 nodes × components (11, 22, 12).
pub(super) const COEFFICIENTS: usize = 54;
/// Dimension of the stresses that balance nothing.
pub(super) const FREE: usize = 3;
/// Loads and free stresses together.
pub(super) const ALL: usize = LOADS + FREE;

/// The pairs of stress components in an energy form.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Corners of the reference triangle.
const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
const CENTROID: [f64; 2] = [1.0 / 3.0, 1.0 / 3.0];

/// Quantities of the reference triangle.
#[derive(Debug)]
pub(super) struct Reference {
    /// Stress coefficients of a unit of each load, then of each free stress.
    pub(super) basis: Vec<[f64; COEFFICIENTS]>,
    /// For each pair of components, ∫ over the triangle of products of the basis.
    pub(super) gram: [[[f64; ALL]; ALL]; 6],
}

/// Corners of sub-triangle `s`, whose outer edge lies opposite to node `s`.
pub(super) fn corners(s: usize, vertices: &[[f64; 2]; 3], centroid: [f64; 2]) -> [[f64; 2]; 3] {
    [vertices[(s + 1) % 3], vertices[(s + 2) % 3], centroid]
}

/// Gradients of the barycentric coordinates.
pub(super) fn barycentric_gradients(corners: &[[f64; 2]; 3]) -> [[f64; 2]; 3] {
    let [a, b, c] = corners;
    let double = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let side = |p: &[f64; 2], q: &[f64; 2]| [(p[1] - q[1]) / double, (q[0] - p[0]) / double];
    [side(b, c), side(c, a), side(a, b)]
}

/// Gradients of the six quadratic shape functions (corners, then middles of 01, 12, 20) at corner
/// `at`.
pub(super) fn quadratic_gradients(at: usize, barycentric: &[[f64; 2]; 3]) -> [[f64; 2]; 6] {
    let l: [f64; 3] = std::array::from_fn(|i| f64::from(u8::from(i == at)));
    let mut gradients = [[0.0; 2]; 6];
    for c in 0..2 {
        for i in 0..3 {
            let j = (i + 1) % 3;
            gradients[i][c] = (4.0 * l[i] - 1.0) * barycentric[i][c];
            gradients[3 + i][c] = 4.0 * (l[i] * barycentric[j][c] + l[j] * barycentric[i][c]);
        }
    }
    gradients
}

/// Position of a coefficient.
pub(super) const fn at(sub: usize, node: usize, component: usize) -> usize {
    (sub * 6 + node) * 3 + component
}

/// Nodes on the inner edge from corner k to the centroid, seen from the two sub-triangles it joins:
/// (sub-triangle, [corner, centroid, middle]).
pub(super) const fn inner_edge(k: usize) -> [(usize, [usize; 3]); 2] {
    [((k + 2) % 3, [0, 2, 5]), ((k + 1) % 3, [1, 2, 4])]
}

/// Nodes of a sub-triangle on its outer edge: both ends and the middle.
pub(super) const OUTER: [usize; 3] = [0, 1, 3];

/// Mass matrix of the quadratic shape functions on a triangle of area 1.
pub(super) fn quadratic_mass() -> [[f64; 6]; 6] {
    let entry = |i: usize, j: usize| match (i.min(j), i.max(j)) {
        (a, b) if a == b => {
            if a < 3 {
                6.0
            } else {
                32.0
            }
        }
        (_, b) if b < 3 => -1.0,
        (a, _) if a >= 3 => 16.0,
        // A corner and the middle of the opposite side; other middles do not couple with it.
        (a, b) => {
            if (b - 3 + 2) % 3 == a {
                -4.0
            } else {
                0.0
            }
        }
    };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j) / 180.0))
}

impl Reference {
    /// The reference triangle, solved at first use.
    pub(super) fn get() -> &'static Self {
        static REFERENCE: OnceLock<Reference> = OnceLock::new();
        REFERENCE.get_or_init(Self::solve)
    }

    /// For each pair of components, ∫ of products of two combinations of the basis.
    pub(super) fn product(&self, x: &[f64; ALL], y: &[f64; ALL]) -> [f64; PAIRS.len()] {
        self.gram.each_ref().map(|gram| {
            let row = |(x, row): (&f64, &[f64; ALL])| x * row.iter().zip(y).map(|(g, y)| g * y).sum::<f64>();
            x.iter().zip(gram).map(row).sum()
        })
    }

    fn solve() -> Self {
        let (conditions, right) = equations();
        let basis = solutions::<COEFFICIENTS, FREE>(&conditions, &right);
        let gram = gram(&basis);
        Self { basis, gram }
    }
}

/// Rows of the condition that a stress has a traction: σ n at one node.
fn traction_rows(matrix: &mut DMatrix<f64>, row: usize, sub: usize, node: usize, normal: [f64; 2], sign: f64) {
    matrix[(row, at(sub, node, 0))] += sign * normal[0];
    matrix[(row, at(sub, node, 2))] += sign * normal[1];
    matrix[(row + 1, at(sub, node, 2))] += sign * normal[0];
    matrix[(row + 1, at(sub, node, 1))] += sign * normal[1];
}

/// Outward normal of an edge times its length.
pub(super) fn edge_normal(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[1] - from[1], from[0] - to[0]]
}

/// The conditions C σ̂ = R load: tractions on the outer edges, their continuity on the inner ones,
/// divergence.
fn equations() -> (DMatrix<f64>, DMatrix<f64>) {
    let mut conditions = DMatrix::zeros(COEFFICIENTS, COEFFICIENTS);
    let mut right = DMatrix::zeros(COEFFICIENTS, LOADS);
    let mut row = 0;
    for s in 0..3 {
        let [a, b, _] = corners(s, &CORNERS, CENTROID);
        for (node, shares) in OUTER.into_iter().zip([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]) {
            traction_rows(&mut conditions, row, s, node, edge_normal(a, b), 1.0);
            for (p, share) in shares.into_iter().enumerate() {
                (0..2).for_each(|c| right[(row + c, (2 * s + p) * 2 + c)] = share);
            }
            row += 2;
        }
    }
    for k in 0..3 {
        let [(one, nodes), (other, others)] = inner_edge(k);
        let normal = edge_normal(CORNERS[k], CENTROID);
        for (node, opposite) in nodes.into_iter().zip(others) {
            traction_rows(&mut conditions, row, one, node, normal, 1.0);
            traction_rows(&mut conditions, row, other, opposite, normal, -1.0);
            row += 2;
        }
    }
    for s in 0..3 {
        let barycentric = barycentric_gradients(&corners(s, &CORNERS, CENTROID));
        for corner in 0..3 {
            for (node, gradient) in quadratic_gradients(corner, &barycentric).into_iter().enumerate() {
                traction_rows(&mut conditions, row, s, node, gradient, 1.0);
            }
            for i in 0..3 {
                let share = load_share(s, corner, i);
                (0..2).for_each(|c| right[(row + c, 12 + 2 * i + c)] = share);
            }
            row += 2;
        }
    }
    (conditions, right)
}

/// Value of the linear shape function of node `i` of the triangle at a corner of a sub-triangle.
pub(super) fn load_share(sub: usize, corner: usize, i: usize) -> f64 {
    match corner {
        2 => 1.0 / 3.0,
        _ if (sub + 1 + corner) % 3 == i => 1.0,
        _ => 0.0,
    }
}

/// ∫ of products of the basis for each pair of components, symmetrised.
fn gram(basis: &[[f64; COEFFICIENTS]]) -> [[[f64; ALL]; ALL]; 6] {
    let mass = quadratic_mass();
    let mut gram = [[[0.0; ALL]; ALL]; 6];
    for (g, (a, b)) in gram.iter_mut().zip(PAIRS) {
        for (i, x) in basis.iter().enumerate() {
            for (j, y) in basis.iter().enumerate() {
                let mut sum = 0.0;
                for sub in 0..3 {
                    for m in 0..6 {
                        for n in 0..6 {
                            let product = x[at(sub, m, a)] * y[at(sub, n, b)] + x[at(sub, m, b)] * y[at(sub, n, a)];
                            sum += mass[m][n] * product / 6.0;
                        }
                    }
                }
                // Each sub-triangle has area 1/6; a pair (a, a) was counted twice.
                g[i][j] = if a == b { 0.5 * sum } else { sum };
            }
        }
    }
    gram
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::conditions::tests::free_solutions;

    #[test]
    fn three_stresses_are_free() {
        assert_eq!(free_solutions(equations().0), FREE);
    }

    #[test]
    fn mass_matrix_integrates_the_square_of_a_quadratic() {
        // x² has nodal values 0, 1, 0, ¼, ¼, 0 on the reference triangle; ∫x⁴ = 2·4!/6!·area.
        let values = [0.0, 1.0, 0.0, 0.25, 0.25, 0.0];
        let mass = quadratic_mass();
        let square: f64 =
            (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).map(|(i, j)| values[i] * mass[i][j] * values[j]).sum();
        assert!((square - 2.0 * 24.0 / 720.0).abs() < 1e-15);
    }
}
