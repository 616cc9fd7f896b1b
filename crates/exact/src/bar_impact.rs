//! The impact of a uniform bar on a rigid plane.

/// A uniform bar, undeformed on [0, L], that moves in −x at `speed` towards a rigid plane at
/// x = −`gap`. It leaves the plane at the same speed after 2L/c.
///
/// Source: Louf, Gallimard and Pelle, §7.1.1 (after Gibert, *Vibrations des structures*, 1988).
/// Its three phases are one formula: with the impact at t_c and c = √(E/ρ), the point x stops when
/// the compression wave reaches it and starts again with the wave reflected at the free end,
///
/// u(x, t) = −v₀ min(t, t_c + x/c) + v₀ max(0, t − t_c − (2L − x)/c).
///
/// On the front itself, all fields have their values behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarImpact {
    /// L (m).
    pub length: f64,
    /// Young's modulus E (Pa).
    pub young: f64,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Section S (m²).
    pub section: f64,
    /// Speed v₀ towards the plane (m/s), positive.
    pub speed: f64,
    /// Distance from the bar to the plane at t = 0 (m), positive.
    pub gap: f64,
}

impl BarImpact {
    /// c = √(E/ρ) (m/s).
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// t_c = gap/v₀ (s).
    #[must_use]
    pub fn impact_time(&self) -> f64 {
        self.gap / self.speed
    }

    /// t_c + 2L/c (s).
    #[must_use]
    pub fn release_time(&self) -> f64 {
        self.impact_time() + 2.0 * self.length / self.wave_speed()
    }

    /// Arrival times of the compression wave and of the reflected wave at x (s).
    fn arrivals(&self, x: f64) -> (f64, f64) {
        let c = self.wave_speed();
        (self.impact_time() + x / c, self.impact_time() + (2.0 * self.length - x) / c)
    }

    /// Displacement of the point x ∈ [0, L] (m).
    #[must_use]
    pub fn displacement(&self, x: f64, t: f64) -> f64 {
        let (compressed, relieved) = self.arrivals(x);
        self.speed * ((t - relieved).max(0.0) - t.min(compressed))
    }

    /// Velocity of the point x ∈ [0, L] (m/s): −v₀, then 0, then v₀.
    #[must_use]
    pub fn velocity(&self, x: f64, t: f64) -> f64 {
        let (compressed, relieved) = self.arrivals(x);
        if t >= relieved {
            self.speed
        } else if t >= compressed {
            0.0
        } else {
            -self.speed
        }
    }

    /// Normal force at x ∈ [0, L] (N), tension positive: −ρScv₀ in the compressed part, else 0.
    #[must_use]
    pub fn normal_force(&self, x: f64, t: f64) -> f64 {
        let (compressed, relieved) = self.arrivals(x);
        if t >= compressed && t < relieved { -self.plateau() } else { 0.0 }
    }

    /// Force of the plane on the bar (N): ρScv₀ from impact to release, else 0.
    #[must_use]
    pub fn contact_force(&self, t: f64) -> f64 {
        -self.normal_force(0.0, t)
    }

    /// Position of the front in the undeformed bar (m). During contact it runs to the free end and
    /// back; at other times all fields are continuous.
    #[must_use]
    pub fn front(&self, t: f64) -> Option<f64> {
        let run = self.wave_speed() * (t - self.impact_time());
        let turned = 2.0 * self.length - run;
        (run >= 0.0 && turned >= 0.0).then(|| run.min(turned))
    }

    /// ρScv₀ (N).
    fn plateau(&self) -> f64 {
        self.density * self.section * self.wave_speed() * self.speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// c = 3 m/s, t_c = 0.5 s, release at 4.5 s, ρScv₀ = 1.2 N.
    const BAR: BarImpact = BarImpact { length: 6.0, young: 18.0, density: 2.0, section: 0.1, speed: 2.0, gap: 1.0 };

    /// Midpoints of `n` equal parts of the bar: away from the front for the instants used below.
    fn midpoints(n: usize) -> impl Iterator<Item = f64> {
        (0..n).map(move |i| BAR.length * (i as f64 + 0.5) / n as f64)
    }

    #[test]
    fn instants_and_front() {
        assert_eq!((BAR.wave_speed(), BAR.impact_time(), BAR.release_time()), (3.0, 0.5, 4.5));
        assert_eq!(BAR.front(0.4), None);
        assert_eq!([1.5, 2.5, 3.5].map(|t| BAR.front(t)), [Some(3.0), Some(6.0), Some(3.0)]);
        assert_eq!(BAR.front(4.6), None);
    }

    /// Differences of u in time and space are v and N/(ES): u is piecewise linear, so only rounding
    /// of the difference remains, 1e-16·u/step.
    #[test]
    fn velocity_and_force_are_the_slopes_of_the_displacement() {
        let step = 1e-4;
        for t in [0.2, 1.3, 2.2, 2.9, 4.1, 5.0] {
            for x in midpoints(7) {
                let rate = (BAR.displacement(x, t + step) - BAR.displacement(x, t - step)) / (2.0 * step);
                assert!((rate - BAR.velocity(x, t)).abs() < 1e-10, "velocity at {x}, {t}: {rate}");
                let strain = (BAR.displacement(x + step, t) - BAR.displacement(x - step, t)) / (2.0 * step);
                let force = BAR.young * BAR.section * strain;
                assert!((force - BAR.normal_force(x, t)).abs() < 1e-10, "force at {x}, {t}: {force}");
            }
        }
    }

    /// Across the front that moves at ±c: [N] = ∓ρSc[v] (balance of momentum) and u is continuous.
    #[test]
    fn the_front_keeps_momentum_and_the_bar_together() {
        for (t, sign) in [(1.7, 1.0), (3.3, -1.0)] {
            let front = BAR.front(t).unwrap();
            let (behind, ahead) = (front - 1e-9, front + 1e-9);
            let force = BAR.normal_force(ahead, t) - BAR.normal_force(behind, t);
            let velocity = BAR.velocity(ahead, t) - BAR.velocity(behind, t);
            let flux = -sign * BAR.density * BAR.section * BAR.wave_speed() * velocity;
            // All numbers are a few digits long: rounding only.
            assert!(force != 0.0 && (force - flux).abs() < 1e-14, "{force} against {flux}");
            // Slopes of u are of order 1, times the distance of 2e-9.
            assert!((BAR.displacement(ahead, t) - BAR.displacement(behind, t)).abs() < 1e-8);
        }
    }

    /// The energy is constant, and the momentum grows by the impulse of the
    /// contact force. Midpoint sums are exact because the front lies between two cells.
    #[test]
    fn energy_and_momentum_balance() {
        let n = 12;
        let (cell, mass) = (BAR.length / n as f64, BAR.density * BAR.section * BAR.length / n as f64);
        let flight = 0.5 * mass * n as f64 * BAR.speed * BAR.speed;
        for quarter in 0..24 {
            let t = 0.5 + f64::from(quarter) / 6.0;
            let kinetic: f64 = midpoints(n).map(|x| 0.5 * mass * BAR.velocity(x, t).powi(2)).sum();
            let strain: f64 =
                midpoints(n).map(|x| 0.5 * cell * BAR.normal_force(x, t).powi(2) / (BAR.young * BAR.section)).sum();
            assert!((kinetic + strain - flight).abs() < 1e-13 * flight, "energy {} at {t}", kinetic + strain);
            let momentum: f64 = midpoints(n).map(|x| mass * BAR.velocity(x, t)).sum();
            let impulse = BAR.contact_force(1.0) * (t - BAR.impact_time());
            let initial = -mass * n as f64 * BAR.speed;
            assert!((momentum - initial - impulse).abs() < 1e-13 * initial.abs(), "momentum {momentum} at {t}");
        }
    }

    /// The end in contact stays on the plane, the other end is free, and the bar leaves rigidly at
    /// its initial speed.
    #[test]
    fn ends_and_rebound() {
        for t in [0.5, 1.0, 2.5, 4.0, 4.5] {
            assert!((BAR.displacement(0.0, t) + BAR.gap).abs() < 1e-15);
            assert_eq!(BAR.normal_force(BAR.length, t), 0.0);
        }
        for x in midpoints(5) {
            // u = v₀(t − 2t_c − 2L/c) = 2(6 − 1 − 4).
            assert!((BAR.displacement(x, 6.0) - 2.0).abs() < 1e-14);
            assert_eq!((BAR.velocity(x, 6.0), BAR.normal_force(x, 6.0)), (2.0, 0.0));
        }
        assert_eq!([0.4, 4.6].map(|t| BAR.contact_force(t)), [0.0, 0.0]);
        // ρScv₀ = 2·0.1·3·2, to rounding of three products.
        assert!((BAR.contact_force(4.4) - 1.2).abs() < 1e-15);
    }
}
