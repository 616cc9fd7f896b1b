//! A bar that bounces periodically on a rigid plane under gravity.

/// A uniform bar, undeformed on [0, L] at t = 0 and at rest, that falls under gravity g in −x onto a rigid plane at
/// x = −h, and returns to its initial state periodically.
///
/// Source: the second benchmark of Doyen, Ern and Piperno (2011), *Time-integration schemes for the finite element
/// dynamic Signorini problem*, SIAM J. Sci. Comput. 33(1), 223–249. The closed form is d'Alembert's, derived here.
///
/// With the instant of impact as τ = 0, w the displacement from there, v₀ = √(2gh), c = √(E/ρ) and D = 2L/c:
///
/// - contact lasts D. The wave F(τ) = v₀τ₊ + ½gτ₊² runs from the plane into the bar and is reflected at the free end:
///   w = −v₀τ − ½gτ² + F(τ − x/c) + F(τ − (2L − x)/c). The contact force is ρSc(v₀ + gτ), and at D the bar leaves with
///   the uniform velocity v₀ and twice the deformation s of a bar that stands under its weight, s = −(g/c²)(Lx − x²/2);
/// - the flight lasts 2v₀/g, with a vibration of period D about the undeformed state:
///   w = v₀θ − ½gθ² + ŝ(x + cθ) + ŝ(x − cθ), θ = τ − D and ŝ the 2L-periodic even continuation of s. If 2v₀/g is a
///   whole number of periods D, the bar lands in the state of its release, with all velocities reversed;
/// - so the next contact is the time reverse of the first one, and the bar then rises undeformed to its initial height.
///
/// The solution is even about the middle of the flight and has the period 2D + 4v₀/g.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BouncingBar {
    length: f64,
    young: f64,
    density: f64,
    section: f64,
    gravity: f64,
    height: f64,
}

/// Displacement, velocity and slope of the displacement.
type State = (f64, f64, f64);

impl BouncingBar {
    /// A bar of length L (m), Young's modulus E (Pa), density ρ (kg/m³), section S (m²) under gravity g (m/s²), dropped
    /// from the height h (m). `None` unless the flight 2v₀/g is a whole number k of periods 2L/c, to a relative 1e-9,
    /// and k > 2: with k = 2 or less the bar cannot leave after 2L/c, because its end would move back into the plane.
    #[must_use]
    pub fn new(length: f64, young: f64, density: f64, section: f64, gravity: f64, height: f64) -> Option<Self> {
        let bar = Self { length, young, density, section, gravity, height };
        let periods = 2.0 * bar.impact_speed() / gravity / bar.contact_duration();
        let whole = periods.round();
        ((periods - whole).abs() <= 1e-9 * whole && whole > 2.0).then_some(bar)
    }

    /// c = √(E/ρ) (m/s).
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// v₀ = √(2gh) (m/s).
    #[must_use]
    pub fn impact_speed(&self) -> f64 {
        (2.0 * self.gravity * self.height).sqrt()
    }

    /// Time of the first touch (s): v₀/g.
    #[must_use]
    pub fn impact_time(&self) -> f64 {
        self.impact_speed() / self.gravity
    }

    /// Duration of each contact (s): D = 2L/c.
    #[must_use]
    pub fn contact_duration(&self) -> f64 {
        2.0 * self.length / self.wave_speed()
    }

    /// Period of the motion (s), two bounces: 2D + 4v₀/g.
    #[must_use]
    pub fn period(&self) -> f64 {
        2.0 * self.contact_duration() + 4.0 * self.impact_time()
    }

    /// Kinetic, strain and potential energy (J), zero at rest on the plane: ρSLgh at all times.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.density * self.section * self.length * self.gravity * self.height
    }

    /// Displacement of the point x ∈ [0, L] from t = 0 (m).
    #[must_use]
    pub fn displacement(&self, x: f64, t: f64) -> f64 {
        self.state(x, t).0 - self.height
    }

    /// Velocity of the point x ∈ [0, L] (m/s).
    #[must_use]
    pub fn velocity(&self, x: f64, t: f64) -> f64 {
        self.state(x, t).1
    }

    /// Normal force at x ∈ [0, L] (N), tension positive.
    #[must_use]
    pub fn normal_force(&self, x: f64, t: f64) -> f64 {
        self.young * self.section * self.state(x, t).2
    }

    /// Force of the plane on the bar (N): in the first contact ρSc(v₀ + gτ), in the second the time reverse.
    #[must_use]
    pub fn contact_force(&self, t: f64) -> f64 {
        let (tau, _) = self.folded(t);
        if (0.0..=self.contact_duration()).contains(&tau) { -self.normal_force(0.0, t) } else { 0.0 }
    }

    /// The time since the first impact, folded by period and symmetry into [−v₀/g, D + v₀/g], and the sign of the
    /// velocity there.
    fn folded(&self, t: f64) -> (f64, f64) {
        let fall = self.impact_time();
        let phase = t.rem_euclid(self.period());
        let middle = self.contact_duration() + 2.0 * fall;
        if phase <= middle { (phase - fall, 1.0) } else { (2.0 * middle - phase - fall, -1.0) }
    }

    /// w, its velocity and its slope.
    fn state(&self, x: f64, t: f64) -> State {
        let (tau, sign) = self.folded(t);
        let contact = self.contact_duration();
        let (w, v, slope) = if tau > contact { self.flight(x, tau - contact) } else { self.contact(x, tau) };
        (w, sign * v, slope)
    }

    /// Before and during the first contact, τ ≤ D.
    fn contact(&self, x: f64, tau: f64) -> State {
        let (c, g, v0) = (self.wave_speed(), self.gravity, self.impact_speed());
        let sent = tau - x / c;
        let back = tau - (2.0 * self.length - x) / c;
        let wave = |t: f64| if t > 0.0 { (v0 * t + 0.5 * g * t * t, v0 + g * t) } else { (0.0, 0.0) };
        let ((w0, v_sent), (w1, v_back)) = (wave(sent), wave(back));
        (w0 + w1 - v0 * tau - 0.5 * g * tau * tau, v_sent + v_back - v0 - g * tau, (v_back - v_sent) / c)
    }

    /// The flight between two contacts, θ seconds after its start.
    fn flight(&self, x: f64, theta: f64) -> State {
        let (c, g, v0) = (self.wave_speed(), self.gravity, self.impact_speed());
        let swing = |z: f64| {
            let z = z.rem_euclid(2.0 * self.length);
            (-g / (c * c) * z * (self.length - 0.5 * z), -g / (c * c) * (self.length - z))
        };
        let ((ahead, ahead_slope), (behind, behind_slope)) = (swing(x + c * theta), swing(x - c * theta));
        let w = v0 * theta - 0.5 * g * theta * theta + ahead + behind;
        (w, v0 - g * theta + c * (ahead_slope - behind_slope), ahead_slope + behind_slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bar of Doyen, Ern and Piperno, with a section other than 1.
    fn bar() -> BouncingBar {
        BouncingBar::new(10.0, 900.0, 1.0, 0.5, 10.0, 5.0).unwrap()
    }

    fn midpoints(n: usize) -> impl Iterator<Item = f64> {
        (0..n).map(move |i| 10.0 * (i as f64 + 0.5) / n as f64)
    }

    /// Their figures: 30 m/s, 10 m/s, contact of 2/3 s after 1 s, period 16/3 s.
    #[test]
    fn the_published_figures() {
        let bar = bar();
        assert_eq!((bar.wave_speed(), bar.impact_speed(), bar.impact_time()), (30.0, 10.0, 1.0));
        // Rounding of a few operations.
        assert!((bar.contact_duration() - 2.0 / 3.0).abs() < 1e-15 && (bar.period() - 16.0 / 3.0).abs() < 1e-14);
        assert_eq!(bar.energy(), 250.0);
    }

    /// A flight that is not a whole number of periods, or only two of them.
    #[test]
    fn bars_that_do_not_bounce_for_ever_are_refused() {
        assert_eq!(BouncingBar::new(10.0, 900.0, 1.0, 0.5, 10.0, 5.1), None);
        assert_eq!(BouncingBar::new(10.0, 400.0, 1.0, 0.5, 10.0, 5.0), None);
    }

    /// Instants in all phases, away from the fronts at the points used below.
    const INSTANTS: [f64; 10] = [0.4, 1.13, 1.31, 1.55, 1.9, 2.6, 3.37, 3.83, 4.11, 4.9];

    /// Slopes of u in time and space are v and N/(ES), and ρS(v̇ + g) = N'. The fields are quadratic, so that
    /// central differences are exact but for rounding, 1e-16·5/1e-4 (v, N) and 1e-16·20·450/1e-4 (N').
    #[test]
    fn equations_of_motion() {
        let (bar, h) = (bar(), 1e-4);
        for t in INSTANTS {
            for x in midpoints(7) {
                let in_time = |f: &dyn Fn(f64) -> f64| (f(t + h) - f(t - h)) / (2.0 * h);
                let in_space = |f: &dyn Fn(f64) -> f64| (f(x + h) - f(x - h)) / (2.0 * h);
                let velocity = in_time(&|t| bar.displacement(x, t));
                assert!((velocity - bar.velocity(x, t)).abs() < 1e-10, "velocity at {x}, {t}");
                let force = 450.0 * in_space(&|x| bar.displacement(x, t));
                assert!((force - bar.normal_force(x, t)).abs() < 1e-7, "force at {x}, {t}");
                let inertia = 0.5 * (in_time(&|t| bar.velocity(x, t)) + 10.0);
                let divergence = in_space(&|x| bar.normal_force(x, t));
                assert!((inertia - divergence).abs() < 1e-7, "motion at {x}, {t}: {inertia} against {divergence}");
            }
        }
    }

    /// The Signorini conditions at x = 0 over two periods; the other end is free. Displacements are of order 5.
    #[test]
    fn contact_law() {
        let bar = bar();
        for i in 0..2000 {
            let t = 2.0 * bar.period() * (f64::from(i) + 0.37) / 2000.0;
            let (gap, force) = (bar.displacement(0.0, t) + 5.0, bar.contact_force(t));
            assert!(gap >= -1e-13 && force >= 0.0, "gap {gap}, force {force} at {t}");
            assert!(gap.abs() < 1e-13 || force == 0.0, "gap {gap}, force {force} at {t}");
            if force == 0.0 {
                assert!(bar.normal_force(0.0, t).abs() < 1e-11, "force at the free start at {t}");
            }
            assert!(bar.normal_force(10.0, t).abs() < 1e-11, "force at the free end at {t}");
        }
    }

    /// u is continuous in time through all changes of phase, and so is v but where a front passes. The largest velocity
    /// is 20 m/s: 1e-9 s before and after.
    #[test]
    fn the_phases_fit_together() {
        let bar = bar();
        let contact = bar.contact_duration();
        for change in [1.0, 1.0 + contact, 3.0 + contact, 3.0 + 2.0 * contact, bar.period()] {
            for x in midpoints(9) {
                let [before, after] = [-1e-9, 1e-9].map(|by| change + by);
                assert!((bar.displacement(x, before) - bar.displacement(x, after)).abs() < 1e-7, "{x}, {change}");
                assert!((bar.velocity(x, before) - bar.velocity(x, after)).abs() < 1e-6, "{x}, {change}");
            }
        }
    }

    /// Kinetic, strain and potential energy are conserved, and the momentum changes by weight and contact force.
    /// Midpoint sums of pieces of parabolas that fronts cut: 1e-3 of the energy with 4 000 cells.
    #[test]
    fn energy_and_momentum_balance() {
        let (bar, n) = (bar(), 4000);
        let mass = 5.0 / n as f64;
        let mut impulse = 0.0;
        let steps = 5000;
        let dt = bar.period() / f64::from(steps);
        for i in 0..steps {
            let t = (f64::from(i) + 0.5) * dt;
            if i % 100 == 0 {
                let density = |x: f64| {
                    let (v, force) = (bar.velocity(x, t), bar.normal_force(x, t));
                    0.5 * mass * v * v
                        + 0.5 * (10.0 / n as f64) * force * force / 450.0
                        + mass * 10.0 * (bar.displacement(x, t) + 5.0)
                };
                let energy: f64 = midpoints(n).map(density).sum();
                assert!((energy - 250.0).abs() < 0.25, "energy {energy} at {t}");
                let momentum: f64 = midpoints(n).map(|x| mass * bar.velocity(x, t)).sum();
                let expected = impulse + 0.5 * dt * (bar.contact_force(t) - 50.0);
                // A step's force at the beginning and end of contact: 250 N · 1e-3 s.
                assert!((momentum - expected).abs() < 0.3, "momentum {momentum} against {expected} at {t}");
            }
            impulse += dt * (bar.contact_force(t) - 50.0);
        }
    }
}
