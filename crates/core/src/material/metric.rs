//! The metric in which stresses of finite laws are compared: A = C_T⁻¹ of the tangent C_T = ∂S/∂E, with the eigenvalues
//! θ of C_T v = θ C₀ v, C₀ Hooke's tensor, kept at ¼ at the least. A law may lose its stiffness; the metric remains
//! positive, continuous and the same after any rotation.
//!
//! On the principal axes of E the tangent of an isotropic law couples the normal components with each other, and the
//! shear with itself alone.

use super::hyperelastic::{HyperelasticLaw, Moduli, across, dilatation, green_strain, logarithm};
use super::{Elastic, Kinematics, LinearLaw};
use crate::simd::lanes::Value;

/// The least stiffness that counts, relative to Hooke's.
const FLOOR: f64 = 0.25;

/// The metric at a point of a plane body or a bar, or at eight of them.
#[derive(Clone, Copy, Debug)]
pub struct StressMetric<V> {
    /// Cosine and sine of twice the angle of the first principal axis.
    turn: [V; 2],
    /// A on p = (S₁₁ + S₂₂)/√2 and q = (S₁₁ − S₂₂)/√2 of the principal axes: pp, pq, qq (1/Pa).
    direct: [V; 3],
    /// A on √2 S₁₂ there (1/Pa).
    shear: V,
    /// The mean of A over all axes, relative to C₀⁻¹.
    mean: V,
}

impl<V: Value> StressMetric<V> {
    /// A:S of a symmetric stress.
    #[inline(always)]
    pub fn strain<const D: usize>(&self, stress: &[[V; D]; D]) -> [[V; D]; D] {
        let mut strain = *stress;
        if D == 1 {
            strain[0][0] = stress[0][0] * self.direct[0];
            return strain;
        }
        let [cosine, sine] = self.turn;
        let (half, double) = (0.5, stress[0][1] + stress[1][0]);
        let (sum, difference) = (stress[0][0] + stress[1][1], stress[0][0] - stress[1][1]);
        // √2 q and √2·√2 S₁₂ on the principal axes; the factors cancel.
        let (q, shear) = (difference * cosine + double * sine, double * cosine - difference * sine);
        let p = self.direct[0] * sum + self.direct[1] * q;
        let (q, shear) = (self.direct[1] * sum + self.direct[2] * q, self.shear * shear);
        let (difference, double) = (q * cosine - shear * sine, shear * cosine + q * sine);
        (strain[0][0], strain[1][1]) = ((p + difference) * half, (p - difference) * half);
        (strain[0][1], strain[1][0]) = (double * half, double * half);
        strain
    }

    /// The mean of A over all axes, relative to C₀⁻¹.
    #[inline(always)]
    pub fn mean(&self) -> V {
        self.mean
    }
}

impl Elastic {
    /// The metric at a displacement gradient; C₀⁻¹ with small kinematics.
    #[inline(always)]
    pub fn stress_metric<V: Value, const D: usize>(&self, gradient: &[[V; D]; D]) -> StressMetric<V> {
        let one = gradient[0][0].fill(1.0);
        let (lambda, modulus) = self.moduli();
        let [bulk, twice] = [2.0 * (lambda + modulus), 2.0 * modulus];
        let law = match self.kinematics() {
            Kinematics::Finite(law) if law != HyperelasticLaw::SaintVenantKirchhoff => law,
            _ => {
                let zero = one.zero();
                let direct = if D == 1 { 1.0 / (lambda + twice) } else { 1.0 / bulk };
                let (direct, shear) = ([one * direct, zero, one * (1.0 / twice)], one * (1.0 / twice));
                return StressMetric { turn: [one, zero], direct, shear, mean: one };
            }
        };
        let (moduli, strain) = (self.finite(law), green_strain(gradient));
        if D == 1 {
            let [direct, ..] = tangent(law, &moduli, [strain[0][0]; 2], dilatation(gradient)).0;
            let theta = (direct * (1.0 / (lambda + twice))).max(one * FLOOR);
            let (inverse, zero) = (one / theta, one.zero());
            let direct = inverse * (1.0 / (lambda + twice));
            return StressMetric { turn: [one, zero], direct: [direct, zero, direct], shear: direct, mean: inverse };
        }
        let tiny = one * 1e-150;
        let (mean, half) = ((strain[0][0] + strain[1][1]) * 0.5, (strain[0][0] - strain[1][1]) * 0.5 + tiny);
        let radius = (half * half + strain[0][1] * strain[0][1]).sqrt();
        let turn = [half / radius, strain[0][1] / radius];
        let ([first, coupled, second], shear) =
            tangent(law, &moduli, [mean + radius, mean - radius], dilatation(gradient));
        // On p and q, relative to C₀.
        let scale = 1.0 / (bulk * twice).sqrt();
        let relative = [
            ((first + second) * 0.5 + coupled) * (1.0 / bulk),
            (first - second) * (0.5 * scale),
            ((first + second) * 0.5 - coupled) * (1.0 / twice),
        ];
        let [pp, pq, qq] = floored_inverse(relative);
        let shear = one / (shear * (1.0 / modulus)).max(one * FLOOR);
        StressMetric {
            turn,
            direct: [pp * (1.0 / bulk), pq * scale, qq * (1.0 / twice)],
            shear: shear * (1.0 / twice),
            mean: (pp + qq + shear) * (1.0 / 3.0),
        }
    }
}

/// ∂S_a/∂E_b of the principal directions, (1, 1), (1, 2) and (2, 2), and ½∂S₁₂/∂E₁₂ (Pa), at principal Green strains.
#[inline(always)]
fn tangent<V: Value>(law: HyperelasticLaw, moduli: &Moduli, strains: [V; 2], dilatation: V) -> ([V; 3], V) {
    let &Moduli { lambda, shear, .. } = moduli;
    let one = strains[0].fill(1.0);
    let squares = strains.map(|e| one + e * 2.0);
    let both = one / (squares[0] * squares[1]);
    let inverse = squares.map(|c| one / (c * c));
    match law {
        // S_a = μ + (λ ln J − μ)/C_a.
        HyperelasticLaw::NeoHookean => {
            let mut log = logarithm(dilatation).log;
            let mut effective = one * lambda;
            if moduli.free_thickness {
                let z = across(moduli, log);
                log += logarithm(z).log * 0.5;
                let resistance = (one + z) * shear;
                effective = resistance * lambda / (resistance + one * (0.5 * lambda));
            }
            let rest = one * shear - log * lambda;
            let direct = effective + rest * 2.0;
            ([direct * inverse[0], effective * both, direct * inverse[1]], rest * both)
        }
        HyperelasticLaw::SaintVenantKirchhoff => {
            let direct = one * (lambda + 2.0 * shear);
            ([direct, one * lambda, direct], one * shear)
        }
        // S_a = τ_a/C_a with τ_a = 2μh_a + λΣh.
        HyperelasticLaw::Hencky => {
            let logs = strains.map(|e| logarithm(e * 2.0).log * 0.5);
            let trace = (logs[0] + logs[1]) * lambda;
            let kirchhoff = logs.map(|log| log * (2.0 * shear) + trace);
            let direct = |a: usize| (one * (lambda + 2.0 * shear) - kirchhoff[a] * 2.0) * inverse[a];
            // (h₁ − h₂)/(E₁ − E₂) = L/C₂ with L = ln(1 + x)/x, x = C₁/C₂ − 1.
            let x = (strains[0] - strains[1]) * 2.0 / squares[1];
            let slope = logarithm(x + one * 1e-300).log / (x + one * 1e-300);
            ([direct(0), one * lambda * both, direct(1)], (slope * shear - kirchhoff[1]) * both)
        }
    }
}

/// 1/max(θ, ¼) of a symmetric matrix with the eigenvalues θ: its entries (1, 1), (1, 2) and (2, 2).
#[inline(always)]
fn floored_inverse<V: Value>([a, b, c]: [V; 3]) -> [V; 3] {
    let one = a.fill(1.0);
    let (mean, half) = ((a + c) * 0.5, (a - c) * 0.5);
    let radius = (half * half + b * b).sqrt().max(one * 1e-150);
    let [high, low] = [mean + radius, mean - radius].map(|theta| one / theta.max(one * FLOOR));
    let (sum, slope) = ((high + low) * 0.5, (high - low) * 0.5 / radius);
    [sum + slope * half, slope * b, sum - slope * half]
}

#[cfg(test)]
mod tests {
    use crate::material::{Elastic, HyperelasticLaw, Kinematics, PointLaw, Tensor};
    use nalgebra::{Matrix3, SymmetricEigen, Vector3};

    type Voigt = Vector3<f64>;

    /// S of a symmetric F = √(1 + 2E), as (S₁₁, S₂₂, √2 S₁₂).
    fn stress(law: &Elastic, strain: &Tensor<2>) -> Voigt {
        // √C = (C + √det C 1)/√(tr C + 2√det C).
        let c = [[1.0 + 2.0 * strain[0][0], 2.0 * strain[0][1]], [2.0 * strain[0][1], 1.0 + 2.0 * strain[1][1]]];
        let determinant = (c[0][0] * c[1][1] - c[0][1] * c[0][1]).sqrt();
        let scale = 1.0 / (c[0][0] + c[1][1] + 2.0 * determinant).sqrt();
        let (f, g, off) = ((c[0][0] + determinant) * scale, (c[1][1] + determinant) * scale, c[0][1] * scale);
        let (first, _) = law.respond(&[[f - 1.0, off], [off, g - 1.0]], &mut []);
        let inverse = [[g / determinant, -off / determinant], [-off / determinant, f / determinant]];
        let second = |a: usize, b: usize| inverse[a][0] * first[0][b] + inverse[a][1] * first[1][b];
        Voigt::new(second(0, 0), second(1, 1), 2_f64.sqrt() * second(0, 1))
    }

    /// ∂S/∂E by a central difference of fourth order.
    fn tangent(law: &Elastic, strain: &Tensor<2>) -> Matrix3<f64> {
        Matrix3::from_columns(&[0, 1, 2].map(|k| {
            let moved = |s: f64| {
                let (mut e, r) = (*strain, s / 2_f64.sqrt());
                match k {
                    0 => e[0][0] += s,
                    1 => e[1][1] += s,
                    _ => (e[0][1], e[1][0]) = (e[0][1] + r, e[1][0] + r),
                }
                stress(law, &e)
            };
            let slope = |s: f64| (moved(s) - moved(-s)) / (2.0 * s);
            (slope(1e-3) * 4.0 - slope(2e-3)) / 3.0
        }))
    }

    proptest::proptest! {
        /// A is the inverse of the tangent, with the floor, by a general eigenvalue problem. Differences are right to
        /// some 1e-9, and strains of 0.2 reach the floor.
        #[test]
        fn the_metric_is_the_floored_inverse_of_the_tangent(
            entries in proptest::array::uniform3(-0.2..0.25), angle in -3.0..3.0_f64, nu in 0.0..0.45,
            sheet in proptest::bool::ANY,
        ) {
            let strain = [[entries[0], 0.5 * entries[2]], [0.5 * entries[2], entries[1]]];
            for law in [HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff, HyperelasticLaw::Hencky] {
                let plane = if sheet { Elastic::plane_stress } else { Elastic::plane_strain };
                let law = plane(1.0, nu, 1.0, 1.0).unwrap().with_kinematics(Kinematics::Finite(law)).unwrap();
                let hooke = tangent(&law, &[[0.0; 2]; 2]);
                let root = hooke.cholesky().unwrap().l();
                let inverse = root.try_inverse().unwrap();
                let relative = inverse * tangent(&law, &strain) * inverse.transpose();
                let eigen = SymmetricEigen::new(0.5 * (relative + relative.transpose()));
                let vectors = inverse.transpose() * eigen.eigenvectors;
                let kept = eigen.eigenvalues.map(|theta| 1.0 / theta.max(0.25));
                let expected = vectors * Matrix3::from_diagonal(&kept) * vectors.transpose();
                // The same strain after a rotation of the body.
                let [first, second] = [strain[0], strain[1]].map(|row| row.map(|e| 2.0 * e));
                let c = [[1.0 + first[0], first[1]], [second[0], 1.0 + second[1]]];
                let upper = [c[0][0].sqrt(), c[0][1] / c[0][0].sqrt()];
                let f = [[upper[0], upper[1]], [0.0, (c[1][1] - upper[1] * upper[1]).sqrt()]];
                let (sine, cosine) = angle.sin_cos();
                let h = [
                    [cosine * f[0][0] - sine * f[1][0] - 1.0, cosine * f[0][1] - sine * f[1][1]],
                    [sine * f[0][0] + cosine * f[1][0], sine * f[0][1] + cosine * f[1][1] - 1.0],
                ];
                let metric = law.stress_metric(&h);
                for k in 0..3 {
                    let half = 0.5_f64.sqrt();
                    let units = [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, half], [half, 0.0]]];
                    let unit: Tensor<2> = units[k];
                    let strain = metric.strain(&unit);
                    let found = Voigt::new(strain[0][0], strain[1][1], 2_f64.sqrt() * strain[0][1]);
                    let miss = (found - expected.column(k)).amax();
                    let wanted = expected.column(k);
                    proptest::prop_assert!(miss < 1e-7 * expected.amax(), "{law:?}, {k}: {found} for {wanted}");
                }
            }
        }
    }
}
