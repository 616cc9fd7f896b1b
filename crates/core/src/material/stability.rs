//! A bound on the tangent stiffness of an element, for the stable time step.
//!
//! On the principal axes, with δF_ab along current axis a and reference axis b, the tangent ∂P/∂F of an isotropic law
//! couples δF₁₁ with δF₂₂ by the second derivatives of the energy in the stretches, and δF₁₂ with δF₂₁.

use super::hyperelastic::{HyperelasticLaw, Logarithm, Moduli, across, dilatation, green_strain, logarithm};
use crate::simd::lanes::Value;

/// Squarings of the matrix whose norm bounds its eigenvalue: with the sum of squares of M¹⁶, (tr M³²)^(1/32) is at most
/// 4^(1/32) = 1.044 times the largest of four eigenvalues without their signs.
const SQUARINGS: usize = 4;

/// The bound on the largest eigenvalue of (1⊗R) ∂P/∂F (1⊗R).
#[inline(always)]
pub(super) fn bound<V: Value, const D: usize>(
    law: HyperelasticLaw,
    moduli: &Moduli,
    h: &[[V; D]; D],
    root: &[[V; D]; D],
) -> V {
    let (principal, axes) = Principal::of_gradient(law, moduli, h);
    if D == 1 {
        return principal.direct[0] * root[0][0] * root[0][0];
    }
    largest_eigenvalue(&principal, turned(root, axes))
}

/// Positive where the largest eigenvalue of (1⊗R) ∂P/∂F (1⊗R), Q = R², is above the limit, and nowhere else.
///
/// It is not where 1⊗Q⁻¹ − A/limit is not negative. Of these rows (1,1) and (2,1) have nothing in common, and what is
/// left without them is a matrix of two rows. All is multiplied by determinants.
#[inline(always)]
pub(super) fn excess<V: Value, const D: usize>(
    law: HyperelasticLaw,
    moduli: &Moduli,
    h: &[[V; D]; D],
    square: &[[V; D]; D],
    limit: f64,
) -> V {
    let (principal, axes) = Principal::of_gradient(law, moduli, h);
    let Principal { direct, coupled, shear: [straight, crossed] } = principal;
    if D == 1 {
        return direct[0] * square[0][0] - direct[0].fill(limit);
    }
    let [[xx, xy], [_, yy]] = turned(square, axes);
    let scale = (xx * yy - xy * xy) * (1.0 / limit);
    let (coupled, crossed, straight) = (coupled * scale, crossed * scale, straight * scale);
    let (a, b) = (yy - direct[0] * scale, yy - straight);
    let (c, d) = (xx - straight, xx - direct[1] * scale);
    let (ab, square) = (a * b, xy * xy);
    let first = c * ab - square * b - crossed * crossed * a;
    let second = d * ab - square * a - coupled * coupled * b;
    let mixed = xy * (coupled * b + crossed * a);
    (-a).max(-b).max(-first).max(mixed * mixed - first * second)
}

/// A symmetric tensor on axes with this cosine and sine of twice their angle.
#[inline(always)]
fn turned<V: Value, const D: usize>(tensor: &[[V; D]; D], [cosine, sine]: [V; 2]) -> [[V; 2]; 2] {
    let middle = (tensor[0][0] + tensor[1][1]) * 0.5;
    let (across, off) = ((tensor[0][0] - tensor[1][1]) * 0.5, tensor[0][1]);
    let (across, off) = (across * cosine + off * sine, off * cosine - across * sine);
    [[middle + across, off], [off, middle - across]]
}

/// The tangent on the principal axes.
struct Principal<V> {
    /// ∂²W/∂λ_a².
    direct: [V; 2],
    /// ∂²W/∂λ₁∂λ₂.
    coupled: V,
    /// ∂P₁₂/∂F₁₂ and ∂P₁₂/∂F₂₁.
    shear: [V; 2],
}

impl<V: Value> Principal<V> {
    /// With cosine and sine of twice the angle of the axes.
    #[inline(always)]
    fn of_gradient<const D: usize>(law: HyperelasticLaw, moduli: &Moduli, h: &[[V; D]; D]) -> (Self, [V; 2]) {
        let strain = green_strain(h);
        if D == 1 {
            let half = strain[0][0] * 0.5;
            return (Self::new(law, moduli, [half, half], dilatation(h)), [half, half]);
        }
        // Of two equal stretches any axes will do; the numbers are far below the rounding of strains.
        let tiny = strain[0][0].fill(1e-150);
        let (mean, half) = ((strain[0][0] + strain[1][1]) * 0.5, (strain[0][0] - strain[1][1]) * 0.5 + tiny);
        let radius = (half * half + strain[0][1] * strain[0][1]).sqrt();
        let inverse = tiny.fill(1.0) / radius;
        let principal = Self::new(law, moduli, [mean, radius], dilatation(h));
        (principal, [half * inverse, strain[0][1] * inverse])
    }

    /// At principal Green strains of this mean and half difference, which is not 0.
    #[inline(always)]
    fn new(law: HyperelasticLaw, moduli: &Moduli, [mean, radius]: [V; 2], dilatation: V) -> Self {
        let &Moduli { lambda, shear, .. } = moduli;
        let (one, strains) = (mean.fill(1.0), [mean + radius, mean - radius]);
        let squares = [one + strains[0] * 2.0, one + strains[1] * 2.0];
        let product = one + dilatation;
        match law {
            // P_a = μλ_a + (λ ln J − μ)/λ_a.
            HyperelasticLaw::NeoHookean => {
                let Logarithm { mut log, inverse, .. } = logarithm(dilatation);
                let mut effective = one * lambda;
                if moduli.free_thickness {
                    let z = across(moduli, log);
                    log += logarithm(z).log * 0.5;
                    let resistance = (one + z) * shear;
                    effective = resistance * lambda / (resistance + one * (0.5 * lambda));
                }
                let rest = one * shear - log * lambda;
                let over = (rest + effective) * inverse * inverse;
                let direct = [one * shear + over * squares[1], one * shear + over * squares[0]];
                let quotient = rest * inverse;
                Self::of(direct, effective * inverse, one * shear + quotient, one * shear - quotient)
            }
            // P_a = μλ_a³ + (λ tr E − μ) λ_a.
            HyperelasticLaw::SaintVenantKirchhoff => {
                let trace = (strains[0] + strains[1]) * lambda;
                let direct = |a: usize| strains[a] * (2.0 * shear) + trace + squares[a] * (lambda + 2.0 * shear);
                let rest = (squares[0] + squares[1] - one) * shear + trace;
                let mixed = product * shear;
                Self::of([direct(0), direct(1)], product * lambda, rest + mixed, rest - mixed)
            }
            // P_a = τ_a/λ_a with τ_a = 2μ ln λ_a + λ ln J.
            HyperelasticLaw::Hencky => {
                let stretches = [squares[0].sqrt(), squares[1].sqrt()];
                let logs = [logarithm(strains[0] * 2.0).log * 0.5, logarithm(strains[1] * 2.0).log * 0.5];
                let trace = (logs[0] + logs[1]) * lambda;
                let kirchhoff = [logs[0] * (2.0 * shear) + trace, logs[1] * (2.0 * shear) + trace];
                let direct = |a: usize| (one * (lambda + 2.0 * shear) - kirchhoff[a]) / squares[a];
                let sum = stretches[0] + stretches[1];
                let difference = radius * 4.0 / sum;
                let slope = logarithm(difference / stretches[1]).log / difference;
                let symmetric = (slope * stretches[1] * (2.0 * shear) - kirchhoff[1]) / product;
                let skew = (kirchhoff[0] / stretches[0] + kirchhoff[1] / stretches[1]) / sum;
                Self::of([direct(0), direct(1)], one * lambda / product, symmetric, skew)
            }
        }
    }

    /// From the tangents of the symmetric and the skew part of the shear, (P₁ ∓ P₂)/(λ₁ ∓ λ₂).
    #[inline(always)]
    fn of(direct: [V; 2], coupled: V, symmetric: V, skew: V) -> Self {
        Self { direct, coupled, shear: [(symmetric + skew) * 0.5, (symmetric - skew) * 0.5] }
    }
}

/// The bound on that of (1⊗R) A (1⊗R), with rows (1,1), (1,2), (2,1), (2,2).
#[inline(always)]
fn largest_eigenvalue<V: Value>(tangent: &Principal<V>, root: [[V; 2]; 2]) -> V {
    let Principal { direct, coupled, shear: [straight, crossed] } = *tangent;
    let [[a, b], [_, c]] = root;
    let (aa, ab, bb, bc, cc, ac) = (a * a, a * b, b * b, b * c, c * c, a * c);
    let both = coupled + crossed;
    let mut matrix = [[coupled; 4]; 4];
    matrix[0][0] = direct[0] * aa + straight * bb;
    matrix[0][1] = direct[0] * ab + straight * bc;
    matrix[1][1] = direct[0] * bb + straight * cc;
    matrix[0][2] = both * ab;
    matrix[0][3] = coupled * ac + crossed * bb;
    matrix[1][2] = coupled * bb + crossed * ac;
    matrix[1][3] = both * bc;
    matrix[2][2] = straight * aa + direct[1] * bb;
    matrix[2][3] = straight * ab + direct[1] * bc;
    matrix[3][3] = straight * bb + direct[1] * cc;
    // Numbers near 1, so that no power leaves their range.
    let mut size = coupled.fill(f64::MIN_POSITIVE);
    each(|i, j| size = size.max(matrix[i][j].abs()));
    let scale = coupled.fill(1.0) / size;
    each(|i, j| matrix[i][j] = matrix[i][j] * scale);
    for _ in 0..SQUARINGS {
        (0..4).for_each(|i| (0..i).for_each(|j| matrix[i][j] = matrix[j][i]));
        let m = matrix;
        each(|i, j| matrix[i][j] = m[i][0] * m[0][j] + m[i][1] * m[1][j] + m[i][2] * m[2][j] + m[i][3] * m[3][j]);
    }
    let mut bound = coupled.zero();
    each(|i, j| bound += matrix[i][j] * matrix[i][j] * if i == j { 1.0 } else { 2.0 });
    (0..=SQUARINGS).for_each(|_| bound = bound.sqrt());
    bound * size
}

/// The entries of a symmetric matrix.
#[inline(always)]
fn each(mut f: impl FnMut(usize, usize)) {
    for i in 0..4 {
        for j in i..4 {
            f(i, j);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::material::{Elastic, HyperelasticLaw, Kinematics, PointLaw, Tensor};
    use nalgebra::{Matrix4, SymmetricEigen};

    /// ∂P_a J/∂F_b K by a central difference of fourth order.
    fn tangent(law: &Elastic, h: &Tensor<2>) -> Matrix4<f64> {
        let mut matrix = Matrix4::zeros();
        for column in 0..4 {
            let stress = |s: f64| {
                let mut moved = *h;
                moved[column / 2][column % 2] += s;
                let (stress, _): (Tensor<2>, f64) = law.respond(&moved, &mut []);
                stress
            };
            let [near, far] = [1e-3, 2e-3].map(|s| [stress(s), stress(-s)]);
            for row in 0..4 {
                let slope = |[a, b]: &[Tensor<2>; 2], s: f64| (a[row / 2][row % 2] - b[row / 2][row % 2]) / (2.0 * s);
                matrix[(row, column)] = (4.0 * slope(&near, 1e-3) - slope(&far, 2e-3)) / 3.0;
            }
        }
        matrix
    }

    proptest::proptest! {
        /// At least the eigenvalue without its sign, and at most 4^(1/32) = 1.044 times it. The differences are right
        /// to 1e-9.
        #[test]
        fn the_bound_is_close_to_the_eigenvalue(
            entries in proptest::array::uniform4(-0.3..0.3),
            root in proptest::array::uniform3(0.1..1.0),
            nu in 0.0..0.45,
        ) {
            let h = [[entries[0], entries[1]], [entries[2], entries[3]]];
            let root = [[root[0], 0.3 * root[1]], [0.3 * root[1], root[2]]];
            for law in [HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff, HyperelasticLaw::Hencky] {
                for plane in [Elastic::plane_strain, Elastic::plane_stress] {
                    let law = plane(1.0, nu, 1.0, 1.0).unwrap().with_kinematics(Kinematics::Finite(law)).unwrap();
                    let factor = Matrix4::from_fn(|i, j| if i / 2 == j / 2 { root[i % 2][j % 2] } else { 0.0 });
                    let values = SymmetricEigen::new(factor * tangent(&law, &h) * factor).eigenvalues;
                    let exact = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                    let bound = law.stiffness_bound(&h, &root);
                    let sharp = exact * (1.0 - 1e-8) <= bound && bound <= 1.0443 * exact * (1.0 + 1e-8);
                    proptest::prop_assert!(sharp, "{law:?}: {bound} for {exact}");
                    let most = values.max();
                    let product = |i: usize, j: usize| root[i][0] * root[0][j] + root[i][1] * root[1][j];
                    let square = [[product(0, 0), product(0, 1)], [product(1, 0), product(1, 1)]];
                    let [above, below] = [1.0 - 1e-6, 1.0 + 1e-6].map(|x| law.stiffness_excess(&h, &square, x * most));
                    proptest::prop_assert!(above > 0.0 && below <= 0.0, "{law:?}: {above}, {below} around {most}");
                }
            }
        }
    }

    /// At rest the bound is that of Hooke's law, λ + 2G in a bar.
    #[test]
    fn a_bar_has_its_modulus() {
        let bar =
            Elastic::bar(3.0, 1.0, 1.0).unwrap().with_kinematics(Kinematics::Finite(HyperelasticLaw::Hencky)).unwrap();
        assert!((bar.stiffness_bound(&[[0.0]], &[[2.0]]) - 12.0).abs() < 1e-14);
        assert!((bar.stiffness_excess(&[[0.0]], &[[4.0]], 11.0) - 1.0).abs() < 1e-14);
    }
}
