//! The critical time step Δt_c = 2/ω_max, eq. \[34\].

use super::node_update::{NodeMotion, StripSums};
use super::pass::{Fields, Pass};
use crate::cell::CellKind;
use crate::ids::ElementId;
use crate::kernel::{Kernel, ProblemKernel, on_kernel};
use crate::material::{Law, LinearLaw};
use crate::problem::Problem;

/// Lanczos stops when the residual bounds ω²_max to this relative precision …
const PRECISION: f64 = 1e-9;
/// … or after this many vectors.
const MOST_VECTORS: usize = 320;

/// Δt_c (s) from the element-wise bound on ω_max: cheap, never above the true value.
#[must_use]
pub fn element_time_step<const D: usize>(problem: &Problem<D>) -> f64 {
    2.0 / element_bound(problem).sqrt()
}

/// Δt_c (s) from the largest eigenvalue of M⁻¹K, [`critical_time_step`](super::critical_time_step).
pub(super) fn critical_time_step<const D: usize>(problem: &Problem<D>) -> f64 {
    2.0 / largest_eigenvalue(problem).min(element_bound(problem)).sqrt()
}

/// The same of one element alone with its lumped mass (s).
pub(super) fn time_step_of_element<const D: usize>(problem: &Problem<D>, element: ElementId) -> f64 {
    2.0 / largest_of_element(problem, element).sqrt()
}

/// Largest ω² of any element alone (1/s²): a bound on that of the mesh.
fn element_bound<const D: usize>(problem: &Problem<D>) -> f64 {
    let elements = (0..problem.mesh().element_count()).map(ElementId::new);
    elements.map(|element| largest_of_element(problem, element)).fold(0.0, f64::max)
}

/// Largest ω² of an element alone with its lumped mass (1/s²).
///
/// Its eigenvalues are those of Cᴷ Q Cᴷ on strains, Cᴷ the root of the law and Q = Σ∇φ_i ∇φ_iᵀ. In 2D,
/// with the strains 1, diag(1, −1) and the shear over √2, they are those of a matrix of two rows and one more, which is
/// not the largest: m = ½ tr Q and r, half the difference of the eigenvalues of Q, couple volume and shear.
fn largest_of_element<const D: usize>(problem: &Problem<D>, element: ElementId) -> f64 {
    let (material, gradients) = (problem.material(element), problem.mesh().gradients_in::<D>(element));
    let q = |a: usize, b: usize| gradients.iter().map(|g| g[a] * g[b]).sum::<f64>();
    let (lambda, shear) = material.moduli();
    let largest = match problem.mesh().kind() {
        CellKind::Bar => (lambda + 2.0 * shear) * q(0, 0),
        CellKind::Triangle => {
            let (m, r) = (0.5 * (q(0, 0) + q(1, 1)), (0.5 * (q(0, 0) - q(1, 1))).hypot(q(0, 1)));
            let (volume, deviator) = (2.0 * (lambda + shear), 2.0 * shear);
            let coupling = 4.0 * volume * deviator * r * r;
            0.5 * (m * (volume + deviator) + (m * m * (volume - deviator).powi(2) + coupling).sqrt())
        }
        CellKind::Tetrahedron => largest_in_space([lambda, shear], q),
    };
    largest * problem.mesh().nodes_of_element() as f64 / material.density()
}

/// The largest eigenvalue of Cᴷ Q Cᴷ on strains in space, at most 0.2 % above it: (tr Aⁿ)^(1/n) with n = 2¹⁰ of its
/// six eigenvalues, none of which is negative.
fn largest_in_space([lambda, shear]: [f64; 2], q: impl Fn(usize, usize) -> f64) -> f64 {
    const SQUARED: i32 = 10;
    const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];
    // Strains xx, yy, zz and √2 yz, √2 xz, √2 xy.
    let weight = |[a, b]: [usize; 2]| if a == b { 1.0 } else { 2.0_f64.sqrt() };
    let half = |a: usize, c: usize, b: usize, d: usize| if a == c { 0.25 * q(b, d) } else { 0.0 };
    let matrix: [[f64; 6]; 6] = PAIRS.map(|[a, b]| {
        PAIRS.map(|[c, d]| {
            weight([a, b])
                * weight([c, d])
                * (half(a, c, b, d) + half(a, d, b, c) + half(b, c, a, d) + half(b, d, a, c))
        })
    });
    // Cᴷ = √2G 1 + (√(2G + 3λ) − √2G)/3 on the three normal strains.
    let (of_shear, of_volume) = ((2.0 * shear).sqrt(), (2.0 * shear + 3.0 * lambda).sqrt());
    let root = |i: usize, j: usize| {
        let spherical = if i < 3 && j < 3 { (of_volume - of_shear) / 3.0 } else { 0.0 };
        spherical + if i == j { of_shear } else { 0.0 }
    };
    let product = |a: &dyn Fn(usize, usize) -> f64, b: &dyn Fn(usize, usize) -> f64| -> [[f64; 6]; 6] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a(i, k) * b(k, j)).sum()))
    };
    let right = product(&|i, j| matrix[i][j], &root);
    let mut power = product(&root, &|i, j| right[i][j]);
    let mut logarithm = 0.0;
    for n in 0..=SQUARED {
        let trace: f64 = (0..6).map(|i| power[i][i]).sum();
        logarithm += trace.ln() / f64::from(1 << n);
        power = power.map(|row| row.map(|x| x / trace));
        power = product(&|i, j| power[i][j], &|i, j| power[i][j]);
    }
    logarithm.exp()
}

/// The largest Ritz value plus its residual.
///
/// The vectors y_j = β_j q_j obey y_{j+1} = (M⁻¹K y_j − α_j y_j)/β_j − (β_j/β_{j−1}) y_{j−1}, with the products
/// α_j = y_j·K y_j/β_j² and β_j² = y_j·M y_j: one pass over the mesh for each.
fn largest_eigenvalue<const D: usize>(problem: &Problem<D>) -> f64 {
    let count = D * problem.mesh().node_count() - problem.prescribed().len();
    let fewest = (10.0 * (count as f64).ln()).ceil() as usize;
    on_kernel!(&ProblemKernel::linear(problem), stiffness => largest_of(problem, stiffness, (count, fewest)))
}

fn largest_of<K: Kernel<D>, const D: usize>(
    problem: &Problem<D>,
    stiffness: &K,
    (count, fewest): (usize, usize),
) -> f64 {
    let inverse_mass: Vec<f64> = problem.mass().iter().map(|m| 1.0 / m).collect();
    let mut sums = vec![StripSums::ZERO; stiffness.strips().count()];

    let (mut current, mut previous) = (vec![[0.0; D]; problem.mesh().node_count()], random_start(problem));
    let mut force = vec![[0.0; D]; current.len()];
    let (mut alphas, mut betas): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    // The first pass keeps the start.
    let (mut factors, mut check, mut norm) = ([0.0, 0.0, 1.0], 8, 1.0);
    loop {
        let pass = Pass {
            kernel: stiffness,
            mass: problem.mass(),
            inverse_mass: &inverse_mass,
            apart: &[],
            external: &[],
            motion: NodeMotion::Combine(factors),
            back: 0.0,
            parallel: false,
        };
        let (displacement, velocity) = (&mut previous[..], &mut current[..]);
        let (start, internal_start, force, internal) = (0, 0, &mut force[..], &mut [][..]);
        let sums = &mut sums[..];
        let total = pass.run(Fields { start, displacement, velocity, force, internal_start, internal, sums });
        problem.prescribed().iter().for_each(|p| force[p.node.index()][p.component] = 0.0);
        std::mem::swap(&mut current, &mut previous);
        let beta = (2.0 * total.kinetic()).sqrt();
        if !alphas.is_empty() {
            betas.push(beta);
            let k = alphas.len();
            let last = k >= MOST_VECTORS || k >= count || beta <= 1e-14 * alphas[k - 1].abs();
            if last || k >= check {
                let (value, part) = largest_ritz_value(&alphas, &betas[..k - 1]);
                let residual = beta * part;
                if last || (residual <= PRECISION * value && k >= fewest) {
                    return value + residual;
                }
                check = k + (k / 2).max(8);
            }
        }
        let alpha = 2.0 * total.strain() / (beta * beta);
        alphas.push(alpha);
        // The force is −K y.
        factors = [-1.0 / beta, -alpha / beta, if alphas.len() > 1 { -beta / norm } else { 0.0 }];
        norm = beta;
    }
}

/// A nodal field without structure, of values between −½ and ½ and 0 on prescribed components, that is the same in
/// every run (Knuth's MMIX generator).
#[must_use]
pub fn rough_field<const D: usize>(problem: &Problem<D>) -> Vec<[f64; D]> {
    let mut state = 1_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut x: Vec<[f64; D]> = (0..problem.mesh().node_count()).map(|_| std::array::from_fn(|_| draw())).collect();
    problem.prescribed().iter().for_each(|p| x[p.node.index()][p.component] = 0.0);
    x
}

/// A rough field of the norm 1 with the mass.
fn random_start<const D: usize>(problem: &Problem<D>) -> Vec<[f64; D]> {
    let mut x = rough_field(problem);
    let norm = x.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    for (x, mass) in x.iter_mut().zip(problem.mass()) {
        *x = x.map(|x| x / (norm * mass.sqrt()));
    }
    x
}

/// Largest eigenvalue of a tridiagonal matrix with this diagonal and the entries `beside` it, and the size of the last
/// component of its unit eigenvector.
fn largest_ritz_value(diagonal: &[f64], beside: &[f64]) -> (f64, f64) {
    // Gershgorin's bounds; a value is above all eigenvalues if all pivots of the elimination are negative.
    let off = |i: usize| if i < beside.len() { beside[i] } else { 0.0 };
    let radius = |i: usize| off(i) + if i > 0 { off(i - 1) } else { 0.0 };
    let above = |value: f64| {
        let mut pivot = diagonal[0] - value;
        (1..diagonal.len()).all(|i| {
            let negative = pivot < 0.0;
            pivot = diagonal[i] - value - off(i - 1) * off(i - 1) / pivot;
            negative
        }) && pivot < 0.0
    };
    let mut low = diagonal.iter().fold(f64::NEG_INFINITY, |m, &a| m.max(a));
    let mut high = (0..diagonal.len()).map(|i| diagonal[i] + radius(i)).fold(low, f64::max) * (1.0 + 1e-15);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if above(middle) { high = middle } else { low = middle }
    }
    (high, last_component(diagonal, beside, high))
}

/// Size of the last component of the unit eigenvector of an eigenvalue, from just above it: three steps of inverse
/// iteration with the elimination whose pivots are all negative.
fn last_component(diagonal: &[f64], beside: &[f64], value: f64) -> f64 {
    let count = diagonal.len();
    let mut pivots = Vec::with_capacity(count);
    for i in 0..count {
        let eliminated = if i == 0 { 0.0 } else { beside[i - 1] * beside[i - 1] / pivots[i - 1] };
        // Zero only by rounding.
        pivots.push((diagonal[i] - value - eliminated).min(-1e-16 * value));
    }
    let mut x = vec![1.0 / (count as f64).sqrt(); count];
    for _ in 0..3 {
        for i in 1..count {
            x[i] -= beside[i - 1] / pivots[i - 1] * x[i - 1];
        }
        for i in (0..count).rev() {
            let after = if i + 1 < count { beside[i] * x[i + 1] } else { 0.0 };
            x[i] = (x[i] - after) / pivots[i];
        }
        let norm = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        x.iter_mut().for_each(|x| *x /= norm);
    }
    x[count - 1].abs()
}
