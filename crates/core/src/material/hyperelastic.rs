//! Hyperelastic laws for large strains and rotations: the first Piola–Kirchhoff stress P = ∂W/∂F and the strain energy
//! W of a displacement gradient H = F − 1, per reference volume.
//!
//! All are written in H, with differences that vanish with it taken before products: as H falls they agree with Hooke's
//! law to rounding. They are functions over [`Value`], for one point or eight. Where an element is turned inside out,
//! J = det F ≤ 0, the energy is NaN.

use super::Tensor;
use crate::simd::lanes::Value;

/// A strain energy for large strains. Each is Hooke's law at small ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HyperelasticLaw {
    /// W = ½μ (tr C − 3 − 2 ln J) + ½λ (ln J)².
    #[default]
    NeoHookean,
    /// Saint Venant–Kirchhoff: W = μ E:E + ½λ (tr E)² of the Green strain. It softens in compression.
    SaintVenantKirchhoff,
    /// W = μ Σh_a² + ½λ (Σh_a)² of the logarithmic strains.
    Hencky,
}

/// Moduli of a law (Pa) and the condition across the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moduli {
    /// λ in the dimension of the mesh; with a free thickness that in space.
    pub(super) lambda: f64,
    /// G = μ.
    pub(super) shear: f64,
    /// Whether the thickness changes with the law, which then has λ in space.
    pub(super) free_thickness: bool,
}

/// Stress P (Pa) and energy W (J/m³).
pub type Response<V, const D: usize> = ([[V; D]; D], V);

impl HyperelasticLaw {
    /// The response to H.
    #[inline(always)]
    pub(super) fn respond<V: Value, const D: usize>(self, moduli: &Moduli, h: &[[V; D]; D]) -> Response<V, D> {
        match self {
            Self::NeoHookean => neo_hookean(moduli, h),
            Self::SaintVenantKirchhoff => saint_venant_kirchhoff(moduli, h),
            Self::Hencky => hencky(moduli, h),
        }
    }

    /// The thickness over that of the undeformed body, in plane stress.
    pub(super) fn thickness<const D: usize>(self, moduli: &Moduli, h: &Tensor<D>) -> f64 {
        let log = dilatation(h).ln_1p();
        // λ/(λ + 2G) of the moduli in space, from the reduced λ.
        let share = moduli.lambda / (2.0 * moduli.shear);
        match self {
            Self::NeoHookean => (1.0 + across(moduli, log)).sqrt(),
            Self::SaintVenantKirchhoff => {
                let strain = green_strain(h);
                (1.0 - 2.0 * share * (0..D).map(|a| strain[a][a]).sum::<f64>()).sqrt()
            }
            Self::Hencky => (-share * log).exp(),
        }
    }
}

/// J − 1.
#[inline(always)]
pub(super) fn dilatation<V: Value, const D: usize>(h: &[[V; D]; D]) -> V {
    match D {
        1 => h[0][0],
        _ => h[0][0] + h[1][1] + (h[0][0] * h[1][1] - h[0][1] * h[1][0]),
    }
}

/// J = det F, the volume over that of the undeformed body.
#[must_use]
pub fn volume_ratio<const D: usize>(h: &Tensor<D>) -> f64 {
    1.0 + dilatation(h)
}

/// σ = P Fᵀ/J, with the thickness over that of the undeformed body.
pub(super) fn present_stress<const D: usize>(first: &Tensor<D>, h: &Tensor<D>, thickness: f64) -> Tensor<D> {
    let volume = thickness * volume_ratio(h);
    let entry = |a: usize, b: usize| first[a][b] + (0..D).map(|c| first[a][c] * h[b][c]).sum::<f64>();
    std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b) / volume))
}

/// P = μ (F − F⁻ᵀ) + λ ln J F⁻ᵀ.
#[inline(always)]
fn neo_hookean<V: Value, const D: usize>(moduli: &Moduli, h: &[[V; D]; D]) -> Response<V, D> {
    let e = dilatation(h);
    let Logarithm { mut log, mut rest, inverse } = logarithm(e);
    if moduli.free_thickness {
        let across = logarithm(across(moduli, log));
        log += across.log * 0.5;
        rest += across.rest * 0.5;
    }
    let scaled = log * moduli.lambda;
    // F⁻ᵀ = cof F − (1 − 1/J) cof F, so that no numbers near 1 are subtracted.
    let part = (e * moduli.shear + scaled) * inverse;
    let mut stress = *h;
    if D == 1 {
        stress[0][0] = h[0][0] * moduli.shear + part;
        let energy = ((h[0][0] * h[0][0] + rest * 2.0) * moduli.shear + log * scaled) * 0.5;
        return (stress, energy);
    }
    let one = e.fill(1.0);
    let (sum, difference) = (h[0][1] + h[1][0], h[0][0] - h[1][1]);
    let (shear, deviator) = (sum * moduli.shear, difference * moduli.shear);
    stress[0][0] = deviator + part * (h[1][1] + one);
    stress[1][1] = part * (h[0][0] + one) - deviator;
    stress[0][1] = shear - part * h[1][0];
    stress[1][0] = shear - part * h[0][1];
    let energy = ((difference * difference + sum * sum + rest * 2.0) * moduli.shear + log * scaled) * 0.5;
    (stress, energy)
}

/// z = C₃₃ − 1 of a body whose stress across is 0, from ln J in its plane: μ z + λ (ln J + ½ ln(1 + z)) = 0.
#[inline(always)]
pub(super) fn across<V: Value>(moduli: &Moduli, log: V) -> V {
    let far = |log: f64| !(-0.2..0.2).contains(&log);
    // The error of the polynomial is at most 1.3e-4 in this range.
    let near = corrected(moduli, log, first_guess(moduli, log));
    if !log.any(far) {
        return near;
    }
    // Eight corrections reach rounding for J from 0.01 to 100.
    let solve = |log: f64| (0..8).fold(first_guess(moduli, log).max(-0.9), |z, _| corrected(moduli, log, z));
    near.replaced_where(log, far, solve)
}

/// The polynomial of fourth order of z in ln J at 0.
#[inline(always)]
fn first_guess<V: Value>(&Moduli { lambda, shear, .. }: &Moduli, log: V) -> V {
    let share = lambda / (2.0 * shear + lambda);
    let cube = share * share * share;
    let third = log.fill(cube * share * (2.0 - 3.0 * share) * (4.0 / 3.0));
    let fourth = log * (cube * share * share * (6.0 - share * (20.0 - 15.0 * share)) * (2.0 / 3.0));
    (((fourth + third) * log + log.fill(2.0 * cube)) * log - log.fill(2.0 * share)) * log
}

/// A better z: the error of its logarithm d becomes d⁴/24 at the most.
///
/// 1 + z grows by the part x of (A + B) x − B (x − ln(1 + x)) = −R, with A = μ (1 + z), B = ½λ and the residual R.
/// This is the series of x in R.
#[inline(always)]
fn corrected<V: Value>(&Moduli { lambda, shear, .. }: &Moduli, log: V, z: V) -> V {
    let one = log.fill(1.0);
    let ratio = one + z;
    let residual = z * shear + (log + logarithm(z).log * 0.5) * lambda;
    let inverse = one / (ratio * shear + log.fill(0.5 * lambda));
    let (first, share) = (residual * inverse, inverse * (0.5 * lambda));
    let third = first * (share * 0.5 - log.fill(1.0 / 3.0));
    let part = first * (first * share * (log.fill(0.5) - third) - one);
    // 1 + z falls to a tenth at the most.
    z + part.max(log.fill(-0.9)) * ratio
}

/// P = F S with S = λ tr E + 2G E.
#[inline(always)]
fn saint_venant_kirchhoff<V: Value, const D: usize>(moduli: &Moduli, h: &[[V; D]; D]) -> Response<V, D> {
    // 2E.
    let strain = metric_change(h);
    let mut trace = strain[0][0];
    (1..D).for_each(|a| trace += strain[a][a]);
    let (mut second, mut work) = (strain, trace.zero());
    for a in 0..D {
        for b in 0..D {
            second[a][b] = strain[a][b] * moduli.shear;
        }
        second[a][a] += trace * (0.5 * moduli.lambda);
        (0..D).for_each(|b| work += second[a][b] * strain[a][b]);
    }
    let first = first_stress(h, &second);
    // This energy alone does not see whether the element is inside out.
    let (e, inside_out) = (dilatation(h), |e: f64| e < -1.0);
    let energy = work * 0.25;
    (first, if e.any(inside_out) { energy.replaced_where(e, inside_out, |_| f64::NAN) } else { energy })
}

/// P = F⁻ᵀ (G ln C + λ ln J 1).
///
/// With m = ½ tr C and D/m the deviator of C over m, whose eigenvalues are ±r, the deviator of ln C is artanh r/r D/m.
#[inline(always)]
fn hencky<V: Value, const D: usize>(moduli: &Moduli, h: &[[V; D]; D]) -> Response<V, D> {
    let Logarithm { log, inverse, .. } = logarithm(dilatation(h));
    let spherical = log * (moduli.lambda + moduli.shear);
    let (square, mut stress) = (log * log, *h);
    if D == 1 {
        stress[0][0] = (spherical + log * moduli.shear) * inverse;
        return (stress, square * (0.5 * moduli.lambda + moduli.shear));
    }
    let (change, one) = (metric_change(h), log.fill(1.0));
    let inverse_trace = one / (change[0][0] + change[1][1] + log.fill(2.0));
    let (straight, skew) = ((change[0][0] - change[1][1]) * inverse_trace, change[0][1] * 2.0 * inverse_trace);
    let part = straight * straight + skew * skew;
    let factor = artanh_over(part);
    let shear = factor * moduli.shear;
    let (deviator, off) = (straight * shear, skew * shear);
    let [[xx, xy], [_, yy]] = [[spherical + deviator, off], [off, spherical - deviator]];
    let (f, g) = ((h[0][0] + one) * inverse, (h[1][1] + one) * inverse);
    let (other, another) = (h[0][1] * inverse, h[1][0] * inverse);
    stress[0][0] = g * xx - another * xy;
    stress[0][1] = g * xy - another * yy;
    stress[1][0] = f * xy - other * xx;
    stress[1][1] = f * yy - other * xy;
    let energy = (square + factor * factor * part) * (0.5 * moduli.shear) + square * (0.5 * moduli.lambda);
    (stress, energy)
}

/// C − 1 = H + Hᵀ + HᵀH.
#[inline(always)]
fn metric_change<V: Value, const D: usize>(h: &[[V; D]; D]) -> [[V; D]; D] {
    let mut change = *h;
    for a in 0..D {
        for b in 0..D {
            change[a][b] = h[a][b] + h[b][a];
            (0..D).for_each(|c| change[a][b] += h[c][a] * h[c][b]);
        }
    }
    change
}

/// P = F S of H = F − 1.
#[inline(always)]
pub fn first_stress<V: Value, const D: usize>(h: &[[V; D]; D], second: &[[V; D]; D]) -> [[V; D]; D] {
    let mut first = *second;
    for a in 0..D {
        for b in 0..D {
            (0..D).for_each(|c| first[a][b] += h[a][c] * second[c][b]);
        }
    }
    first
}

/// The Green strain E = ½ (C − 1) of H = F − 1.
#[inline(always)]
pub fn green_strain<V: Value, const D: usize>(h: &[[V; D]; D]) -> [[V; D]; D] {
    let mut strain = metric_change(h);
    (0..D).for_each(|a| (0..D).for_each(|b| strain[a][b] = strain[a][b] * 0.5));
    strain
}

/// What laws need of a ratio 1 + e.
pub(super) struct Logarithm<V> {
    /// ln(1 + e).
    pub(super) log: V,
    /// e − ln(1 + e).
    pub(super) rest: V,
    /// 1/(1 + e).
    pub(super) inverse: V,
}

/// All to rounding. With s = e/(2 + e), ln(1 + e) = 2 artanh s and e − 2s = e s; one division is enough.
#[inline(always)]
pub(super) fn logarithm<V: Value>(e: V) -> Logarithm<V> {
    let (ratio, sum) = (e + e.fill(1.0), e + e.fill(2.0));
    let quotient = e.fill(1.0) / (ratio * sum);
    let (inverse, s) = (sum * quotient, e * ratio * quotient);
    let (twice, square) = (s + s, s * s);
    let cubic = twice * (square * series(square));
    let (log, rest) = (twice + cubic, e * s - cubic);
    let far = |e: f64| !(-0.33..0.49).contains(&e);
    if !e.any(far) {
        return Logarithm { log, rest, inverse };
    }
    let (log, rest) = (log.replaced_where(e, far, f64::ln_1p), rest.replaced_where(e, far, |e| e - e.ln_1p()));
    Logarithm { log, rest, inverse }
}

/// artanh(r)/r of t = r², to rounding.
#[inline(always)]
fn artanh_over<V: Value>(t: V) -> V {
    let near = t * series(t) + t.fill(1.0);
    let far = |t: f64| !(0.0..LONGEST).contains(&t);
    if t.any(far) { near.replaced_where(t, far, |t| t.sqrt().atanh() / t.sqrt()) } else { near }
}

/// The series reaches rounding up to this t: s² of e = −0.33 and 0.49.
const LONGEST: f64 = 0.039;

/// 1/3 + t/5 + t²/7 + …, as a polynomial whose product with t has the least error up to t = 0.04, 1.5e-17.
#[inline(always)]
fn series<V: Value>(t: V) -> V {
    const C: [f64; 7] = [
        0.33333333333336357,
        0.1999999999808084,
        0.1428571469764472,
        0.11111069250803385,
        0.09093178033609585,
        0.07625094309755405,
        0.07684095381818772,
    ];
    let pair = |k: usize| t * C[k + 1] + t.fill(C[k]);
    let square = t * t;
    // Halves, so that fewer operations wait for each other.
    (pair(0) + pair(2) * square) + (pair(4) + square * C[6]) * (square * square)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Elastic, Kinematics, Law, PointLaw, Tensor};
    use crate::simd::lanes::Lanes;

    const LAWS: [HyperelasticLaw; 3] =
        [HyperelasticLaw::NeoHookean, HyperelasticLaw::SaintVenantKirchhoff, HyperelasticLaw::Hencky];

    /// All laws in plane strain and plane stress, with E = 1.
    fn plane_laws() -> Vec<Elastic> {
        let materials =
            [(0.3, false), (0.45, false), (-0.3, false), (0.3, true), (0.45, true), (0.0, true)].map(|(nu, stress)| {
                let plane = if stress { Elastic::plane_stress } else { Elastic::plane_strain };
                plane(1.0, nu, 1.0, 1.0).unwrap()
            });
        let with = |law| materials.map(|material| material.with_kinematics(Kinematics::Finite(law)).unwrap());
        LAWS.into_iter().flat_map(with).collect()
    }

    fn respond<const D: usize>(law: &Elastic, h: &Tensor<D>) -> (Tensor<D>, f64) {
        law.respond(h, &mut [])
    }

    fn combined(a: &Tensor<2>, factor: f64, b: &Tensor<2>) -> Tensor<2> {
        std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + factor * b[i][j]))
    }

    fn product(a: &Tensor<2>, b: &Tensor<2>) -> Tensor<2> {
        std::array::from_fn(|i| std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
    }

    const UNIT: Tensor<2> = [[1.0, 0.0], [0.0, 1.0]];

    proptest::proptest! {
        /// By a central difference of fourth order with steps of 1e-3: its own error is of the order of 1e-12, the
        /// rounding of energies over the step 1e-13.
        #[test]
        fn stress_is_the_derivative_of_the_energy(entries in proptest::array::uniform8(-0.25..0.25)) {
            let [a, b, c, d, e, f, g, k] = entries;
            let (h, change) = ([[a, b], [c, d]], [[e, f], [g, k]]);
            for law in plane_laws() {
                let energy = |s: f64| respond(&law, &combined(&h, s, &change)).1;
                let slope = |s: f64| (energy(s) - energy(-s)) / (2.0 * s);
                let expected = (4.0 * slope(1e-3) - slope(2e-3)) / 3.0;
                let stress = respond(&law, &h).0;
                let work: f64 = (0..4).map(|i| stress[i / 2][i % 2] * change[i / 2][i % 2]).sum();
                proptest::prop_assert!((work - expected).abs() < 1e-10, "{law:?}: {work} against {expected}");
            }
        }

        /// P(QF) = Q P(F) and W(QF) = W(F), to the rounding of some twenty operations on numbers of the order of 1.
        #[test]
        fn a_rotation_of_the_body_turns_the_stress(
            entries in proptest::array::uniform4(-0.25..0.25), angle in -3.2..3.2_f64,
        ) {
            let [a, b, c, d] = entries;
            let h = [[a, b], [c, d]];
            let (sine, cosine) = angle.sin_cos();
            let rotation = [[cosine, -sine], [sine, cosine]];
            let turned = combined(&product(&rotation, &combined(&UNIT, 1.0, &h)), -1.0, &UNIT);
            for law in plane_laws() {
                let ((stress, energy), (found, same)) = (respond(&law, &h), respond(&law, &turned));
                let expected = product(&rotation, &stress);
                proptest::prop_assert!((energy - same).abs() < 1e-14, "{law:?}: {energy} against {same}");
                for i in 0..4 {
                    let (found, expected) = (found[i / 2][i % 2], expected[i / 2][i % 2]);
                    proptest::prop_assert!((found - expected).abs() < 3e-14, "{law:?}: {found} against {expected}");
                }
            }
        }

        /// At strains of 1e-10 all are Hooke's law to 1e-8; differences of numbers near 1 would leave 1e-6.
        #[test]
        fn small_strains_obey_hookes_law(entries in proptest::array::uniform4(-1.0..1.0)) {
            let [a, b, c, d] = entries.map(|x: f64| 1e-10 * x);
            let h: Tensor<2> = [[a, b], [c, d]];
            let scale = h.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
            for law in plane_laws() {
                let ((stress, energy), small) = (respond(&law, &h), law.with_kinematics(Kinematics::Small).unwrap());
                let hooke = small.stress(&h);
                for i in 0..4 {
                    let (found, expected) = (stress[i / 2][i % 2], hooke[i / 2][i % 2]);
                    proptest::prop_assert!((found - expected).abs() < 1e-8 * scale, "{law:?}: {found}, {expected}");
                }
                proptest::prop_assert!((energy - small.strain_energy(&h)).abs() < 1e-8 * scale * scale);
            }
        }

        /// Also where the series of the logarithm ends, which some lanes reach and others do not.
        #[test]
        fn eight_points_have_the_bits_of_one(entries in proptest::array::uniform32(-0.6..0.6)) {
            for law in plane_laws() {
                let lanes = |a: usize, b: usize| Lanes::at_levels(|lane| entries[4 * lane + 2 * a + b]);
                let h = [[lanes(0, 0), lanes(0, 1)], [lanes(1, 0), lanes(1, 1)]];
                let (stress, energy) = law.respond(&h, &mut []);
                for lane in 0..8 {
                    let own = &entries[4 * lane..];
                    let one = [[own[0], own[1]], [own[2], own[3]]];
                    let (expected, density) = respond(&law, &one);
                    proptest::prop_assert_eq!(energy.0[lane].to_bits(), density.to_bits());
                    for i in 0..4 {
                        let [found, expected] = [stress[i / 2][i % 2].0[lane], expected[i / 2][i % 2]];
                        proptest::prop_assert_eq!(found.to_bits(), expected.to_bits());
                    }
                }
            }
        }

        /// The stress across is 0: μ z + λ (ln J + ½ ln(1 + z)), to rounding.
        #[test]
        fn the_thickness_is_in_equilibrium(log in -1.5..1.5_f64, nu in 0.0..0.499) {
            let law = Elastic::plane_stress(1.0, nu, 1.0, 1.0).unwrap();
            let moduli = law.finite(HyperelasticLaw::NeoHookean);
            let z = across(&moduli, log);
            let terms = [z * moduli.shear, moduli.lambda * log, 0.5 * moduli.lambda * z.ln_1p()];
            let scale: f64 = terms.iter().map(|x| x.abs()).sum();
            proptest::prop_assert!(terms.iter().sum::<f64>().abs() <= 1e-14 * scale + 1e-300, "{z}: {terms:?}");
        }

        #[test]
        fn logarithms_are_right_to_rounding(e in -0.8..3.0_f64) {
            let Logarithm { log, rest, inverse } = logarithm(e);
            proptest::prop_assert!((inverse * (1.0 + e) - 1.0).abs() <= 4.0 * f64::EPSILON);
            proptest::prop_assert!((log - e.ln_1p()).abs() <= 4.0 * f64::EPSILON * log.abs());
            // e − ln(1 + e) = ∫ t/(1 + t), by Gauss's rule with 3 points on 40 parts.
            let rule = [(-0.6_f64.sqrt(), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6_f64.sqrt(), 5.0 / 18.0)];
            let part = e / 40.0;
            let at = |k: i32, x: f64| part * (f64::from(k) + 0.5 + 0.5 * x);
            let sum = (0..40).flat_map(|k| rule.map(|(x, w)| w * part * at(k, x) / (1.0 + at(k, x)))).sum::<f64>();
            proptest::prop_assert!((rest - sum).abs() <= 1e-6 * rest, "{rest} against {sum}");
        }
    }

    /// A bar: neo-Hookean μ (λ − 1/λ) with μ = E/2, Saint Venant–Kirchhoff E λ (λ² − 1)/2, Hencky E ln λ/λ.
    #[test]
    fn bars_have_their_formulas() {
        let bar = Elastic::bar(2.0, 1.0, 1.0).unwrap();
        for stretch in [0.6_f64, 0.9, 1.0, 1.3, 1.9] {
            let expected = [stretch - 1.0 / stretch, stretch * (stretch * stretch - 1.0), 2.0 * stretch.ln() / stretch];
            for (law, expected) in LAWS.into_iter().zip(expected) {
                let law = bar.with_kinematics(Kinematics::Finite(law)).unwrap();
                let ([[found]], _) = respond(&law, &[[stretch - 1.0]]);
                assert!((found - expected).abs() < 1e-15, "{law:?} at {stretch}: {found} against {expected}");
            }
        }
    }

    /// A sheet of ν = 0.4 with principal stretches 1.3 and 0.9: σ_a = P_a λ_a/J with a thickness without stress
    /// across, found by bisection of the law in space.
    #[test]
    fn stress_is_per_present_area_in_plane_stress() {
        let (lambda, shear) = (0.4 / (1.4 * 0.2), 1.0 / 2.8);
        let stretches = |across: f64| [1.3, 0.9, across];
        for law in LAWS {
            // Kirchhoff stress on the principal axes in space.
            let kirchhoff = |across: f64| -> [f64; 3] {
                let volume: f64 = stretches(across).iter().product();
                let green: f64 = stretches(across).iter().map(|s| 0.5 * (s * s - 1.0)).sum();
                stretches(across).map(|s| match law {
                    HyperelasticLaw::NeoHookean => shear * (s * s - 1.0) + lambda * volume.ln(),
                    HyperelasticLaw::SaintVenantKirchhoff => s * s * (lambda * green + shear * (s * s - 1.0)),
                    HyperelasticLaw::Hencky => 2.0 * shear * s.ln() + lambda * volume.ln(),
                })
            };
            let [mut low, mut high] = [0.5, 1.2];
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if kirchhoff(middle)[2] < 0.0 { low = middle } else { high = middle }
            }
            let volume = 1.3 * 0.9 * low;
            let sheet = Elastic::plane_stress(1.0, 0.4, 1.0, 1.0).unwrap();
            let found = sheet.with_kinematics(Kinematics::Finite(law)).unwrap().stress(&[[0.3, 0.0], [0.0, -0.1]]);
            for a in 0..2 {
                let expected = kirchhoff(low)[a] / volume;
                assert!((found[a][a] - expected).abs() < 1e-13, "{law:?}: {} against {expected}", found[a][a]);
            }
        }
    }

    #[test]
    fn elements_that_are_inside_out_have_no_energy() {
        for law in plane_laws() {
            assert!(respond(&law, &[[-1.2, 0.0], [0.0, 0.1]]).1.is_nan(), "{law:?}");
            assert!(respond(&law, &[[-2.1, 0.0], [0.0, -2.1]]).1.is_finite(), "{law:?}: half a turn");
        }
        for law in LAWS {
            let bar = Elastic::bar(1.0, 1.0, 1.0).unwrap().with_kinematics(Kinematics::Finite(law)).unwrap();
            assert!(respond(&bar, &[[-1.1]]).1.is_nan(), "{law:?}");
        }
    }
}
