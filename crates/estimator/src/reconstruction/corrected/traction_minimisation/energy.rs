//! The slope of the energy of an element in the moments on its edges.

use super::modes::MOMENTS;
use crate::measure::{ElementMeasure, NodalBalance};
use crate::stress::{EnergyForm, LOADS, face_node};
use percute_core::simd::lanes::Value;

/// The slope of the elastic energy of σ_DA − σ in the moments on the faces of an element, face by face and node by
/// node, σ the stress of the displacement that is equilibrated.
#[inline(always)]
pub(super) fn moment_slopes<T: Value, const D: usize, const N: usize>(
    measure: &ElementMeasure<'_, D, N>,
    form: &EnergyForm<'_>,
    fields: &NodalBalance<D, N, T>,
    stress: &[[T; D]; D],
) -> [[[T; D]; D]; N] {
    let admissible = measure.stress(form, &measure.balanced(fields));
    let mut difference = admissible.mean;
    for a in 0..D {
        for b in 0..D {
            difference[a][b] -= stress[a][b];
        }
    }
    // A moment is a force on its node: it changes the mean stress by the product with the arm of the node.
    let (strain, mut slopes) = (measure.strain(&difference), form.fluctuation_slope(&admissible.fluctuation));
    for k in 0..N {
        for c in 0..D {
            for p in 0..D {
                let arm = &measure.arms()[face_node::<N>(k, p)];
                for b in 0..D {
                    slopes[k][p][c] += strain[c][b] * arm[b];
                }
            }
        }
    }
    slopes
}

/// The same of a triangle, one after the other.
#[inline(always)]
pub(super) fn moment_slope<T: Value, const D: usize, const N: usize>(
    measure: &ElementMeasure<'_, D, N>,
    form: &EnergyForm<'_>,
    fields: &NodalBalance<D, N, T>,
    stress: &[[T; D]; D],
) -> [T; MOMENTS] {
    let slopes = moment_slopes(measure, form, fields, stress);
    let mut moments = [slopes[0][0][0]; MOMENTS];
    for k in 0..N {
        for p in 0..D {
            for c in 0..D {
                moments[4 * k + 2 * p + c] = slopes[k][p][c];
            }
        }
    }
    moments
}

/// The slope of a product of stresses, linear in the loads of the element, tractions first.
pub(super) fn product_slope<const D: usize, const N: usize>(products: &[f64; LOADS]) -> [f64; MOMENTS] {
    let mut gradient = [[[0.0; D]; D]; N];
    gradient.iter_mut().flatten().flatten().zip(products).for_each(|(to, product)| *to = *product);
    moment_gradient(&gradient)
}

/// The derivative of an energy in the moments on the edges of an element, from that in its traction loads. Tractions
/// are D/extent ((D+1)b_p − Σb): a symmetric map, and energy is extent times that of the stress.
#[inline(always)]
pub(super) fn moment_gradient<T: Value, const D: usize, const N: usize>(gradient: &[[[T; D]; D]; N]) -> [T; MOMENTS] {
    let zero = gradient[0][0][0].zero();
    let mut moments = [zero; MOMENTS];
    for (k, slope) in gradient.iter().enumerate() {
        for c in 0..D {
            let mut sum = zero;
            slope.iter().for_each(|s| sum += s[c]);
            for p in 0..D {
                moments[4 * k + 2 * p + c] = (slope[p][c] * (D + 1) as f64 - sum) * D as f64;
            }
        }
    }
    moments
}
