//! The stress of a triangle: the reference macro-element, mapped, with least complementary energy.

use super::piecewise::PiecewiseStress;
use super::reference::{
    ALL, COEFFICIENTS, FREE, LOADS, OUTER, PAIRS, Reference, at, barycentric_gradients, corners, edge_normal,
    inner_edge, load_share, quadratic_gradients,
};
use super::{Loading, StressResiduals};
use crate::residual::worse;
use nalgebra::{Matrix2, Matrix3};
use percute_core::material::LinearLaw;

/// The map of one triangle.
#[derive(Clone, Debug)]
pub(crate) struct TriangleStress {
    points: [[f64; 2]; 3],
    /// B⁻¹, which takes tractions to the reference triangle.
    inverse: Matrix2<f64>,
    /// J = 2|E|.
    jacobian: f64,
    /// Energy as a quadratic form of the reference loads.
    energy: [[f64; LOADS]; LOADS],
    /// The free stresses that each load brings about.
    free: [[f64; LOADS]; FREE],
}

impl TriangleStress {
    pub(crate) fn new(points: &[[f64; 2]; 3], law: &impl LinearLaw) -> Self {
        let map = Matrix2::from_fn(|c, k| points[k + 1][c] - points[0][c]);
        // Elements are not degenerate.
        let (jacobian, inverse) = (map.determinant(), map.try_inverse().unwrap_or_else(Matrix2::zeros));
        let form = reference_compliance(&map, law.compliance::<2>());
        let mut all = [[0.0; ALL]; ALL];
        let reference = Reference::get();
        for (gram, (a, b)) in reference.gram.iter().zip(PAIRS) {
            let weight = 0.5 / jacobian * form[a][b];
            for (row, entries) in all.iter_mut().zip(gram) {
                for (sum, entry) in row.iter_mut().zip(entries) {
                    *sum += weight * entry;
                }
            }
        }
        let (energy, free) = eliminate(&all);
        Self { points: *points, inverse, jacobian, energy, free }
    }

    /// The loads on the reference triangle.
    #[inline(always)]
    fn pull_back<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [f64; LOADS] {
        pull_back(&self.inverse, self.jacobian, loading)
    }

    /// ½∫σ : K⁻¹ σ (J per unit of thickness).
    #[cfg(test)]
    pub(crate) fn energy<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> f64 {
        let loads = self.pull_back(loading);
        // Column by column: the inner loop has no sum to wait for.
        let mut product = [0.0; LOADS];
        for (column, load) in self.energy.iter().zip(&loads) {
            for (sum, entry) in product.iter_mut().zip(column) {
                *sum += entry * load;
            }
        }
        product.iter().zip(&loads).map(|(a, b)| a * b).sum()
    }

    /// 2Q l for the tractions among the loads l, taken back to the real triangle.
    pub(crate) fn traction_slope<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [[[f64; D]; D]; N] {
        let loads = self.pull_back(loading);
        let mut product = [0.0; LOADS];
        for (column, load) in self.energy.iter().zip(&loads) {
            for (sum, entry) in product.iter_mut().zip(column) {
                *sum += 2.0 * entry * load;
            }
        }
        push_forward(&self.inverse, |k| product[k])
    }

    /// Stress (11, 22, 12) at the nodes of the sub-triangles, on the real triangle.
    fn stress<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [f64; COEFFICIENTS] {
        let loads = self.pull_back(loading);
        let free: [f64; FREE] = self.free.map(|row| row.iter().zip(&loads).map(|(a, b)| a * b).sum());
        let mut stress = [0.0; COEFFICIENTS];
        for (shape, load) in Reference::get().basis.iter().zip(loads.iter().chain(&free)) {
            for (sum, entry) in stress.iter_mut().zip(shape) {
                *sum += entry * load;
            }
        }
        let edge = |k: usize, c: usize| self.points[k][c] - self.points[0][c];
        let (b11, b12, b21, b22) = (edge(1, 0), edge(2, 0), edge(1, 1), edge(2, 1));
        let scale = 1.0 / self.jacobian;
        for s in stress.chunks_exact_mut(3) {
            let (x, y, z) = (scale * s[0], scale * s[1], scale * s[2]);
            s[0] = b11 * b11 * x + b12 * b12 * y + 2.0 * b11 * b12 * z;
            s[1] = b21 * b21 * x + b22 * b22 * y + 2.0 * b21 * b22 * z;
            s[2] = b11 * b21 * x + b12 * b22 * y + (b11 * b22 + b12 * b21) * z;
        }
        stress
    }

    /// The stress that balances a loading, with the triangles on which it is quadratic.
    pub(crate) fn piecewise<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> PiecewiseStress {
        let parts = std::array::from_fn(|sub| corners(sub, &self.points, self.centroid()));
        PiecewiseStress { parts, values: self.stress(loading) }
    }

    /// Mean of (11, 22, 12): a quadratic integrates to the mean of its values in the middles of the
    /// sides, and the sub-triangles are of one size.
    pub(crate) fn mean<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [f64; 3] {
        let stress = self.stress(loading);
        let middles = |c: usize| (0..3).flat_map(move |sub| (3..6).map(move |node| at(sub, node, c)));
        std::array::from_fn(|c| middles(c).map(|k| stress[k]).sum::<f64>() / 9.0)
    }

    pub(crate) fn residuals<const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        self.residuals_of(&self.stress(loading), loading, floor)
    }

    fn residuals_of<const D: usize, const N: usize>(
        &self,
        stress: &[f64; COEFFICIENTS],
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        let largest = stress.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        StressResiduals {
            divergence: self.divergence_residual(stress, largest, loading, floor),
            edges: self.edge_residual(stress, largest, loading, floor),
            inner: self.inner_residual(stress, largest, floor),
        }
    }

    fn centroid(&self) -> [f64; 2] {
        let mean = |c: usize| (self.points[0][c] + self.points[1][c] + self.points[2][c]) / 3.0;
        [mean(0), mean(1)]
    }

    /// div σ − (Γ_DA − f_d) at the corners of the sub-triangles: it is linear on each.
    fn divergence_residual<const D: usize, const N: usize>(
        &self,
        stress: &[f64; COEFFICIENTS],
        largest: f64,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> f64 {
        let (mut miss, mut scale) = (0.0_f64, 0.0_f64);
        for sub in 0..3 {
            let barycentric = barycentric_gradients(&corners(sub, &self.points, self.centroid()));
            let steepest = barycentric.iter().flatten().fold(0.0_f64, |m, g| m.max(g.abs()));
            scale = scale.max(steepest * largest.max(floor / self.jacobian.sqrt()));
            for corner in 0..3 {
                let mut balance = [0.0; 2];
                for (node, g) in quadratic_gradients(corner, &barycentric).iter().enumerate() {
                    let s = |c: usize| stress[at(sub, node, c)];
                    balance[0] += s(0) * g[0] + s(2) * g[1];
                    balance[1] += s(2) * g[0] + s(1) * g[1];
                }
                for (c, balance) in balance.iter_mut().enumerate() {
                    for (i, volume) in loading.volume.iter().enumerate() {
                        *balance -= load_share(sub, corner, i) * volume[c];
                        scale = scale.max(volume[c].abs());
                    }
                    miss = worse(miss, balance.abs());
                }
            }
        }
        miss / scale.max(f64::MIN_POSITIVE)
    }

    /// |e|(σn − F̂) at both ends and the middle of each edge.
    fn edge_residual<const D: usize, const N: usize>(
        &self,
        stress: &[f64; COEFFICIENTS],
        largest: f64,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> f64 {
        let (mut miss, mut scale) = (0.0_f64, floor);
        for sub in 0..3 {
            let [a, b, _] = corners(sub, &self.points, self.centroid());
            let normal = edge_normal(a, b);
            let traction = &loading.traction[sub];
            scale = scale.max(largest * normal[0].abs().max(normal[1].abs()));
            for (node, weight) in OUTER.into_iter().zip([0.0, 1.0, 0.5]) {
                let found = traction_at(stress, sub, node, normal);
                for c in 0..2 {
                    let wanted = (1.0 - weight) * traction[0][c] + weight * traction[1][c];
                    miss = worse(miss, (found[c] - wanted).abs());
                    scale = scale.max(wanted.abs());
                }
            }
        }
        miss / scale.max(f64::MIN_POSITIVE)
    }

    /// Jumps of |e|σn at the nodes of the inner edges.
    fn inner_residual(&self, stress: &[f64; COEFFICIENTS], largest: f64, floor: f64) -> f64 {
        let (mut miss, mut scale) = (0.0_f64, floor);
        for k in 0..3 {
            let normal = edge_normal(self.points[k], self.centroid());
            scale = scale.max(largest * normal[0].abs().max(normal[1].abs()));
            let [(one, nodes), (other, others)] = inner_edge(k);
            for (node, opposite) in nodes.into_iter().zip(others) {
                let here = traction_at(stress, one, node, normal);
                let there = traction_at(stress, other, opposite, normal);
                miss = worse(worse(miss, (here[0] - there[0]).abs()), (here[1] - there[1]).abs());
            }
        }
        miss / scale.max(f64::MIN_POSITIVE)
    }
}

/// The loads on the reference triangle; `inverse` is B⁻¹, `jacobian` J.
fn pull_back<const D: usize, const N: usize>(
    inverse: &Matrix2<f64>,
    jacobian: f64,
    loading: &Loading<D, N>,
) -> [f64; LOADS] {
    let [[xx, xy], [yx, yy]] = [0, 1].map(|c| [inverse[(c, 0)], inverse[(c, 1)]]);
    let own = |v: &[f64; D]| [v[0] * xx + v[1] * xy, v[0] * yx + v[1] * yy];
    let scaled = |v: &[f64; D]| own(v).map(|v| v * jacobian);
    let Loading { traction: t, volume: g } = loading;
    let [[a, b], [c, d], [e, f]] =
        [[own(&t[0][0]), own(&t[0][1])], [own(&t[1][0]), own(&t[1][1])], [own(&t[2][0]), own(&t[2][1])]];
    let [p, q, r] = [scaled(&g[0]), scaled(&g[1]), scaled(&g[2])];
    [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1], e[0], e[1], f[0], f[1], p[0], p[1], q[0], q[1], r[0], r[1]]
}

/// The slope in the tractions of the real triangle, from that in each load on the reference triangle.
fn push_forward<const D: usize, const N: usize>(
    inverse: &Matrix2<f64>,
    slope: impl Fn(usize) -> f64,
) -> [[[f64; D]; D]; N] {
    let [[xx, xy], [yx, yy]] = [0, 1].map(|c| [inverse[(0, c)], inverse[(1, c)]]);
    let own = |at: usize| {
        let (x, y) = (slope(at), slope(at + 1));
        let both = [x * xx + y * xy, x * yx + y * yy];
        std::array::from_fn(|c| both[c])
    };
    let all = [[own(0), own(2)], [own(4), own(6)], [own(8), own(10)]];
    std::array::from_fn(|k| std::array::from_fn(|p| all[k][p]))
}

/// σ n at a node of a sub-triangle.
fn traction_at(stress: &[f64; COEFFICIENTS], sub: usize, node: usize, normal: [f64; 2]) -> [f64; 2] {
    let s = |c: usize| stress[at(sub, node, c)];
    [s(0) * normal[0] + s(2) * normal[1], s(2) * normal[0] + s(1) * normal[1]]
}

/// The energy form α σ:σ − β (tr σ)² of σ = B σ̂ Bᵀ in the components of σ̂; with C = BᵀB it is
/// α tr(Cσ̂Cσ̂) − β (C:σ̂)².
pub(super) fn reference_compliance(map: &Matrix2<f64>, (alpha, beta): (f64, f64)) -> [[f64; 3]; 3] {
    let metric = |i: usize, j: usize| map[(0, i)] * map[(0, j)] + map[(1, i)] * map[(1, j)];
    let (c11, c22, c12) = (metric(0, 0), metric(1, 1), metric(0, 1));
    let trace = [c11, c22, 2.0 * c12];
    let square = [
        [c11 * c11, c12 * c12, 2.0 * c11 * c12],
        [c12 * c12, c22 * c22, 2.0 * c12 * c22],
        [2.0 * c11 * c12, 2.0 * c12 * c22, 2.0 * (c12 * c12 + c11 * c22)],
    ];
    std::array::from_fn(|i| std::array::from_fn(|j| alpha * square[i][j] - beta * trace[i] * trace[j]))
}

/// Minimises the energy over the free stresses: the form of the loads alone, and the free stresses
/// as a map of the loads.
fn eliminate(all: &[[f64; ALL]; ALL]) -> ([[f64; LOADS]; LOADS], [[f64; LOADS]; FREE]) {
    let free_form = Matrix3::from_fn(|i, j| all[LOADS + i][LOADS + j]);
    let inverse = free_form.try_inverse().unwrap_or_else(Matrix3::zeros);
    let mut free = [[0.0; LOADS]; FREE];
    for i in 0..FREE {
        for k in 0..FREE {
            for j in 0..LOADS {
                free[i][j] -= inverse[(i, k)] * all[LOADS + k][j];
            }
        }
    }
    let mut energy = [[0.0; LOADS]; LOADS];
    for (i, row) in energy.iter_mut().enumerate() {
        row.copy_from_slice(&all[i][..LOADS]);
        for k in 0..FREE {
            for j in 0..LOADS {
                row[j] += all[i][LOADS + k] * free[k][j];
            }
        }
    }
    (energy, free)
}

#[cfg(test)]
mod tests;
