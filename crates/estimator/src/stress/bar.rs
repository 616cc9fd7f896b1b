//! The stress of a bar element: the quadratic that its loading determines.

use super::{Fluctuation, Loading, StressResiduals};
use crate::residual::worse;
use percute_core::material::LinearLaw;
use percute_core::simd::lanes::Value;

/// A bar element of given length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BarStress {
    length: f64,
    /// 1/E.
    compliance: f64,
}

impl BarStress {
    pub(super) fn new(length: f64, law: &impl LinearLaw) -> Self {
        let (alpha, beta) = law.compliance::<1>();
        Self { length, compliance: alpha - beta }
    }

    /// Stress at both ends and in the middle: σ(0) = −F̂_0 and σ' = Γ_DA − f_d.
    #[inline(always)]
    fn stress<T: Value, const D: usize, const N: usize>(&self, loading: &Loading<D, N, T>) -> [T; 3] {
        // Face 1, at node 0, has the outward normal −1.
        let start = -loading.traction[1][0][0];
        let (g0, g1) = (loading.volume[0][0], loading.volume[1][0]);
        let at = |s: f64| start + (g0 + (g1 - g0) * (0.5 * s)) * (self.length * s);
        [at(0.0), at(0.5), at(1.0)]
    }

    /// Coordinates of the stress without its mean: that of the mean of σ' and that of its difference.
    #[inline(always)]
    pub(super) fn fluctuation<T: Value, const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N, T>,
    ) -> Fluctuation<D, N, T> {
        let (g0, g1) = (loading.volume[0][0], loading.volume[1][0]);
        let mut fluctuation = Fluctuation::filled(g0.zero());
        // ½∫σ²/E of (L/2) s and of (L/4)(s²/2 − 1/6) on −1 < s < 1.
        let cubed = self.compliance * self.length * self.length * self.length;
        fluctuation.coordinates[0][0][0] = (g0 + g1) * (0.5 * (cubed / 24.0).sqrt());
        fluctuation.coordinates[1][0][0] = (g1 - g0) * (cubed / 1440.0).sqrt();
        fluctuation
    }

    /// By Simpson's rule, exact for a quadratic.
    pub(super) fn mean<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> f64 {
        let [a, m, b] = self.stress(loading);
        (a + 4.0 * m + b) / 6.0
    }

    pub(super) fn residuals<const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        self.residuals_of(self.stress(loading), loading, floor)
    }

    fn residuals_of<const D: usize, const N: usize>(
        &self,
        [a, m, b]: [f64; 3],
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        let scale = a.abs().max(b.abs()).max(m.abs()).max(floor).max(f64::MIN_POSITIVE);
        // Slopes of the quadratic at both ends against Γ_DA − f_d.
        let slopes = [(4.0 * m - 3.0 * a - b) / self.length, (3.0 * b + a - 4.0 * m) / self.length];
        let slope_scale = loading.volume.iter().map(|g| g[0].abs()).fold(scale / self.length, f64::max);
        let misses = slopes.iter().zip(&loading.volume).map(|(s, g)| (s - g[0]).abs() / slope_scale);
        StressResiduals {
            divergence: misses.fold(0.0, worse),
            edges: worse((a + loading.traction[1][0][0]).abs(), (b - loading.traction[0][0][0]).abs()) / scale,
            inner: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::Elastic;

    /// σ = 1 + 2x + 3x² on [0, 2] with E = 5: the mean is 7, and ½∫(σ − 7)²/E, by powers of x, follows from ∫σ².
    #[test]
    fn energy_of_a_quadratic() {
        let map = BarStress::new(2.0, &Elastic::bar(5.0, 1.0, 1.0).unwrap());
        let loading = Loading { traction: [[[17.0]], [[-1.0]]], volume: [[2.0], [14.0]] };
        let square = 2.0 + 2.0 * 4.0 + (4.0 + 6.0) * 8.0 / 3.0 + 12.0 * 4.0 + 9.0 * 32.0 / 5.0;
        let exact = 0.5 / 5.0 * (square - 49.0 * 2.0);
        let found = map.fluctuation(&loading).energy();
        assert!((found - exact).abs() < 1e-13 * exact, "{found} {exact}");
        let r = map.residuals(&loading, 0.0);
        assert!(r.divergence < 1e-14 && r.edges < 1e-14);
    }

    /// ∫(1 + 2x + 3x²) over [0, 2] is 14.
    #[test]
    fn mean_of_a_quadratic() {
        let (map, loading) = balanced();
        assert!((map.mean(&loading) - 7.0).abs() < 1e-14);
    }

    fn balanced() -> (BarStress, Loading<1, 2>) {
        let map = BarStress::new(2.0, &Elastic::bar(5.0, 1.0, 1.0).unwrap());
        (map, Loading { traction: [[[17.0]], [[-1.0]]], volume: [[2.0], [14.0]] })
    }

    /// Tractions that do not balance leave a residual there, and none elsewhere.
    #[test]
    fn wrong_tractions_show() {
        let (map, mut loading) = balanced();
        loading.traction[0] = [[17.17]];
        let found = map.residuals(&loading, 0.0);
        assert!(found.edges > 1e-3 && found.divergence < 1e-14);
    }

    /// 1 % on the stress in the middle is 1 % on the slopes; the ends stay.
    #[test]
    fn a_wrong_stress_shows_in_its_slope() {
        let (map, loading) = balanced();
        let [a, m, b] = map.stress(&loading);
        let found = map.residuals_of([a, 1.01 * m, b], &loading, 0.0);
        assert!(found.divergence > 1e-3 && found.edges < 1e-14);
    }

    #[test]
    fn nothing_in_a_bar_at_rest_and_nan_shows() {
        let (map, _) = balanced();
        let mut loading = Loading { traction: [[[0.0]], [[0.0]]], volume: [[0.0], [0.0]] };
        let rest = map.residuals(&loading, 0.0);
        assert_eq!((rest.divergence, rest.edges), (0.0, 0.0));
        loading.volume[0] = [f64::NAN];
        let found = map.residuals(&loading, 0.0);
        assert!(found.divergence.is_nan() && found.edges.is_nan());
    }
}
