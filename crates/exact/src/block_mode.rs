//! Standing waves of a rectangle on rollers.

use std::f64::consts::PI;

/// Direction of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wave {
    /// Along k: ω² = |k|²(λ + 2G)/ρ.
    Pressure,
    /// Across k: ω² = |k|² G/ρ; both numbers must be at least 1, otherwise the field is zero.
    Shear,
}

/// A standing wave of the rectangle [0, a] × [0, b] with rollers on all four sides
/// (u_n = 0, σ_nt = 0):
///
/// u_x = A c_x sin(k_x x) cos(k_y y) cos(ωt + θ), u_y = A c_y cos(k_x x) sin(k_y y) cos(ωt + θ),
///
/// with k = (mπ/a, nπ/b) and c = k/|k| (pressure) or (k_y, −k_x)/|k| (shear).
///
/// Source: Helmholtz's decomposition (Graff, *Wave Motion in Elastic Solids*, §5.1); the first
/// field is a gradient, the second is divergence-free, and Navier's equation
/// ρü = (λ + G)∇(∇·u) + GΔu becomes a wave equation for each.
///
/// λ and G are those of the two-dimensional law: plane strain λ = Eν/((1+ν)(1−2ν)), plane stress
/// λ = Eν/(1−ν²), both G = E/(2(1+ν)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockMode {
    /// Pressure or shear.
    pub wave: Wave,
    /// Half waves (m, n) along x and y.
    pub numbers: [u32; 2],
    /// Sides a and b (m).
    pub sides: [f64; 2],
    /// Thickness (m).
    pub thickness: f64,
    /// λ (Pa).
    pub lambda: f64,
    /// Shear modulus G (Pa).
    pub shear: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// A (m).
    pub amplitude: f64,
    /// θ (rad): 0 starts displaced and at rest, −π/2 undeformed and moving.
    pub phase: f64,
}

impl BlockMode {
    /// k (rad/m).
    #[must_use]
    pub fn wave_vector(&self) -> [f64; 2] {
        [0, 1].map(|i| f64::from(self.numbers[i]) * PI / self.sides[i])
    }

    /// ω (rad/s).
    #[must_use]
    pub fn angular_frequency(&self) -> f64 {
        let modulus = match self.wave {
            Wave::Pressure => self.lambda + 2.0 * self.shear,
            Wave::Shear => self.shear,
        };
        let [kx, ky] = self.wave_vector();
        kx.hypot(ky) * (modulus / self.density).sqrt()
    }

    /// c, of length 1.
    fn direction(&self) -> [f64; 2] {
        let [kx, ky] = self.wave_vector();
        let norm = kx.hypot(ky);
        match self.wave {
            Wave::Pressure => [kx / norm, ky / norm],
            Wave::Shear => [ky / norm, -kx / norm],
        }
    }

    /// The field at the time of its largest displacement (m).
    fn shape(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ([kx, ky], [cx, cy]) = (self.wave_vector(), self.direction());
        let ((sx, qx), (sy, qy)) = ((kx * x).sin_cos(), (ky * y).sin_cos());
        [self.amplitude * cx * sx * qy, self.amplitude * cy * qx * sy]
    }

    /// Displacement at a point and instant (m).
    #[must_use]
    pub fn displacement(&self, point: [f64; 2], t: f64) -> [f64; 2] {
        let factor = (self.angular_frequency() * t + self.phase).cos();
        self.shape(point).map(|u| u * factor)
    }

    /// Velocity at a point and instant (m/s).
    #[must_use]
    pub fn velocity(&self, point: [f64; 2], t: f64) -> [f64; 2] {
        let omega = self.angular_frequency();
        let factor = -omega * (omega * t + self.phase).sin();
        self.shape(point).map(|u| u * factor)
    }

    /// Stress σ = λ tr ε 1 + 2G ε at a point and instant (Pa).
    #[must_use]
    pub fn stress(&self, [x, y]: [f64; 2], t: f64) -> [[f64; 2]; 2] {
        let ([kx, ky], [cx, cy]) = (self.wave_vector(), self.direction());
        let ((sx, qx), (sy, qy)) = ((kx * x).sin_cos(), (ky * y).sin_cos());
        let factor = self.amplitude * (self.angular_frequency() * t + self.phase).cos();
        let (xx, yy) = (factor * cx * kx * qx * qy, factor * cy * ky * qx * qy);
        let xy = -self.shear * factor * (cx * ky + cy * kx) * sx * sy;
        let pressure = self.lambda * (xx + yy);
        [[pressure + 2.0 * self.shear * xx, xy], [xy, pressure + 2.0 * self.shear * yy]]
    }

    /// Kinetic plus strain energy (J), the same at all times: that of the largest velocities,
    /// ½ρω² ∫|u|², with mean squares of sines and cosines over the sides.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let sin2 = |n: u32| if n == 0 { 0.0 } else { 0.5 };
        let [m, n] = self.numbers;
        let [cx, cy] = self.direction();
        let mean = cx * cx * sin2(m) * (1.0 - sin2(n)) + cy * cy * (1.0 - sin2(m)) * sin2(n);
        let mass = self.density * self.thickness * self.sides[0] * self.sides[1];
        let speed = self.amplitude * self.angular_frequency();
        0.5 * mass * speed * speed * mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn modes() -> impl Iterator<Item = BlockMode> {
        let cases = [
            (Wave::Pressure, [1, 1]),
            (Wave::Pressure, [2, 0]),
            (Wave::Pressure, [0, 3]),
            (Wave::Pressure, [3, 2]),
            (Wave::Shear, [1, 1]),
            (Wave::Shear, [2, 3]),
        ];
        cases.into_iter().map(|(wave, numbers)| BlockMode {
            wave,
            numbers,
            sides: [1.5, 1.1],
            thickness: 0.2,
            lambda: 3.0,
            shear: 2.0,
            density: 1.3,
            amplitude: 0.4,
            phase: 0.4,
        })
    }

    /// ρ v̇ = div σ, and σ is the law applied to u, by central differences. Their relative error is
    /// (kh)²/6: |k| < 11 and h = 1e-4 give 2e-7.
    #[test]
    fn equations_of_motion() {
        let h = 1e-4;
        for mode in modes() {
            let scale = mode.amplitude * 20.0 * mode.wave_vector().iter().map(|k| 1.0 + k * k).sum::<f64>();
            for (p, t) in [([0.3, 0.2], 0.1), ([1.2, 0.7], 0.8)] {
                let shifted =
                    |c: usize, by: f64| [p[0] + if c == 0 { by } else { 0.0 }, p[1] + if c == 1 { by } else { 0.0 }];
                let slope = |f: &dyn Fn([f64; 2]) -> f64, c: usize| (f(shifted(c, h)) - f(shifted(c, -h))) / (2.0 * h);
                let g = |a: usize, b: usize| slope(&|p| mode.displacement(p, t)[a], b);
                for a in 0..2 {
                    let rate = (mode.displacement(p, t + h)[a] - mode.displacement(p, t - h)[a]) / (2.0 * h);
                    assert!((rate - mode.velocity(p, t)[a]).abs() < 1e-6 * scale, "{mode:?}");
                    for b in 0..2 {
                        let trace = if a == b { mode.lambda * (g(0, 0) + g(1, 1)) } else { 0.0 };
                        let law = trace + mode.shear * (g(a, b) + g(b, a));
                        assert!((law - mode.stress(p, t)[a][b]).abs() < 1e-6 * scale, "{mode:?}");
                    }
                    let inertia = mode.density * (mode.velocity(p, t + h)[a] - mode.velocity(p, t - h)[a]) / (2.0 * h);
                    let divergence: f64 = (0..2).map(|b| slope(&|p| mode.stress(p, t)[a][b], b)).sum();
                    assert!((inertia - divergence).abs() < 1e-6 * scale, "{mode:?}: {inertia} against {divergence}");
                }
            }
        }
    }

    /// u_n = 0 and σ_xy = 0 on all sides; sin(nπ) is 0 to n·1e-16, the factors are below 100.
    #[test]
    fn rollers() {
        for mode in modes() {
            for s in [0.1, 0.6, 0.93] {
                for (c, end) in [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0)] {
                    let mut p = [s * 1.5, s * 1.1];
                    p[c] = end * mode.sides[c];
                    let (u, shear) = (mode.displacement(p, 0.3)[c], mode.stress(p, 0.3)[0][1]);
                    assert!(u.abs() < 1e-13 && shear.abs() < 1e-13, "{mode:?} at {p:?}: {u}, {shear}");
                }
            }
        }
    }

    /// Midpoint sums of trigonometric polynomials are exact; strain energy by the inverse law
    /// ε = (σ − λ tr σ/(2λ + 2G) 1)/(2G).
    #[test]
    fn energy_is_kinetic_plus_strain() {
        for mode in modes() {
            for t in [0.0, 0.4, 1.3] {
                let n = 20;
                let area = mode.sides[0] * mode.sides[1] * mode.thickness / f64::from(n * n);
                let mut sum = 0.0;
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    let p = [
                        mode.sides[0] * (f64::from(i) + 0.5) / f64::from(n),
                        mode.sides[1] * (f64::from(j) + 0.5) / f64::from(n),
                    ];
                    let (v, s) = (mode.velocity(p, t), mode.stress(p, t));
                    let trace = s[0][0] + s[1][1];
                    let squares: f64 = s.iter().flatten().map(|s| s * s).sum();
                    let form = (squares - mode.lambda * trace * trace / (2.0 * (mode.lambda + mode.shear)))
                        / (2.0 * mode.shear);
                    sum += 0.5 * area * (mode.density * (v[0] * v[0] + v[1] * v[1]) + form);
                }
                assert!(mode.energy() > 0.0 && (sum - mode.energy()).abs() < 1e-12 * mode.energy(), "{mode:?}: {sum}");
            }
        }
    }
}
