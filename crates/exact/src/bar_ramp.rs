//! A clamped bar under a traction that grows linearly in time.

/// A uniform bar on [0, L], clamped at x = 0, undeformed and at rest, with a traction rt (Pa) on its end from t = 0 on.
///
/// Sources: the modal series is that of Timoshenko, *Vibration Problems in Engineering*, longitudinal vibrations under
/// a force at the end: with k_n = (n − ½)π/L and ω_n = k_n c,
///
/// u = rtx/E − Σ (2r (−1)ⁿ⁺¹/(ρLω_n³)) sin(k_n x) sin(ω_n t).
///
/// The same in d'Alembert's form, which is a finite sum, with G(τ) = rτ₊²/(2ρc):
///
/// u = Σ_k (−1)ᵏ [G(t − ((2k+1)L − x)/c) − G(t − ((2k+1)L + x)/c)].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarRamp {
    /// L (m).
    pub length: f64,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Section S (m²).
    pub section: f64,
    /// r (Pa/s).
    pub rate: f64,
}

impl BarRamp {
    /// c = √(E/ρ) (m/s).
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// The waves that have passed x before t: sign, direction (1 from the end, −1 from the clamp) and time since then.
    fn waves(&self, x: f64, t: f64) -> impl Iterator<Item = (f64, f64, f64)> {
        let (length, c) = (self.length, self.wave_speed());
        let count = (0.5 * (c * t / length + 1.0)).max(0.0).ceil() as u32;
        (0..count).flat_map(move |k| {
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            let way = f64::from(2 * k + 1) * length;
            [(sign, 1.0, (t - (way - x) / c).max(0.0)), (-sign, -1.0, (t - (way + x) / c).max(0.0))]
        })
    }

    /// Displacement (m).
    #[must_use]
    pub fn displacement(&self, x: f64, t: f64) -> f64 {
        let factor = 0.5 * self.rate / (self.density * self.wave_speed());
        factor * self.waves(x, t).map(|(sign, _, since)| sign * since * since).sum::<f64>()
    }

    /// Velocity (m/s).
    #[must_use]
    pub fn velocity(&self, x: f64, t: f64) -> f64 {
        let factor = self.rate / (self.density * self.wave_speed());
        factor * self.waves(x, t).map(|(sign, _, since)| sign * since).sum::<f64>()
    }

    /// Normal force (N), tension positive.
    #[must_use]
    pub fn normal_force(&self, x: f64, t: f64) -> f64 {
        self.section * self.rate * self.waves(x, t).map(|(sign, way, since)| sign * way * since).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// c = 3 m/s, L/c = 2 s.
    const BAR: BarRamp = BarRamp { length: 6.0, young: 18.0, density: 2.0, section: 0.1, rate: 0.4 };

    /// The modal series up to a number of modes (m). The remainder is below r L²/(3 E c n²) for n modes.
    fn modal_displacement(bar: &BarRamp, x: f64, t: f64, modes: u32) -> f64 {
        let c = bar.wave_speed();
        let mode = |n: u32| {
            let k = (f64::from(n) - 0.5) * PI / bar.length;
            let sign = if n % 2 == 1 { 1.0 } else { -1.0 };
            sign * 2.0 * bar.rate / (bar.density * bar.length * (k * c).powi(3)) * (k * x).sin() * (k * c * t).sin()
        };
        bar.rate * t * x / bar.young - (1..=modes).rev().map(mode).sum::<f64>()
    }

    /// 2r/(ρL(πc/L)³) Σ_{m>n} (m − ½)⁻³ is below 2rL²/(π³Ec)/(2(n − ½)²), less than rL²/(3Ecn²) for large n.
    #[test]
    fn waves_and_modes_are_the_same() {
        let modes = 3000;
        let left_out = 0.4 * 36.0 / (3.0 * 18.0 * 3.0 * f64::from(modes).powi(2));
        for i in 0..40 {
            let t = 0.31 * f64::from(i);
            for x in [0.0, 0.7, 2.9, 5.5, 6.0] {
                let (waves, series) = (BAR.displacement(x, t), modal_displacement(&BAR, x, t, modes));
                // The largest displacement is 0.5.
                assert!((waves - series).abs() < left_out + 1e-13, "{waves} against {series} at {x}, {t}");
            }
        }
    }

    /// Slopes of u are v and N/(ES), and ρSv̇ = N'. u is quadratic: rounding of the differences only.
    #[test]
    fn equations_of_motion() {
        let h = 1e-4;
        for t in [0.3, 1.7, 2.77, 3.9, 6.3, 9.1] {
            for x in [0.4, 1.9, 3.3, 5.2] {
                let in_time = |f: &dyn Fn(f64) -> f64| (f(t + h) - f(t - h)) / (2.0 * h);
                let in_space = |f: &dyn Fn(f64) -> f64| (f(x + h) - f(x - h)) / (2.0 * h);
                assert!((in_time(&|t| BAR.displacement(x, t)) - BAR.velocity(x, t)).abs() < 1e-10, "{x}, {t}");
                assert!(
                    (1.8 * in_space(&|x| BAR.displacement(x, t)) - BAR.normal_force(x, t)).abs() < 1e-10,
                    "{x}, {t}"
                );
                let inertia = 0.2 * in_time(&|t| BAR.velocity(x, t));
                assert!((inertia - in_space(&|x| BAR.normal_force(x, t))).abs() < 1e-10, "{x}, {t}");
            }
        }
    }

    /// The clamp does not move, the end has the traction, and at t = 0 the bar is undeformed and at rest.
    #[test]
    fn start_and_ends() {
        for i in 0..50 {
            let t = 0.23 * f64::from(i);
            assert_eq!((BAR.displacement(0.0, t), BAR.velocity(0.0, t)), (0.0, 0.0));
            // Rounding of a few differences of times.
            assert!((BAR.normal_force(6.0, t) - 0.04 * t).abs() < 1e-14, "{t}");
        }
        assert_eq!((BAR.displacement(3.0, 0.0), BAR.velocity(3.0, 0.0), BAR.normal_force(3.0, 0.0)), (0.0, 0.0, 0.0));
    }
}
