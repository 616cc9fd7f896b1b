//! The critical time step Δt_c = 2/ω_max, eq. \[34\].

use super::Stiffness;
use crate::ids::ElementId;
use crate::material::{Law, LinearLaw};
use crate::problem::Problem;
use crate::simplex::Shape;
use nalgebra::{DMatrix, SymmetricEigen};

/// Lanczos stops when the residual bounds ω²_max to this relative precision …
const PRECISION: f64 = 1e-9;
/// … or after this many vectors.
const MOST_VECTORS: usize = 320;

/// Δt_c (s) from the element-wise bound on ω_max: cheap, never above the true value.
#[must_use]
pub fn element_time_step<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    2.0 / element_bound(problem).sqrt()
}

/// Δt_c (s) from the largest eigenvalue of M⁻¹K by a matrix-free Lanczos iteration.
///
/// The Ritz value approaches ω²_max from below; its residual is added and the element-wise bound
/// caps the sum. At least 10 ln n vectors are used: with a random start the expected relative
/// error of the Ritz value is then below 0.103 (ln n/(k−1))² ≈ 1e-3 for any spectrum
/// (Kuczyński and Woźniakowski, 1992), half of it for ω, and in practice far smaller.
#[must_use]
pub fn critical_time_step<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    let stiffness = Stiffness::new(problem);
    let bound = element_bound(problem);
    2.0 / largest_eigenvalue(problem, &stiffness).min(bound).sqrt()
}

/// Largest ω² of any element alone with its lumped mass (1/s²): a bound on that of the mesh.
///
/// The eigenvalues of an element are those of Cᴷ Q Cᴷ on strains, Cᴷ the root of the law and Q = Σ∇φ_i ∇φ_iᵀ. In 2D, with
/// the strains 1, diag(1, −1) and the shear over √2, they are those of a matrix of two rows and one more, which is not the
/// largest: m = ½ tr Q and r, half the difference of the eigenvalues of Q, couple volume and shear.
fn element_bound<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    let shape = problem.mesh().simplex().shape();
    let of_element = |element: ElementId| {
        let (material, gradients) = (problem.material(element), problem.mesh().cell_geometry(element).gradients);
        let q = |a: usize, b: usize| gradients.iter().map(|g| g[a] * g[b]).sum::<f64>();
        let (lambda, shear) = material.moduli();
        let largest = match shape {
            Shape::Bar => (lambda + 2.0 * shear) * q(0, 0),
            Shape::Triangle => {
                let (m, r) = (0.5 * (q(0, 0) + q(1, 1)), (0.5 * (q(0, 0) - q(1, 1))).hypot(q(0, 1)));
                let (volume, deviator) = (2.0 * (lambda + shear), 2.0 * shear);
                let coupling = 4.0 * volume * deviator * r * r;
                0.5 * (m * (volume + deviator) + (m * m * (volume - deviator).powi(2) + coupling).sqrt())
            }
        };
        largest * N as f64 / material.density()
    };
    (0..problem.mesh().element_count()).map(ElementId::new).map(of_element).fold(0.0, f64::max)
}

/// The largest Ritz value plus its residual.
fn largest_eigenvalue<const D: usize, const N: usize>(problem: &Problem<D, N>, stiffness: &Stiffness<D, N>) -> f64 {
    let count = D * problem.mesh().node_count() - problem.prescribed().len();
    let root: Vec<f64> = problem.mass().iter().map(|m| 1.0 / m.sqrt()).collect();
    let fewest = (10.0 * (count as f64).ln()).ceil() as usize;

    let mut previous = vec![[0.0; D]; problem.mesh().node_count()];
    let mut current = random_start(problem);
    let (mut alphas, mut betas): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut check = 8;
    loop {
        let mut next = apply(problem, stiffness, &root, &current);
        let alpha = inner(&next, &current);
        let beta_before = betas.last().copied().unwrap_or(0.0);
        for ((next, current), previous) in next.iter_mut().zip(&current).zip(&previous) {
            (0..D).for_each(|c| next[c] -= alpha * current[c] + beta_before * previous[c]);
        }
        let beta = inner(&next, &next).sqrt();
        alphas.push(alpha);
        betas.push(beta);

        let k = alphas.len();
        let last = k >= MOST_VECTORS || k >= count || beta <= 1e-14 * alpha.abs();
        if last || k >= check {
            let (value, residual) = largest_ritz_value(&alphas, &betas);
            if last || (residual <= PRECISION * value && k >= fewest) {
                return value + residual;
            }
            check = k + (k / 2).max(8);
        }
        next.iter_mut().flatten().for_each(|x| *x /= beta);
        previous = std::mem::replace(&mut current, next);
    }
}

/// M^−½ K M^−½ x on the free components.
fn apply<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    stiffness: &Stiffness<D, N>,
    root: &[f64],
    x: &[[f64; D]],
) -> Vec<[f64; D]> {
    let scaled: Vec<[f64; D]> = x.iter().zip(root).map(|(x, r)| x.map(|v| v * r)).collect();
    let mut y = vec![[0.0; D]; x.len()];
    stiffness.subtract_internal_forces(&scaled, &mut y);
    for (y, r) in y.iter_mut().zip(root) {
        (0..D).for_each(|c| y[c] *= -r);
    }
    problem.prescribed().iter().for_each(|p| y[p.node.index()][p.component] = 0.0);
    y
}

/// A unit vector without structure that is the same in every run (Knuth's MMIX generator).
fn random_start<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<[f64; D]> {
    let mut state = 1_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut x: Vec<[f64; D]> = (0..problem.mesh().node_count()).map(|_| std::array::from_fn(|_| draw())).collect();
    problem.prescribed().iter().for_each(|p| x[p.node.index()][p.component] = 0.0);
    let norm = inner(&x, &x).sqrt();
    x.iter_mut().flatten().for_each(|x| *x /= norm);
    x
}

fn inner<const D: usize>(x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
    x.iter().flatten().zip(y.iter().flatten()).map(|(a, b)| a * b).sum()
}

/// Largest eigenvalue of the tridiagonal matrix, and the residual β_k|s_k| of its Ritz vector.
fn largest_ritz_value(alphas: &[f64], betas: &[f64]) -> (f64, f64) {
    let k = alphas.len();
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => alphas[i],
        1 => betas[i.min(j)],
        _ => 0.0,
    };
    let eigen = SymmetricEigen::new(DMatrix::from_fn(k, k, entry));
    let (largest, value) = eigen.eigenvalues.argmax();
    (value, betas[k - 1] * eigen.eigenvectors[(k - 1, largest)].abs())
}
