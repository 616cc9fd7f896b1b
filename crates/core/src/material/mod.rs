//! Material laws for small strains: the trait [`Law`] and one file for each law.
//!
//! A sweep over elements is generic over the law. Nothing is dispatched at run time.

mod elastic;

pub use elastic::{Elastic, Hypothesis};
use thiserror::Error;

/// Why a material was refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("`{name}` is {value} {unit}; it must be {allowed}")]
pub struct MaterialError {
    /// The parameter.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What is allowed.
    pub allowed: &'static str,
}

/// A tensor of second order in `D` dimensions.
pub type Tensor<const D: usize> = [[f64; D]; D];

/// A law between the displacement gradient ∂u_a/∂x_b and the stress (Pa), with the density and the extent of
/// the body across the mesh.
pub trait Law {
    /// Density ρ (kg/m³).
    fn density(&self) -> f64;

    /// Section (m²) of a bar, thickness (m) of a plane body. It turns a length or an area of the mesh into a
    /// volume, and a face into an area.
    fn extent(&self) -> f64;

    /// Largest wave speed in the undeformed body, in the dimension of the mesh (m/s).
    fn wave_speed(&self) -> f64;

    /// ρc² with the largest wave speed (Pa): the stiffness of a wave.
    fn wave_modulus(&self) -> f64 {
        self.density() * self.wave_speed() * self.wave_speed()
    }

    /// Stress σ (Pa) of a displacement gradient.
    fn stress<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D>;

    /// Normal stress (Pa) across the mesh, in the dimension that a plane body leaves out.
    fn stress_across<const D: usize>(&self, gradient: &Tensor<D>) -> f64;

    /// First-order change of the stress (Pa) for a change of the gradient.
    fn tangent<const D: usize>(&self, gradient: &Tensor<D>, change: &Tensor<D>) -> Tensor<D>;

    /// Strain energy φ(ε) (J/m³).
    fn strain_energy<const D: usize>(&self, gradient: &Tensor<D>) -> f64;

    /// Complementary energy φ*(σ) (J/m³). Legendre–Fenchel: φ(ε) + φ*(σ) ≥ σ:ε, and equal where σ obeys the law.
    fn complementary_energy<const D: usize>(&self, stress: &Tensor<D>) -> f64;
}

/// A law with a constant tangent K. Methods that are valid for such laws only ask for this trait: internal
/// forces from scaled gradients, the element bound on ω_max, the correction of the mass by K ã, energies as
/// quadratic forms that do not change with time, and products of energy by polarisation.
pub trait LinearLaw: Law {
    /// The factors (α, β) of τ : K⁻¹ : τ = α τ:τ − β (tr τ)² (1/Pa).
    fn compliance<const D: usize>(&self) -> (f64, f64);

    /// Lamé's moduli λ and G of σ = λ tr ε 1 + 2G ε, in the dimension of the mesh (Pa).
    fn moduli(&self) -> (f64, f64);
}

/// The sum of products of entries, a:b.
fn contract<const D: usize>(a: &Tensor<D>, b: &Tensor<D>) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
}
