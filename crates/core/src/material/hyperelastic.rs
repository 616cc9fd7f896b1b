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
    let one = h[0][0].fill(1.0);
    let e = dilatation(h);
    let (mut log, mut rest) = log_and_rest(e);
    if moduli.free_thickness {
        let (log_z, rest_z) = log_and_rest(across(moduli, log));
        log += log_z * 0.5;
        rest += rest_z * 0.5;
    }
    let inverse = one / (one + e);
    let scaled = log * moduli.lambda;
    let mut stress = *h;
    // J F − cof F, without the difference of numbers near 1.
    let shear = |a: usize, b: usize, cofactor: V| (h[a][b] * e + cofactor) * moduli.shear;
    if D == 1 {
        // F − 1/F.
        stress[0][0] = ((h[0][0] * h[0][0] + h[0][0] * 2.0) * moduli.shear + scaled) * inverse;
        let square = h[0][0] * h[0][0];
        let energy = (square + rest * 2.0) * (0.5 * moduli.shear) + log * scaled * 0.5;
        return (stress, energy);
    }
    let (sum, difference) = (h[0][1] + h[1][0], h[0][0] - h[1][1]);
    stress[0][0] = (shear(0, 0, e + difference) + scaled * (one + h[1][1])) * inverse;
    stress[1][1] = (shear(1, 1, e - difference) + scaled * (one + h[0][0])) * inverse;
    stress[0][1] = (shear(0, 1, sum) - scaled * h[1][0]) * inverse;
    stress[1][0] = (shear(1, 0, sum) - scaled * h[0][1]) * inverse;
    let energy = (difference * difference + sum * sum + rest * 2.0) * (0.5 * moduli.shear) + log * scaled * 0.5;
    (stress, energy)
}

/// C₃₃ − 1 of a body whose stress across is 0, from ln J in its plane: μ z + λ (ln J + ½ ln(1 + z)) = 0.
#[inline(always)]
pub(super) fn across<V: Value>(&Moduli { lambda, shear, .. }: &Moduli, log: V) -> V {
    let one = log.fill(1.0);
    let mut z = log * (-2.0 * lambda / (2.0 * shear + lambda));
    z = z.max(log.fill(-0.9));
    // Newton's error falls from below 0.1 to below rounding in five steps.
    for _ in 0..8 {
        let residual = z * shear + (log + log_and_rest(z).0 * 0.5) * lambda;
        let slope = (one / (one + z)) * (0.5 * lambda) + log.fill(shear);
        // 1 + z falls to a tenth at the most.
        z = (z - residual / slope).max(z * 0.1 - log.fill(0.9));
    }
    z
}

/// P = F S with S = λ tr E + 2G E.
#[inline(always)]
fn saint_venant_kirchhoff<V: Value, const D: usize>(moduli: &Moduli, h: &[[V; D]; D]) -> Response<V, D> {
    let strain = green_strain(h);
    let mut trace = strain[0][0];
    (1..D).for_each(|a| trace += strain[a][a]);
    let mut second = [[trace; D]; D];
    let mut energy = trace * trace * (0.5 * moduli.lambda);
    for a in 0..D {
        for b in 0..D {
            second[a][b] = strain[a][b] * (2.0 * moduli.shear);
            energy += strain[a][b] * strain[a][b] * moduli.shear;
        }
        second[a][a] += trace * moduli.lambda;
    }
    (first_stress(h, &second), energy + inside_out(h))
}

/// S = Σ (2G h_a + λ Σh)/λ_a² N_a⊗N_a on the principal axes N_a of C, with the stretches λ_a and h_a = ln λ_a.
#[inline(always)]
fn hencky<V: Value, const D: usize>(moduli: &Moduli, h: &[[V; D]; D]) -> Response<V, D> {
    let (strain, one) = (green_strain(h), h[0][0].fill(1.0));
    if D == 1 {
        let log = log_and_rest(strain[0][0] * 2.0).0 * 0.5;
        let modulus = moduli.lambda + 2.0 * moduli.shear;
        let second = log * modulus / (one + strain[0][0] * 2.0);
        return (first_stress(h, &[[second; D]; D]), log * log * (0.5 * modulus) + inside_out(h));
    }
    let (mean, half) = ((strain[0][0] + strain[1][1]) * 0.5, (strain[0][0] - strain[1][1]) * 0.5);
    // The smallest number keeps the quotient finite where the deviator is 0.
    let radius = (half * half + strain[0][1] * strain[0][1]).sqrt().max(mean.fill(f64::MIN_POSITIVE));
    let principal = [mean + radius, mean - radius];
    let logs = principal.map(|e| log_and_rest(e * 2.0).0 * 0.5);
    let trace = logs[0] + logs[1];
    let kirchhoff = logs.map(|log| log * (2.0 * moduli.shear) + trace * moduli.lambda);
    let seconds = [kirchhoff[0] / (one + principal[0] * 2.0), kirchhoff[1] / (one + principal[1] * 2.0)];
    let (spherical, deviator) = ((seconds[0] + seconds[1]) * 0.5, (seconds[0] - seconds[1]) * 0.5 / radius);
    let mut second = *h;
    second[0][0] = spherical + deviator * half;
    second[1][1] = spherical - deviator * half;
    (second[0][1], second[1][0]) = (deviator * strain[0][1], deviator * strain[0][1]);
    let squares = logs[0] * logs[0] + logs[1] * logs[1];
    let energy = squares * moduli.shear + trace * trace * (0.5 * moduli.lambda);
    (first_stress(h, &second), energy + inside_out(h))
}

/// E = ½ (H + Hᵀ + HᵀH).
#[inline(always)]
pub(super) fn green_strain<V: Value, const D: usize>(h: &[[V; D]; D]) -> [[V; D]; D] {
    let mut strain = *h;
    for a in 0..D {
        for b in 0..D {
            let mut sum = h[a][b] + h[b][a];
            (0..D).for_each(|c| sum += h[c][a] * h[c][b]);
            strain[a][b] = sum * 0.5;
        }
    }
    strain
}

/// P = F S.
#[inline(always)]
fn first_stress<V: Value, const D: usize>(h: &[[V; D]; D], second: &[[V; D]; D]) -> [[V; D]; D] {
    let mut first = *second;
    for a in 0..D {
        for b in 0..D {
            (0..D).for_each(|c| first[a][b] += h[a][c] * second[c][b]);
        }
    }
    first
}

/// 0, or NaN where J < 0: these laws alone do not see it.
#[inline(always)]
fn inside_out<V: Value, const D: usize>(h: &[[V; D]; D]) -> V {
    let e = dilatation(h);
    (e + e.fill(1.0)).sqrt() * 0.0
}

/// ln(1 + e) and e − ln(1 + e), both to rounding.
///
/// With s = e/(2 + e), ln(1 + e) = 2 artanh s = 2s + 2s³ (1/3 + s²/5 + …) and e − 2s = e s.
#[inline(always)]
pub(super) fn log_and_rest<V: Value>(e: V) -> (V, V) {
    let s = e / (e + e.fill(2.0));
    let square = s * s;
    let mut series = e.fill(1.0 / (2 * TERMS + 1) as f64);
    for k in (1..TERMS).rev() {
        series = series * square + e.fill(1.0 / (2 * k + 1) as f64);
    }
    let cubic = s * square * series * 2.0;
    let (log, rest) = (s * 2.0 + cubic, e * s - cubic);
    let far = |e: f64| !(-0.3..0.4).contains(&e);
    if !e.any(far) {
        return (log, rest);
    }
    (log.replaced_where(e, far, f64::ln_1p), rest.replaced_where(e, far, |e| e - e.ln_1p()))
}

/// For e in −0.3 to 0.4, s² is below 0.032, and the first term left out, 0.032¹¹/25, below 2⁻⁵³ of 1/3.
const TERMS: usize = 11;

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
            let (log, rest) = log_and_rest(e);
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
