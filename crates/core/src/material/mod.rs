//! Material laws: the traits [`Law`], [`PointLaw`] and [`LinearLaw`], and one file for each law.
//!
//! A sweep over elements is generic over the law. Nothing is dispatched at run time.

mod elastic;
mod hardening;
mod hyperelastic;
mod kinematics;
mod metric;
mod stability;
mod von_mises;

pub use elastic::{Elastic, Hypothesis};
pub use hardening::Hardening;
pub use hyperelastic::{HyperelasticLaw, Response, first_stress, green_strain, volume_ratio};
pub use kinematics::Kinematics;
pub use metric::StressMetric;
pub use von_mises::{FlowForces, FourComponents, PlasticState, VonMises};

use crate::simd::lanes::Value;
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

/// Checks one parameter; NaN fails every test.
fn require(
    ok: bool,
    name: &'static str,
    value: f64,
    unit: &'static str,
    allowed: &'static str,
) -> Result<(), MaterialError> {
    if ok && value.is_finite() { Ok(()) } else { Err(MaterialError { name, value, unit, allowed }) }
}

/// A tensor of second order in `D` dimensions.
pub type Tensor<const D: usize> = [[f64; D]; D];

/// A law between the displacement gradient H = ∂u_a/∂X_b and the stress (Pa), with the density and the extent of the
/// body across the mesh.
pub trait Law {
    /// Density ρ (kg/m³).
    fn density(&self) -> f64;

    /// Section (m²) of a bar, thickness (m) of a plane body, 1 of a solid. It turns a length or an area of the mesh
    /// into a volume, and a face into an area.
    fn extent(&self) -> f64;

    /// Largest wave speed in the undeformed body, in the dimension of the mesh (m/s).
    fn wave_speed(&self) -> f64;

    /// ρc² with the largest wave speed (Pa): the stiffness of a wave.
    fn wave_modulus(&self) -> f64 {
        self.density() * self.wave_speed() * self.wave_speed()
    }

    /// Strain: ε = sym H, eq. \[5\], or the Green strain E = ½(FᵀF − 1) of a finite law.
    fn strain<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D>;

    /// Stress σ (Pa), force per present area.
    fn stress<const D: usize>(&self, gradient: &Tensor<D>) -> Tensor<D>;

    /// Normal stress (Pa) across the mesh, in the dimension that a plane body leaves out; σ_zz of a solid.
    fn stress_across<const D: usize>(&self, gradient: &Tensor<D>) -> f64;

    /// Strain energy φ per undeformed volume (J/m³).
    fn strain_energy<const D: usize>(&self, gradient: &Tensor<D>) -> f64;
}

/// A law as the points of a body obey it, at one or at eight of them.
pub trait PointLaw: Copy + Send + Sync {
    /// Number of internal variables of a point of a body with this dimension, at most [`MOST_VARIABLES`].
    fn variables<const D: usize>() -> usize;

    /// First Piola–Kirchhoff stress P (Pa) of H = ∂u_a/∂X_b, with the work of P in dH, and the strain energy per
    /// reference volume (J/m³). Takes the internal variables from the last instant to this one.
    fn respond<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], internal: &mut [V]) -> Response<V, D>;

    /// A bound on the largest eigenvalue of (1⊗R) ∂P/∂F (1⊗R) for a symmetric R (1/m): that of K_T of an element over
    /// its volume (Pa/m²), if R² = Σ ∇φ_i⊗∇φ_i.
    fn stiffness_bound<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], root: &[[V; D]; D]) -> V;

    /// Positive where this eigenvalue, of R² = `square`, is above a limit (Pa/m²), and nowhere else: much faster than
    /// the bound.
    fn stiffness_excess<V: Value, const D: usize>(&self, gradient: &[[V; D]; D], square: &[[V; D]; D], limit: f64)
    -> V;
}

/// Room for internal variables of a point.
pub const MOST_VARIABLES: usize = 8;

/// A law with a constant tangent K. Methods that are valid for such laws only ask for this trait: internal
/// forces from scaled gradients, the element bound on ω_max, the correction of the mass by K ã, energies as
/// quadratic forms that do not change with time, and products of energy by polarisation.
pub trait LinearLaw: Law {
    /// Complementary energy φ*(σ) (J/m³). Legendre–Fenchel: φ(ε) + φ*(σ) ≥ σ:ε, and equal where σ obeys the law.
    fn complementary_energy<const D: usize>(&self, stress: &Tensor<D>) -> f64;

    /// The factors (α, β) of τ : K⁻¹ : τ = α τ:τ − β (tr τ)² (1/Pa).
    fn compliance<const D: usize>(&self) -> (f64, f64);

    /// Lamé's moduli λ and G of σ = λ tr ε 1 + 2G ε, in the dimension of the mesh (Pa).
    fn moduli(&self) -> (f64, f64);
}

/// ½(H + Hᵀ).
pub(crate) fn symmetric<const D: usize>(gradient: &Tensor<D>) -> Tensor<D> {
    std::array::from_fn(|a| std::array::from_fn(|b| 0.5 * (gradient[a][b] + gradient[b][a])))
}

/// The sum of products of entries, a:b.
fn contract<const D: usize>(a: &Tensor<D>, b: &Tensor<D>) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
}
