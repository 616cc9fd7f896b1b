//! Standing waves of a uniform bar.

use std::f64::consts::PI;

/// Supports of the ends of a bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BarEnds {
    /// x = 0 fixed, x = L free: φ = sin((n − ½)πx/L), n ≥ 1.
    FixedFree,
    /// Both fixed: φ = sin(nπx/L), n ≥ 1.
    FixedFixed,
    /// Both free: φ = cos(nπx/L); n = 0 is a translation that does not vibrate.
    FreeFree,
}

/// A standing wave u = A φ(x) cos(ωt + θ) of a uniform bar on [0, L], ω = kc.
///
/// Source: Timoshenko, *Vibration Problems in Engineering*, longitudinal vibrations of prismatic
/// bars; φ'' = −k²φ and ü = c²u'' with c = √(E/ρ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarMode {
    /// Supports of the ends.
    pub ends: BarEnds,
    /// n.
    pub number: u32,
    /// L (m).
    pub length: f64,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Section S (m²).
    pub section: f64,
    /// A (m).
    pub amplitude: f64,
    /// θ (rad): 0 starts displaced and at rest, −π/2 undeformed and moving.
    pub phase: f64,
}

impl BarMode {
    /// k (rad/m).
    #[must_use]
    pub fn wave_number(&self) -> f64 {
        let n = f64::from(self.number);
        let halves = if self.ends == BarEnds::FixedFree { n - 0.5 } else { n };
        halves * PI / self.length
    }

    /// ω = k√(E/ρ) (rad/s).
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        self.wave_number() * (self.young / self.density).sqrt()
    }

    /// φ and φ' (1/m) at x.
    fn shape(&self, x: f64) -> (f64, f64) {
        let k = self.wave_number();
        let (sin, cos) = (k * x).sin_cos();
        if self.ends == BarEnds::FreeFree { (cos, -k * sin) } else { (sin, k * cos) }
    }

    /// Displacement (m).
    #[must_use]
    pub fn displacement(&self, x: f64, t: f64) -> f64 {
        self.amplitude * self.shape(x).0 * (self.angular_frequency() * t + self.phase).cos()
    }

    /// Velocity (m/s).
    #[must_use]
    pub fn velocity(&self, x: f64, t: f64) -> f64 {
        let omega = self.angular_frequency();
        -self.amplitude * omega * self.shape(x).0 * (omega * t + self.phase).sin()
    }

    /// Normal force ES u' (N), tension positive.
    #[must_use]
    pub fn normal_force(&self, x: f64, t: f64) -> f64 {
        let stiffness = self.young * self.section;
        stiffness * self.amplitude * self.shape(x).1 * (self.angular_frequency() * t + self.phase).cos()
    }

    /// Kinetic plus strain energy (J), the same at all times: ¼ρSL A²ω².
    #[must_use]
    pub fn energy(&self) -> f64 {
        let speed = self.amplitude * self.angular_frequency();
        0.25 * self.density * self.section * self.length * speed * speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modes() -> impl Iterator<Item = BarMode> {
        [BarEnds::FixedFree, BarEnds::FixedFixed, BarEnds::FreeFree].into_iter().flat_map(|ends| {
            [1, 2, 5].into_iter().map(move |number| BarMode {
                ends,
                number,
                length: 2.0,
                young: 12.0,
                density: 3.0,
                section: 0.5,
                amplitude: 0.7,
                phase: 0.4,
            })
        })
    }

    /// Central differences of u and v against v, N and ρS v̇ = N'. Their error is (kh)²/6 relative:
    /// k ≤ 5π/2 and h = 1e-4 give 1e-7, rounding 1e-16/1e-4.
    #[test]
    fn equations_of_motion() {
        let h = 1e-4;
        for mode in modes() {
            let scale = mode.amplitude * mode.angular_frequency().powi(2) * 10.0;
            for (x, t) in [(0.3, 0.2), (1.1, 0.9), (1.7, 2.3)] {
                let in_time = |f: &dyn Fn(f64) -> f64| (f(t + h) - f(t - h)) / (2.0 * h);
                let in_space = |f: &dyn Fn(f64) -> f64| (f(x + h) - f(x - h)) / (2.0 * h);
                let velocity = in_time(&|t| mode.displacement(x, t));
                assert!((velocity - mode.velocity(x, t)).abs() < 1e-6 * scale, "{mode:?}");
                let force = 6.0 * in_space(&|x| mode.displacement(x, t));
                assert!((force - mode.normal_force(x, t)).abs() < 1e-6 * scale, "{mode:?}");
                let inertia = 1.5 * in_time(&|t| mode.velocity(x, t));
                let divergence = in_space(&|x| mode.normal_force(x, t));
                assert!((inertia - divergence).abs() < 1e-6 * scale, "{mode:?}");
            }
        }
    }

    /// Fixed ends do not move, free ends have no force; sin(nπ) is 0 to n·1e-16, times ES A k.
    #[test]
    fn ends() {
        for mode in modes() {
            let t = 0.37;
            let [u0, u1] = [0.0, 2.0].map(|x| mode.displacement(x, t).abs());
            let [n0, n1] = [0.0, 2.0].map(|x| mode.normal_force(x, t).abs());
            let zero = match mode.ends {
                BarEnds::FixedFree => [u0, n1],
                BarEnds::FixedFixed => [u0, u1],
                BarEnds::FreeFree => [n0, n1],
            };
            assert!(zero.iter().all(|z| *z < 1e-13), "{mode:?}: {zero:?}");
        }
    }

    /// The midpoint sum of a trigonometric polynomial over its period is exact.
    #[test]
    fn energy_is_kinetic_plus_strain() {
        for mode in modes() {
            for t in [0.0, 0.3, 1.7] {
                let n = 40;
                let cell = mode.length / f64::from(n);
                let density = |x: f64| {
                    let (v, force) = (mode.velocity(x, t), mode.normal_force(x, t));
                    0.5 * (mode.density * mode.section * v * v + force * force / (mode.young * mode.section))
                };
                let sum: f64 = (0..n).map(|i| cell * density((f64::from(i) + 0.5) * cell)).sum();
                assert!((sum - mode.energy()).abs() < 1e-13 * mode.energy(), "{mode:?}: {sum}");
            }
        }
    }
}
