//! Isotropic linear elasticity, eq. \[9\].

use super::hardening::Hardening;
use super::hyperelastic::{HyperelasticLaw, Moduli, Response, dilatation, green_strain, present_stress, volume_ratio};
use super::stability::{bound, excess};
use super::{Kinematics, Law, LinearLaw, MaterialError, PointLaw, Tensor, contract, require, symmetric};
use crate::simd::lanes::Value;

/// What the dimensions that the mesh leaves out do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hypothesis {
    /// One dimension: stress along the bar only.
    Bar,
    /// Two dimensions, no stress across them.
    PlaneStress,
    /// Two dimensions, no strain across them.
    PlaneStrain,
    /// Three dimensions: none is left out.
    Solid,
}

/// A Hooke law σ = λ tr ε 1 + 2G ε in the dimension of the mesh, with density and the extent of
/// the body across the mesh.
///
/// A bar is the case λ = 0, 2G = E; plane stress and plane strain differ in λ only, and a solid has that of plane
/// strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    hypothesis: Hypothesis,
    young: f64,
    poisson: f64,
    lambda: f64,
    shear: f64,
    density: f64,
    extent: f64,
    yield_stress: Option<f64>,
    hardening: Option<Hardening>,
    kinematics: Kinematics,
}

impl Elastic {
    /// A bar with Young's modulus (Pa), density (kg/m³) and section (m²).
    ///
    /// # Errors
    /// A value that is not positive and finite.
    pub fn bar(young: f64, density: f64, section: f64) -> Result<Self, MaterialError> {
        require(section > 0.0, "section", section, "m²", "positive")?;
        Self::checked(young, 0.0, density)?;
        let (hypothesis, shear) = (Hypothesis::Bar, young / 2.0);
        let (poisson, lambda, extent) = (0.0, 0.0, section);
        Ok(Self {
            hypothesis,
            young,
            poisson,
            lambda,
            shear,
            density,
            extent,
            yield_stress: None,
            hardening: None,
            kinematics: Kinematics::Small,
        })
    }

    /// Plane stress: Young's modulus (Pa), Poisson's ratio, density (kg/m³), thickness (m).
    ///
    /// # Errors
    /// A value out of range: ν must lie between −1 and 0.5.
    pub fn plane_stress(young: f64, poisson: f64, density: f64, thickness: f64) -> Result<Self, MaterialError> {
        let lambda = young * poisson / (1.0 - poisson * poisson);
        Self::plane(Hypothesis::PlaneStress, [young, poisson, density, thickness], lambda)
    }

    /// Plane strain: Young's modulus (Pa), Poisson's ratio, density (kg/m³), thickness (m).
    ///
    /// # Errors
    /// A value out of range: ν must lie between −1 and 0.5.
    pub fn plane_strain(young: f64, poisson: f64, density: f64, thickness: f64) -> Result<Self, MaterialError> {
        let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        Self::plane(Hypothesis::PlaneStrain, [young, poisson, density, thickness], lambda)
    }

    /// A solid: Young's modulus (Pa), Poisson's ratio, density (kg/m³).
    ///
    /// # Errors
    /// A value out of range: ν must lie between −1 and 0.5.
    pub fn solid(young: f64, poisson: f64, density: f64) -> Result<Self, MaterialError> {
        Ok(Self { hypothesis: Hypothesis::Solid, ..Self::plane_strain(young, poisson, density, 1.0)? })
    }

    fn plane(hypothesis: Hypothesis, values: [f64; 4], lambda: f64) -> Result<Self, MaterialError> {
        let [young, poisson, density, thickness] = values;
        Self::checked(young, poisson, density)?;
        require(thickness > 0.0, "thickness", thickness, "m", "positive")?;
        let shear = young / (2.0 * (1.0 + poisson));
        let (extent, kinematics) = (thickness, Kinematics::Small);
        let (yield_stress, hardening) = (None, None);
        Ok(Self { hypothesis, young, poisson, lambda, shear, density, extent, yield_stress, hardening, kinematics })
    }

    fn checked(young: f64, poisson: f64, density: f64) -> Result<(), MaterialError> {
        require(young > 0.0, "young", young, "Pa", "positive")?;
        require(poisson > -1.0 && poisson < 0.5, "poisson", poisson, "(no unit)", "above -1 and below 0.5")?;
        require(density > 0.0, "density", density, "kg/m³", "positive")
    }

    /// What the law supposes across the mesh.
    #[must_use]
    pub fn hypothesis(&self) -> Hypothesis {
        self.hypothesis
    }

    /// Poisson's ratio ν; 0 for a bar, where it does not matter.
    #[must_use]
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Young's modulus E (Pa).
    #[must_use]
    pub fn young(&self) -> f64 {
        self.young
    }

    /// The same law with a yield stress (Pa). Without hardening the law does not use it: results say where the von
    /// Mises stress is above it.
    ///
    /// # Errors
    /// A value that is not positive and finite.
    pub fn with_yield_stress(self, yield_stress: f64) -> Result<Self, MaterialError> {
        require(yield_stress > 0.0, "yield_stress", yield_stress, "Pa", "positive")?;
        Ok(Self { yield_stress: Some(yield_stress), ..self })
    }

    /// The same material that yields at its yield stress, von Mises, and hardens: [`VonMises`](super::VonMises) is its
    /// law. [`Law`] of this material gives the stress of its elastic strain.
    ///
    /// # Errors
    /// No yield stress.
    pub fn with_hardening(self, hardening: Hardening) -> Result<Self, MaterialError> {
        let missing = "given: a material that hardens has a yield stress";
        require(self.yield_stress.is_some(), "yield_stress", 0.0, "Pa", missing)?;
        Ok(Self { hardening: Some(hardening), ..self })
    }

    /// The same material with the values that are stated of its yielding, if any: yield stress (Pa), and `tangent`,
    /// `hardening` and `kinematic` as for [`Hardening::stated`].
    ///
    /// # Errors
    /// As for [`Hardening::stated`] and [`Elastic::with_yield_stress`].
    pub fn with_yielding(self, yield_stress: Option<f64>, stated: [Option<f64>; 3]) -> Result<Self, MaterialError> {
        let hardening = Hardening::stated(self.young, yield_stress, stated)?;
        let law = yield_stress.map_or(Ok(self), |stress| self.with_yield_stress(stress))?;
        hardening.map_or(Ok(law), |hardening| law.with_hardening(hardening))
    }

    /// The hardening of a material that yields.
    #[must_use]
    pub fn hardening(&self) -> Option<Hardening> {
        self.hardening
    }

    /// The same material with other kinematics. A bar has the laws for ν = 0.
    ///
    /// # Errors
    /// The neo-Hookean law in plane stress with ν < 0: in compression no thickness is in equilibrium.
    pub fn with_kinematics(self, kinematics: Kinematics) -> Result<Self, MaterialError> {
        let solves = kinematics == Kinematics::Finite(HyperelasticLaw::NeoHookean);
        if solves && self.hypothesis == Hypothesis::PlaneStress {
            let allowed = "at least 0 for law = \"neo_hookean\" in plane stress; law = \"hencky\" takes any";
            require(self.poisson >= 0.0, "poisson", self.poisson, "(no unit)", allowed)?;
        }
        Ok(Self { kinematics, ..self })
    }

    /// Which displacements the law is for.
    #[must_use]
    pub fn kinematics(&self) -> Kinematics {
        self.kinematics
    }

    /// Whether it is a law for any displacements, or else for small ones.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.kinematics != Kinematics::Small
    }

    /// Moduli of a hyperelastic law. The thickness that plane stress leaves free is part of the reduced λ, but for the
    /// neo-Hookean law, which solves for it.
    #[inline(always)]
    pub(super) fn finite(&self, law: HyperelasticLaw) -> Moduli {
        let free_thickness = self.hypothesis == Hypothesis::PlaneStress && law == HyperelasticLaw::NeoHookean;
        let in_space = self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        Moduli { lambda: if free_thickness { in_space } else { self.lambda }, shear: self.shear, free_thickness }
    }

    /// A hyperelastic law, and where it has the tangent at this gradient: with small kinematics that of any at rest.
    #[inline(always)]
    fn of_tangent<V: Value, const D: usize>(&self, gradient: &[[V; D]; D]) -> (HyperelasticLaw, [[V; D]; D]) {
        match self.kinematics {
            Kinematics::Finite(law) => (law, *gradient),
            Kinematics::Small => (HyperelasticLaw::SaintVenantKirchhoff, [[gradient[0][0].zero(); D]; D]),
        }
    }

    /// σ = P Fᵀ/J of a first Piola–Kirchhoff stress, with the thickness that the law gives a sheet.
    fn present<const D: usize>(&self, first: &Tensor<D>, gradient: &Tensor<D>) -> Tensor<D> {
        let thickness = match (self.hypothesis, self.kinematics) {
            (Hypothesis::PlaneStress, Kinematics::Finite(law)) => law.thickness(&self.finite(law), gradient),
            _ => 1.0,
        };
        present_stress(first, gradient, thickness)
    }

    /// Force per present area (Pa) of a stress in the undeformed body: σ itself with small kinematics, else
    /// σ = F S Fᵀ/J of the second Piola–Kirchhoff stress S.
    #[must_use]
    pub fn per_present_area<const D: usize>(&self, stress: &Tensor<D>, gradient: &Tensor<D>) -> Tensor<D> {
        if !self.is_finite() {
            return *stress;
        }
        let row = |a: usize, b: usize| stress[a][b] + (0..D).map(|c| gradient[a][c] * stress[c][b]).sum::<f64>();
        self.present(&std::array::from_fn(|a| std::array::from_fn(|b| row(a, b))), gradient)
    }

    /// The yield stress (Pa), if one is known.
    #[must_use]
    pub fn yield_stress(&self) -> Option<f64> {
        self.yield_stress
    }
}

impl Law for Elastic {
    #[inline]
    fn density(&self) -> f64 {
        self.density
    }

    #[inline]
    fn extent(&self) -> f64 {
        self.extent
    }

    /// √((λ + 2G)/ρ).
    fn wave_speed(&self) -> f64 {
        ((self.lambda + 2.0 * self.shear) / self.density).sqrt()
    }

    fn strain<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D> {
        match self.kinematics {
            Kinematics::Small => symmetric(gradient),
            Kinematics::Finite(_) => green_strain(gradient),
        }
    }

    /// σ = K ε, or P Fᵀ/J.
    #[inline]
    fn stress<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D> {
        let Kinematics::Finite(law) = self.kinematics else {
            return hooke(self.lambda, self.shear, gradient).0;
        };
        self.present(&law.respond(&self.finite(law), gradient).0, gradient)
    }

    /// σ_zz of a solid. Where nothing moves across: λ tr ε in plane strain, λ ln J/J or, of Saint Venant–Kirchhoff,
    /// λ tr E/J.
    fn stress_across<const D: usize>(&self, gradient: &Tensor<D>) -> f64 {
        let trace = |strain: &Tensor<D>| (0..D).map(|a| strain[a][a]).sum::<f64>();
        match (self.hypothesis, self.kinematics) {
            (Hypothesis::PlaneStress | Hypothesis::Bar, _) => 0.0,
            (Hypothesis::Solid, _) => self.stress(gradient)[D - 1][D - 1],
            (Hypothesis::PlaneStrain, Kinematics::Small) => self.lambda * trace(gradient),
            (Hypothesis::PlaneStrain, Kinematics::Finite(law)) => {
                let volume = match law {
                    HyperelasticLaw::NeoHookean | HyperelasticLaw::Hencky => dilatation(gradient).ln_1p(),
                    HyperelasticLaw::SaintVenantKirchhoff => trace(&green_strain(gradient)),
                };
                self.lambda * volume / volume_ratio(gradient)
            }
        }
    }

    fn strain_energy<const D: usize>(&self, gradient: &Tensor<D>) -> f64 {
        match self.kinematics {
            Kinematics::Small => 0.5 * contract(&self.stress(gradient), gradient),
            Kinematics::Finite(law) => law.respond(&self.finite(law), gradient).1,
        }
    }
}

impl PointLaw for Elastic {
    fn variables<const D: usize>() -> usize {
        0
    }

    #[inline(always)]
    fn respond<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], _: &mut [V]) -> Response<V, D> {
        let Kinematics::Finite(law) = self.kinematics else {
            return hooke(self.lambda, self.shear, gradient);
        };
        law.respond(&self.finite(law), gradient)
    }

    #[inline(always)]
    fn stiffness_bound<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], root: &[[V; D]; D]) -> V {
        let (law, gradient) = self.of_tangent(gradient);
        bound(law, &self.finite(law), &gradient, root)
    }

    #[inline(always)]
    fn stiffness_excess<V: Value, const D: usize>(
        &self,
        gradient: &[[V; D]; D],
        square: &[[V; D]; D],
        limit: f64,
    ) -> V {
        let (law, gradient) = self.of_tangent(gradient);
        excess(law, &self.finite(law), &gradient, square, limit)
    }
}

/// σ = λ tr ε 1 + 2G ε and ½ σ:ε.
#[inline(always)]
fn hooke<V: Value, const D: usize>(lambda: f64, shear: f64, gradient: &[[V; D]; D]) -> Response<V, D> {
    let mut trace = gradient[0][0];
    (1..D).for_each(|a| trace += gradient[a][a]);
    let (mut stress, mut energy) = (*gradient, trace.zero());
    for a in 0..D {
        for b in 0..D {
            stress[a][b] = (gradient[a][b] + gradient[b][a]) * shear;
        }
        stress[a][a] += trace * lambda;
    }
    for a in 0..D {
        (0..D).for_each(|b| energy += stress[a][b] * gradient[a][b] * 0.5);
    }
    (stress, energy)
}

impl LinearLaw for Elastic {
    fn complementary_energy<const D: usize>(&self, stress: &Tensor<D>) -> f64 {
        let (alpha, beta) = self.compliance::<D>();
        let trace = (0..D).map(|a| stress[a][a]).sum::<f64>();
        0.5 * (alpha * contract(stress, stress) - beta * trace * trace)
    }

    fn compliance<const D: usize>(&self) -> (f64, f64) {
        let alpha = 0.5 / self.shear;
        (alpha, alpha * self.lambda / (D as f64 * self.lambda + 2.0 * self.shear))
    }

    #[inline]
    fn moduli(&self) -> (f64, f64) {
        (self.lambda, self.shear)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> [Elastic; 4] {
        [
            Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0).unwrap(),
            Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0).unwrap(),
            Elastic::plane_strain(3.0, 0.45, 1.0, 2.0).unwrap(),
            Elastic::plane_stress(1.0, -0.4, 1.0, 1.0).unwrap(),
        ]
    }

    proptest::proptest! {
        /// Legendre–Fenchel: φ(ε) + φ*(σ) − σ:ε is 0 for σ = Kε, and is positive by ½ Δσ:K⁻¹Δσ for σ = Kε + Δσ. The
        /// tolerance allows for the rounding of about ten operations on terms as large as the energy.
        #[test]
        fn energies_are_conjugate(entries in proptest::array::uniform8(-1e-3..1e-3)) {
            let [a, b, c, d, xx, xy, yy, _] = entries;
            let gradient = [[a, b], [c, d]];
            for law in laws() {
                let stress = law.stress(&gradient);
                let gap = |stress: &Tensor<2>| {
                    law.strain_energy(&gradient) + law.complementary_energy(stress) - contract(stress, &gradient)
                };
                let change = [[xx * law.young(), xy * law.young()], [xy * law.young(), yy * law.young()]];
                let other: Tensor<2> = std::array::from_fn(|i| std::array::from_fn(|j| stress[i][j] + change[i][j]));
                let scale = law.strain_energy(&gradient) + law.complementary_energy(&change);
                proptest::prop_assert!(gap(&stress).abs() <= 1e-13 * scale);
                proptest::prop_assert!((gap(&other) - law.complementary_energy(&change)).abs() <= 1e-13 * scale);
            }
        }

        /// Stress is the derivative of the strain energy. A central difference is exact for a quadratic function.
        #[test]
        fn stress_is_the_derivative_of_the_energy(entries in proptest::array::uniform8(-1e-3..1e-3)) {
            let [a, b, c, d, e, f, g, h] = entries;
            let (gradient, change) = ([[a, b], [c, d]], [[e, f], [g, h]]);
            let moved = |s: f64| -> Tensor<2> {
                std::array::from_fn(|i| std::array::from_fn(|j| gradient[i][j] + s * change[i][j]))
            };
            for law in laws() {
                let (after, before) = (moved(0.5), moved(-0.5));
                let work = contract(&law.stress(&gradient), &change);
                let scale = law.strain_energy(&after) + law.strain_energy(&before);
                let slope = law.strain_energy(&after) - law.strain_energy(&before);
                proptest::prop_assert!((slope - work).abs() <= 1e-13 * scale);
            }
        }
    }

    /// Plane stress stretched along x alone: σ_xx = E/(1−ν²) ε. Plane strain: E(1−ν)/((1+ν)(1−2ν)) ε.
    #[test]
    fn uniaxial_moduli() {
        let gradient = [[1e-3, 0.0], [0.0, 0.0]];
        let stress = Elastic::plane_stress(2.0, 0.25, 1.0, 1.0).unwrap().stress(&gradient)[0][0];
        assert!((stress - 2.0 / (1.0 - 0.0625) * 1e-3).abs() < 1e-17);
        let strain = Elastic::plane_strain(2.0, 0.25, 1.0, 1.0).unwrap().stress(&gradient)[0][0];
        assert!((strain - 2.0 * 0.75 / (1.25 * 0.5) * 1e-3).abs() < 1e-17);
        assert_eq!(Elastic::bar(3.0, 1.0, 1.0).unwrap().stress(&[[2.0]])[0][0], 6.0);
    }

    #[test]
    fn impossible_values_are_named() {
        assert_eq!(Elastic::plane_strain(1.0, 0.5, 1.0, 1.0).unwrap_err().name, "poisson");
        assert_eq!(Elastic::bar(f64::NAN, 1.0, 1.0).unwrap_err().name, "young");
        assert_eq!(Elastic::plane_stress(1.0, 0.3, 0.0, 1.0).unwrap_err().name, "density");
        assert_eq!(Elastic::bar(1.0, 1.0, -1.0).unwrap_err().name, "section");
        let auxetic = Elastic::plane_stress(1.0, -0.1, 1.0, 1.0).unwrap();
        let finite = |law| auxetic.with_kinematics(Kinematics::Finite(law)).map_err(|error| error.name);
        assert_eq!(finite(HyperelasticLaw::NeoHookean), Err("poisson"));
        assert!(finite(HyperelasticLaw::Hencky).is_ok());
        assert_eq!(Elastic::bar(1.0, 1.0, 1.0).unwrap().with_yield_stress(0.0).unwrap_err().name, "yield_stress");
    }
}
