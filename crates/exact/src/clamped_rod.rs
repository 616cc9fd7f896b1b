//! A clamped rod that springs back against an obstacle.

/// A uniform rod on [0, L], clamped at x = L, with an obstacle at the undeformed position of its end x = 0. It is
/// displaced from the obstacle, u₀ = (1 − x/L) d with d > 0, and released at rest.
///
/// Source: a benchmark of Dabaghi, Petrov, Pousin and Renard, *A robust finite element redistribution approach for
/// elastodynamic contact problems*, Appl. Numer. Math. 103 (2016), with L = E = ρ = 1 and d = ½. The closed form by
/// d'Alembert: with c = √(E/ρ), a = L/c and a wave of velocity w = dc/L,
///
/// - release, 0 … a: the unloading wave runs from x = 0 to the clamp; behind it the rod is unstrained with the velocity
///   −w;
/// - contact, a … 2a: all of the rod arrives unstrained at −w; waves run in from both ends, stop it, compress it at the
///   obstacle and stretch it at the clamp, and meet; behind the second ones it is unstrained with velocity w. The
///   contact force is ESd/L;
/// - return, 2a … 3a: the wave from the clamp stops it, compressed as at the start.
///
/// The period is 3a; its second half is the time reverse of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClampedRod {
    /// L (m).
    pub length: f64,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Section S (m²).
    pub section: f64,
    /// d, the distance of its end from the obstacle at t = 0 (m).
    pub distance: f64,
}

impl ClampedRod {
    /// c = √(E/ρ) (m/s).
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// a = L/c (s), the time of the first touch and the duration of contact.
    #[must_use]
    pub fn passage(&self) -> f64 {
        self.length / self.wave_speed()
    }

    /// 3L/c (s).
    #[must_use]
    pub fn period(&self) -> f64 {
        3.0 * self.passage()
    }

    /// Kinetic plus strain energy (J), the same at all times: ½ES d²/L.
    #[must_use]
    pub fn energy(&self) -> f64 {
        0.5 * self.young * self.section * self.distance * self.distance / self.length
    }

    /// Displacement of the point x ∈ [0, L] (m).
    #[must_use]
    pub fn displacement(&self, x: f64, t: f64) -> f64 {
        let (tau, _) = self.folded(t);
        let (from_start, from_clamp) = self.arrivals(x);
        let speed = self.wave();
        let start = self.distance * (1.0 - x / self.length);
        let moved = (tau.min(self.passage()) - from_start).max(0.0);
        let stopped_after = from_start.min(from_clamp);
        start - speed * (moved + (tau - self.passage()).clamp(0.0, stopped_after))
    }

    /// Velocity of the point x ∈ [0, L] (m/s): −w, 0 or w.
    #[must_use]
    pub fn velocity(&self, x: f64, t: f64) -> f64 {
        let (tau, sign) = self.folded(t);
        let (from_start, from_clamp) = self.arrivals(x);
        let since_touch = tau - self.passage();
        let moves = if since_touch < 0.0 { tau >= from_start } else { since_touch < from_start.min(from_clamp) };
        if moves { -sign * self.wave() } else { 0.0 }
    }

    /// Normal force at x ∈ [0, L] (N), tension positive: −ESd/L, 0 or ESd/L.
    #[must_use]
    pub fn normal_force(&self, x: f64, t: f64) -> f64 {
        let (tau, _) = self.folded(t);
        let (from_start, from_clamp) = self.arrivals(x);
        let since_touch = tau - self.passage();
        if since_touch < 0.0 {
            return if tau < from_start { -self.plateau() } else { 0.0 };
        }
        if since_touch < from_start.min(from_clamp) {
            0.0
        } else if from_start < from_clamp {
            -self.plateau()
        } else {
            self.plateau()
        }
    }

    /// Force of the obstacle on the rod (N): ESd/L from L/c to 2L/c of each period, else 0.
    #[must_use]
    pub fn contact_force(&self, t: f64) -> f64 {
        if self.folded(t).0 >= self.passage() { self.plateau() } else { 0.0 }
    }

    /// The time folded by period and symmetry into [0, 3a/2], and the sign of the velocity there.
    fn folded(&self, t: f64) -> (f64, f64) {
        let phase = t.rem_euclid(self.period());
        if phase <= 0.5 * self.period() { (phase, 1.0) } else { (self.period() - phase, -1.0) }
    }

    /// Travel time of a wave to x from the start, and from the clamp (s).
    fn arrivals(&self, x: f64) -> (f64, f64) {
        let c = self.wave_speed();
        (x / c, (self.length - x) / c)
    }

    /// w = dc/L (m/s).
    fn wave(&self) -> f64 {
        self.distance / self.passage()
    }

    /// ESd/L (N).
    fn plateau(&self) -> f64 {
        self.young * self.section * self.distance / self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// c = 3 m/s, a = 2 s, w = 0.1 m/s, ESd/L = 0.06 N.
    const ROD: ClampedRod = ClampedRod { length: 6.0, young: 18.0, density: 2.0, section: 0.1, distance: 0.2 };

    fn midpoints(n: usize) -> impl Iterator<Item = f64> {
        (0..n).map(move |i| 6.0 * (i as f64 + 0.5) / n as f64)
    }

    /// Benchmark of Dabaghi et al.: period 3, energy 1/8, force ½.
    #[test]
    fn the_published_figures() {
        let rod = ClampedRod { length: 1.0, young: 1.0, density: 1.0, section: 1.0, distance: 0.5 };
        assert_eq!((rod.period(), rod.energy(), rod.contact_force(1.5)), (3.0, 0.125, 0.5));
        assert_eq!(rod.displacement(0.25, 0.0), 0.375);
        assert_eq!([0.9, 2.1].map(|t| rod.contact_force(t)), [0.0, 0.0]);
    }

    /// Slopes of u are v and N/(ES) in all phases of two periods: u is piecewise linear, so only rounding of the
    /// difference remains, 1e-16·u/step; points and instants are away from fronts.
    #[test]
    fn velocity_and_force_are_the_slopes_of_the_displacement() {
        let h = 1e-4;
        for i in 0..24 {
            let t = 0.53 * f64::from(i) + 0.117;
            for x in midpoints(7) {
                let rate = (ROD.displacement(x, t + h) - ROD.displacement(x, t - h)) / (2.0 * h);
                assert!((rate - ROD.velocity(x, t)).abs() < 1e-10, "velocity at {x}, {t}: {rate}");
                let force = 1.8 * (ROD.displacement(x + h, t) - ROD.displacement(x - h, t)) / (2.0 * h);
                assert!((force - ROD.normal_force(x, t)).abs() < 1e-10, "force at {x}, {t}: {force}");
            }
        }
    }

    /// The clamp does not move, and the end satisfies the Signorini conditions.
    #[test]
    fn ends() {
        for i in 0..600 {
            let t = 0.02 * f64::from(i) + 0.007;
            assert!(ROD.displacement(6.0, t).abs() < 1e-15 && ROD.velocity(6.0, t).abs() == 0.0);
            let (gap, force) = (ROD.displacement(0.0, t), ROD.contact_force(t));
            assert!(gap >= -1e-15 && (gap.abs() < 1e-15 || force == 0.0), "gap {gap}, force {force} at {t}");
            assert_eq!(ROD.normal_force(0.0, t), -force, "{t}");
        }
    }

    /// u is continuous, and across each front [N] = ∓ρSc[v]: the energy does not change. Midpoint sums are exact where
    /// the fronts lie between two cells: at multiples of 1/12 of the passage with 12 cells.
    #[test]
    fn energy() {
        for i in 0..72 {
            let t = f64::from(i) / 6.0;
            let density = |x: f64| 0.2 * ROD.velocity(x, t).powi(2) + ROD.normal_force(x, t).powi(2) / 1.8;
            let sum: f64 = midpoints(12).map(|x| 0.25 * density(x)).sum();
            // Rounding; the fronts' instants are the cells' bounds, away from the midpoints.
            assert!((sum - ROD.energy()).abs() < 1e-15, "{sum} at {t}");
        }
    }

    /// Momentum: the impulse is that of contact and clamp, with the force N(L) of the clamp.
    #[test]
    fn momentum() {
        let (steps, cells) = (12_000, 240);
        let (dt, mut impulse) = (ROD.period() / f64::from(steps), 0.0);
        for i in 0..steps {
            let t = (f64::from(i) + 0.5) * dt;
            impulse += dt * (ROD.contact_force(t) + ROD.normal_force(6.0 - 1e-12, t));
            if i % 100 == 99 {
                let momentum: f64 = midpoints(cells).map(|x| 0.2 * 6.0 / 240.0 * ROD.velocity(x, t + 0.5 * dt)).sum();
                // A cell's and a step's share: 0.2·6/240·0.1 and 0.06·5e-4.
                assert!((momentum - impulse).abs() < 6e-4, "{momentum} against {impulse} at {t}");
            }
        }
    }
}
