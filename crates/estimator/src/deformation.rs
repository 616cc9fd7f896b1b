//! The deformation gradient F = 1 + H of an element, and fields of the present body pulled back by it.
//!
//! With finite kinematics tractions, inertia and the first Piola–Kirchhoff stress P balance as vectors of the present
//! body over the undeformed one. F is constant in an element, so F⁻¹ of its loads balances S = F⁻¹P, and the moments
//! about the present places balance where S is symmetric: the maps for small strains serve unchanged.

use percute_core::material::{Elastic, PointLaw};
use percute_core::simd::lanes::Value;

/// F⁻¹ of an element.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deformation<const D: usize, T> {
    inverse: [[T; D]; D],
}

impl<const D: usize, T: Value> Deformation<D, T> {
    /// Of H = ∂u_a/∂X_b.
    #[inline(always)]
    pub(crate) fn new(gradient: &[[T; D]; D]) -> Self {
        let one = gradient[0][0].fill(1.0);
        let mut inverse = *gradient;
        if D == 1 {
            inverse[0][0] = one / (one + gradient[0][0]);
        } else {
            let [f, g] = [one + gradient[0][0], one + gradient[1][1]];
            let factor = one / (f * g - gradient[0][1] * gradient[1][0]);
            (inverse[0][0], inverse[1][1]) = (g * factor, f * factor);
            (inverse[0][1], inverse[1][0]) = (-gradient[0][1] * factor, -gradient[1][0] * factor);
        }
        Self { inverse }
    }

    /// F⁻¹ v.
    #[inline(always)]
    pub(crate) fn pull_back(&self, vector: &mut [T; D]) {
        let v = *vector;
        for a in 0..D {
            vector[a] = self.inverse[a][0] * v[0];
            (1..D).for_each(|b| vector[a] += self.inverse[a][b] * v[b]);
        }
    }

    /// F⁻ᵀ g: the slope of an energy in a vector, from that in the vector pulled back.
    #[inline(always)]
    pub(crate) fn slope(&self, slope: &[T; D]) -> [T; D] {
        let mut found = *slope;
        for a in 0..D {
            found[a] = self.inverse[0][a] * slope[0];
            (1..D).for_each(|b| found[a] += self.inverse[b][a] * slope[b]);
        }
        found
    }

    /// S = F⁻¹P, of which the skew part is rounding.
    #[inline(always)]
    pub(crate) fn second_stress(&self, first: &[[T; D]; D]) -> [[T; D]; D] {
        let mut second = *first;
        for b in 0..D {
            let mut column = [first[0][b]; D];
            (0..D).for_each(|a| column[a] = first[a][b]);
            self.pull_back(&mut column);
            (0..D).for_each(|a| second[a][b] = column[a]);
        }
        for a in 0..D {
            for b in 0..a {
                let mean = (second[a][b] + second[b][a]) * 0.5;
                (second[a][b], second[b][a]) = (mean, mean);
            }
        }
        second
    }

    /// The symmetric stress of the present body in a first Piola–Kirchhoff stress P: ½(T + Tᵀ)F⁻ᵀ of T = PFᵀ.
    #[inline(always)]
    pub(crate) fn symmetric_part(&self, first: &[[T; D]; D], gradient: &[[T; D]; D]) -> [[T; D]; D] {
        let mut spatial = *first;
        for a in 0..D {
            for b in 0..D {
                (0..D).for_each(|c| spatial[a][b] += first[a][c] * gradient[b][c]);
            }
        }
        let mut symmetric = *first;
        for a in 0..D {
            let mut row = [spatial[a][0]; D];
            (0..D).for_each(|b| row[b] = (spatial[a][b] + spatial[b][a]) * 0.5);
            for b in 0..D {
                symmetric[a][b] = row[0] * self.inverse[b][0];
                (1..D).for_each(|c| symmetric[a][b] += row[c] * self.inverse[b][c]);
            }
        }
        symmetric
    }
}

/// S of a law at a Green strain (Pa): that of the stretch U without a rotation, U − 1 = 2E(U + 1)⁻¹ without a
/// difference of numbers near 1.
#[inline(always)]
pub(crate) fn second_stress<T: Value, const D: usize>(law: &Elastic, strain: &[[T; D]; D]) -> [[T; D]; D] {
    let one = strain[0][0].fill(1.0);
    let mut stretch = *strain;
    if D == 1 {
        let double = strain[0][0] * 2.0;
        stretch[0][0] = double / ((one + double).sqrt() + one);
    } else {
        let (x, y, xy) = (strain[0][0] * 2.0, strain[1][1] * 2.0, strain[0][1] * 2.0);
        let volume = ((one + x) * (one + y) - xy * xy).sqrt();
        let trace = (one + x + one + y + volume * 2.0).sqrt();
        // (U + 1)⁻¹ is tr U over C + (det U + tr U) 1.
        let [a, b] = [one + x + volume + trace, one + y + volume + trace];
        let factor = trace / (a * b - xy * xy);
        (stretch[0][0], stretch[1][1]) = ((x * b - xy * xy) * factor, (y * a - xy * xy) * factor);
        let shear = (xy * a - x * xy) * factor;
        (stretch[0][1], stretch[1][0]) = (shear, shear);
    }
    Deformation::new(&stretch).second_stress(&law.respond(&stretch, &mut []).0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::{HyperelasticLaw, Kinematics, green_strain};
    use percute_testkit::Random;

    /// The second stress at a Green strain is F⁻¹P of any F with this strain, to rounding.
    #[test]
    fn the_second_stress_follows_from_the_strain() {
        let mut random = Random::new(6);
        for law in [HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff, HyperelasticLaw::Hencky] {
            for plane in [Elastic::plane_strain, Elastic::plane_stress] {
                let law = plane(1.0, 0.3, 1.0, 1.0).unwrap().with_kinematics(Kinematics::Finite(law)).unwrap();
                for size in [1e-9, 1e-3, 0.3] {
                    let h: [[f64; 2]; 2] =
                        std::array::from_fn(|_| std::array::from_fn(|_| random.between(-size, size)));
                    let expected = Deformation::new(&h).second_stress(&law.respond(&h, &mut []).0);
                    let found = second_stress(&law, &green_strain(&h));
                    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                        assert!((found - expected).abs() < 1e-14 * size.max(1e-2), "{found} for {expected}");
                    }
                }
            }
        }
    }
}
