//! Stresses that are quadratic on the three triangles around a centroid.

use super::reference::{COEFFICIENTS, at, quadratic_mass};
use percute_core::material::LinearLaw;

/// A stress of a macro-element.
#[derive(Clone, Debug)]
pub(crate) struct PiecewiseStress {
    pub(super) parts: [[[f64; 2]; 3]; 3],
    pub(super) values: [f64; COEFFICIENTS],
}

/// ∫σ:K⁻¹τ for each σ, and ∫τ (11, 22, 12), where the triangles of τ lie in one part of those of σ.
pub(crate) fn products(
    stresses: &[PiecewiseStress],
    part: usize,
    other: &PiecewiseStress,
    law: &impl LinearLaw,
) -> (Vec<f64>, [f64; 3]) {
    let (alpha, beta) = law.compliance::<2>();
    // ∫φ_m K⁻¹τ at the nodes of τ's triangles, taken to the nodes of σ's part.
    let (mut strains, mut integral) = ([[0.0; 3]; 6], [0.0; 3]);
    for (sub, triangle) in other.parts.iter().enumerate() {
        let area = area(triangle);
        for (m, row) in quadratic_mass().iter().enumerate() {
            let mean: [f64; 3] =
                std::array::from_fn(|c| area * (0..6).map(|n| row[n] * other.values[at(sub, n, c)]).sum::<f64>());
            (0..3).for_each(|c| integral[c] += mean[c]);
            let trace = beta * (mean[0] + mean[1]);
            let strain = [alpha * mean[0] - trace, alpha * mean[1] - trace, 2.0 * alpha * mean[2]];
            let shapes = quadratic_shapes(&stresses[0].parts[part], node(triangle, m));
            for (sum, shape) in strains.iter_mut().zip(shapes) {
                (0..3).for_each(|c| sum[c] += shape * strain[c]);
            }
        }
    }
    let product = |stress: &PiecewiseStress| {
        (0..6).map(|n| (0..3).map(|c| strains[n][c] * stress.values[at(part, n, c)]).sum::<f64>()).sum()
    };
    (stresses.iter().map(product).collect(), integral)
}

fn area([a, b, c]: &[[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
}

/// A node of a quadratic triangle: a corner, or the middle of a side.
fn node(corners: &[[f64; 2]; 3], m: usize) -> [f64; 2] {
    std::array::from_fn(|c| if m < 3 { corners[m][c] } else { 0.5 * (corners[m - 3][c] + corners[(m - 2) % 3][c]) })
}

/// The six quadratic shape functions at a point.
fn quadratic_shapes(corners: &[[f64; 2]; 3], point: [f64; 2]) -> [f64; 6] {
    let [a, b, c] = *corners;
    let l = [area(&[point, b, c]), area(&[a, point, c]), area(&[a, b, point])].map(|part| part / area(corners));
    std::array::from_fn(|m| if m < 3 { l[m] * (2.0 * l[m] - 1.0) } else { 4.0 * l[m - 3] * l[(m - 2) % 3] })
}
