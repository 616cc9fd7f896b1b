//! The macro-element on the reference tetrahedron: stresses that are quadratic and symmetric on the four
//! sub-tetrahedra around the centroid.
//!
//! An affine map carries them to any tetrahedron by σ = B σ̂ Bᵀ / J, which keeps symmetry and turns tractions and
//! divergence by the same B: everything but the energy is solved here, once. Every load that balances has an exact
//! stress; no finer cut is needed.

use super::quadratic::{
    NODES, OUTER, OUTER_SHARES, area_normal, barycentric_gradients, centroid, corners, inner_faces, load_share,
    outward_normal, quadratic_gradients, quadratic_mass,
};
use crate::stress::conditions::solutions;
use nalgebra::{DMatrix, Matrix3};
use percute_core::simd::lanes::Value;
use std::sync::OnceLock;

/// Components of a stress: 11, 22, 33, 23, 13 and 12.
pub(super) const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
/// Values of a loading: |f|F̂ on 4 faces × 3 nodes, Γ_DA − f_d at 4 nodes, three components each.
pub(super) const LOADS: usize = 48;
/// Coefficients of a stress: 4 sub-tetrahedra × 10 nodes × 6 components.
pub(super) const COEFFICIENTS: usize = 240;
/// Dimension of the stresses that balance nothing.
pub(super) const FREE: usize = 18;
/// Loads and free stresses together.
pub(super) const ALL: usize = LOADS + FREE;

/// The pairs of stress components in an energy form.
pub(super) const PAIRS: [(usize, usize); 21] = pairs();

/// Corners of the reference tetrahedron.
pub(super) const CORNERS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// Its volume.
pub(super) const VOLUME: f64 = 1.0 / 6.0;

/// A product of two stresses for each pair of components.
pub(super) type Products = [f64; PAIRS.len()];

/// Quantities of the reference tetrahedron.
#[derive(Debug)]
pub(super) struct ReferenceTetrahedron {
    /// Stress coefficients of a unit of each load, then of each free stress.
    pub(super) basis: Vec<[f64; COEFFICIENTS]>,
    /// ∫ of products of each free stress with the stresses of the basis.
    pub(super) free_products: Vec<[Products; ALL]>,
}

const fn pairs() -> [(usize, usize); 21] {
    let (mut pairs, mut at, mut a) = ([(0, 0); 21], 0, 0);
    while a < 6 {
        let mut b = a;
        while b < 6 {
            pairs[at] = (a, b);
            (at, b) = (at + 1, b + 1);
        }
        a += 1;
    }
    pairs
}

/// Position of a coefficient.
pub(super) const fn at(sub: usize, node: usize, component: usize) -> usize {
    (sub * NODES + node) * 6 + component
}

/// Position of a component of a stress.
pub(super) const fn component(a: usize, b: usize) -> usize {
    if a == b { a } else { 6 - a - b }
}

impl ReferenceTetrahedron {
    /// The reference tetrahedron, solved at first use.
    pub(super) fn get() -> &'static Self {
        static REFERENCE: OnceLock<ReferenceTetrahedron> = OnceLock::new();
        REFERENCE.get_or_init(Self::solve)
    }

    fn solve() -> Self {
        let (conditions, right) = equations();
        let basis = solutions::<COEFFICIENTS, FREE>(&conditions, &right);
        let row = |free: &[f64; COEFFICIENTS]| std::array::from_fn(|i| product(free, &basis[i]));
        let free_products = basis[LOADS..].iter().map(row).collect();
        Self { basis, free_products }
    }

    /// The stress of some loads and free stresses.
    pub(super) fn stress(&self, parts: &[f64; ALL]) -> [f64; COEFFICIENTS] {
        let mut stress = [0.0; COEFFICIENTS];
        for (shape, part) in self.basis.iter().zip(parts) {
            for (sum, entry) in stress.iter_mut().zip(shape) {
                *sum += entry * part;
            }
        }
        stress
    }
}

/// For each pair of components, ∫ of products of two stresses, symmetrised.
pub(super) fn product(x: &[f64; COEFFICIENTS], y: &[f64; COEFFICIENTS]) -> Products {
    let (mass, mut all) = (quadratic_mass(), [[0.0; 6]; 6]);
    for sub in 0..4 {
        for m in 0..NODES {
            let mut mean = [0.0; 6];
            for n in 0..NODES {
                (0..6).for_each(|b| mean[b] += mass[m][n] * y[at(sub, n, b)]);
            }
            for a in 0..6 {
                (0..6).for_each(|b| all[a][b] += x[at(sub, m, a)] * mean[b]);
            }
        }
    }
    pair_products(&all.map(|row| row.map(|sum| 0.25 * VOLUME * sum)))
}

/// For each pair of components, that of products of each two.
pub(super) fn pair_products(all: &[[f64; 6]; 6]) -> Products {
    PAIRS.map(|(a, b)| if a == b { all[a][a] } else { all[a][b] + all[b][a] })
}

/// The entries of a matrix, row by row.
pub(super) fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}

/// For each pair of components, the coefficients of the energy form α σ:σ − β (tr σ)² of σ = B σ̂ Bᵀ in the components
/// of σ̂; with C = BᵀB it is α tr(Cσ̂Cσ̂) − β (C:σ̂)².
#[inline(always)]
pub(super) fn reference_compliance<T: Value>(map: &[[T; 3]; 3], (alpha, beta): (T, T)) -> [T; PAIRS.len()] {
    let (mut metric, mut form) = ([[alpha; 3]; 3], [alpha; PAIRS.len()]);
    for i in 0..3 {
        for j in 0..3 {
            metric[i][j] = map[0][i] * map[0][j] + map[1][i] * map[1][j] + map[2][i] * map[2][j];
        }
    }
    for (entry, (v, w)) in form.iter_mut().zip(PAIRS) {
        let ((a, b), (c, d)) = (COMPONENTS[v], COMPONENTS[w]);
        let square = (metric[a][c] * metric[b][d] + metric[a][d] * metric[b][c]) * 0.5;
        // A component off the diagonal is there twice.
        let count = [1.0, 2.0, 4.0][usize::from(v > 2) + usize::from(w > 2)];
        *entry = (alpha * square - beta * metric[a][b] * metric[c][d]) * count;
    }
    form
}

/// Rows of the condition that a stress has a traction: σ n at one node.
fn traction_rows(matrix: &mut DMatrix<f64>, row: usize, (sub, node): (usize, usize), normal: [f64; 3], sign: f64) {
    for a in 0..3 {
        for b in 0..3 {
            matrix[(row + a, at(sub, node, component(a, b)))] += sign * normal[b];
        }
    }
}

/// The conditions C σ̂ = R load: tractions on the outer faces, their continuity on the inner ones, divergence. They are
/// 228 rows; zeros fill the square.
pub(super) fn equations() -> (DMatrix<f64>, DMatrix<f64>) {
    let mut conditions = DMatrix::zeros(COEFFICIENTS, COEFFICIENTS);
    let mut right = DMatrix::zeros(COEFFICIENTS, LOADS);
    let (mut row, middle) = (0, centroid(&CORNERS));
    for s in 0..4 {
        for (node, shares) in OUTER.into_iter().zip(OUTER_SHARES) {
            traction_rows(&mut conditions, row, (s, node), outward_normal(s, &CORNERS), 1.0);
            for (p, share) in shares.into_iter().enumerate() {
                (0..3).for_each(|c| right[(row + c, (3 * s + p) * 3 + c)] = share);
            }
            row += 3;
        }
    }
    for face in inner_faces() {
        let [a, b] = face.ends.map(|node| CORNERS[node]);
        let (normal, [(one, nodes), (other, others)]) = (area_normal([a, b, middle]), face.sides);
        for (node, opposite) in nodes.into_iter().zip(others) {
            traction_rows(&mut conditions, row, (one, node), normal, 1.0);
            traction_rows(&mut conditions, row, (other, opposite), normal, -1.0);
            row += 3;
        }
    }
    for s in 0..4 {
        let barycentric = barycentric_gradients(&corners(s, &CORNERS, middle));
        for corner in 0..4 {
            for (node, gradient) in quadratic_gradients(corner, &barycentric).into_iter().enumerate() {
                traction_rows(&mut conditions, row, (s, node), gradient, 1.0);
            }
            for i in 0..4 {
                let share = load_share(s, corner, i);
                (0..3).for_each(|c| right[(row + c, 36 + 3 * i + c)] = share);
            }
            row += 3;
        }
    }
    (conditions, right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::conditions::tests::free_solutions;

    #[test]
    fn eighteen_stresses_are_free() {
        assert_eq!(free_solutions(equations().0), FREE);
    }

    /// The energy form of B σ̂ Bᵀ, entry by entry.
    #[test]
    fn compliance_is_that_of_the_mapped_stress() {
        let map = Matrix3::new(1.1, 0.2, -0.3, 0.4, 0.9, 0.1, -0.2, 0.3, 1.3);
        let (alpha, beta): (f64, f64) = (0.7, 0.15);
        let own: [f64; 6] = [0.3, -1.1, 0.8, 0.5, -0.4, 0.9];
        let full = Matrix3::from_fn(|a, b| own[component(a, b)]);
        let stress = map * full * map.transpose();
        let expected: f64 = alpha * stress.component_mul(&stress).sum() - beta * stress.trace() * stress.trace();
        let all: [[f64; 6]; 6] = own.map(|x| own.map(|y| x * y));
        let found: f64 =
            reference_compliance(&rows(&map), (alpha, beta)).iter().zip(pair_products(&all)).map(|(a, b)| a * b).sum();
        assert!((found - expected).abs() < 1e-14 * expected.abs(), "{found} {expected}");
    }
}
