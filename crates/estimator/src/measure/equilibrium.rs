//! Residuals of the equilibrium of an element.

use super::{Balanced, ElementMeasure};
use crate::residual::{Residuals, worse};
use percute_core::material::Law;
use percute_core::simd::lanes::Value;

impl<const D: usize, const N: usize> ElementMeasure<'_, D, N> {
    /// Residuals of the pointwise equilibrium of σ_DA; `scale` is the largest nodal force in the
    /// mesh (N).
    pub(crate) fn check_stress(&self, balanced: &Balanced<D, N>, scale: f64, residuals: &mut Residuals) {
        let stress = self.stress_map().residuals(&balanced.loading, self.floor(balanced, scale));
        residuals.divergence = worse(residuals.divergence, stress.divergence);
        residuals.edge_tractions = worse(residuals.edge_tractions, stress.edges);
        residuals.inner_tractions = worse(residuals.inner_tractions, stress.inner);
    }

    /// The smallest force that counts, per unit of section or thickness: 1e-12 of the largest in
    /// the mesh, or the force of f_d or of the lumped inertia at a node.
    #[inline(always)]
    fn floor<T: Value>(&self, balanced: &Balanced<D, N, T>, scale: T) -> T {
        (scale * 1e-12).max(balanced.terms * (self.element.volume / N as f64)) * (1.0 / self.law.extent())
    }

    /// Residual of the balance of the element as a whole: resultant of tractions less Γ_DA − f_d, and their moments
    /// about the centroid, one in each coordinate plane.
    #[inline(always)]
    pub(crate) fn resultant_residual<T: Value>(&self, balanced: &Balanced<D, N, T>, scale: T) -> T {
        let floor = self.floor(balanced, scale);
        let zero = floor.zero();
        let (mut resultant, mut moments) = ([zero; D], [[zero; D]; D]);
        // Tractions one by one: at a node between a fixed edge and elements at rest two of them cancel.
        let mut scale = zero;
        for t in balanced.loading.traction.as_flattened().as_flattened() {
            scale = scale.max(t.abs());
        }
        scale = floor.max(scale * (1.0 / (D * (D + 1)) as f64));
        for (force, arm) in balanced.forces.iter().zip(&self.arms) {
            for c in 0..D {
                resultant[c] += force.outer[c] - force.inner[c];
                scale = scale.max(force.outer[c].abs()).max(force.inner[c].abs());
            }
            let net = |c: usize| force.outer[c] - force.inner[c];
            for b in 1..D {
                for a in 0..b {
                    moments[a][b] += net(b) * arm[a] - net(a) * arm[b];
                }
            }
        }
        let mut miss = zero;
        for moment in moments.as_flattened() {
            miss = miss.worse((*moment * self.inverse_reach).abs());
        }
        for force in &resultant {
            miss = miss.worse(force.abs());
        }
        miss / scale.max(zero.fill(f64::MIN_POSITIVE))
    }
}
