//! A bar that vibrates in one mode, started at its largest displacement.
//!
//! Nodal values of sin(kx) are a mode of the mesh too, with ω_0 = (2c/h) sin(kh/2) in continuous
//! time and sin(ω_hΔt/2) = ω_0Δt/2 with central differences. So everything follows in closed form.
//! E_0 is the energy of the mode, x = ωΔt.

use crate::common::bar_in_mode;
use percute_core::dynamics::simulate;
use percute_core::observer::Unobserved;
use percute_core::time::TimeGrid;
use percute_estimator::reference::Motion;
use percute_estimator::{Acceleration, Estimate, Estimator, Options, Reconstruction};
use percute_exact::{BarEnds, BarMode};
use std::f64::consts::PI;

/// 1¾ wave lengths in the bar; c = 2 m/s.
const MODE: BarMode = BarMode {
    ends: BarEnds::FixedFree,
    number: 4,
    length: 2.0,
    young: 12.0,
    density: 3.0,
    section: 0.5,
    amplitude: 0.7,
    phase: 0.0,
};
const PERIODS: f64 = 3.0;

fn run(elements: usize, courant: f64, acceleration: Acceleration) -> (Motion, Estimate, f64) {
    run_with(
        elements,
        courant,
        Options { reconstruction: Reconstruction::Consistent, acceleration: Some(acceleration), ..Options::default() },
    )
}

fn run_with(elements: usize, courant: f64, options: Options) -> (Motion, Estimate, f64) {
    let problem = bar_in_mode(&MODE, elements, &["start"]);
    let end = PERIODS * 2.0 * PI / MODE.angular_frequency();
    // Δt_c = h/c on a uniform bar, eq. [33].
    let times = TimeGrid::with_step(end, courant * MODE.length / elements as f64 / 2.0).unwrap();
    let mut sink = (Motion::default(), Estimator::new(&problem, &times, options).unwrap());
    simulate(&problem, &times, &mut sink, &mut Unobserved).unwrap();
    (sink.0, sink.1.finish().unwrap(), times.step(0))
}

/// The energy norm of the difference of nodal fields and (N, v) given at each point, at each t_n:
/// the square root of the largest and of the mean square (J^½).
fn distance(motion: &Motion, field: impl Fn(f64, f64) -> (f64, f64)) -> (f64, f64) {
    let elements = motion.displacement[0].len() - 1;
    let h = MODE.length / elements as f64;
    let (stiffness, inertia) = (MODE.young * MODE.section, MODE.density * MODE.section);
    let mut squares = Vec::new();
    for ((&t, u), v) in motion.times.iter().zip(&motion.displacement).zip(&motion.velocity) {
        let mut square = 0.0;
        for e in 0..elements {
            let force = stiffness * (u[e + 1] - u[e]) / h;
            for (at, weight) in [(-(0.6_f64.sqrt()), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6_f64.sqrt(), 5.0 / 18.0)] {
                let s = 0.5 + 0.5 * at;
                let (exact_force, exact_velocity) = field(h * (e as f64 + s), t);
                let velocity = v[e] + s * (v[e + 1] - v[e]);
                let (df, dv) = (force - exact_force, velocity - exact_velocity);
                square += 0.5 * h * weight * (df * df / stiffness + inertia * dv * dv);
            }
        }
        squares.push(square);
    }
    let strips = squares.windows(2).map(|s| 0.5 * (s[0] + s[1]));
    let mean = strips.sum::<f64>() / (squares.len() - 1) as f64;
    (squares.iter().fold(0.0_f64, |m, s| m.max(*s)).sqrt(), mean.sqrt())
}

fn exact(x: f64, t: f64) -> (f64, f64) {
    (MODE.normal_force(x, t), MODE.velocity(x, t))
}

/// In h, with Δt = 0.9 h/c. N_h is the mean of N on an element, N differs from it by N'(x − x_mid):
/// e² = E_0 (kh)²/12 cos²ωt, of order 1; velocities and the phase are off by O(h²) only. The estimate
/// has N_DA with the nodal means, the same N' and so the same elastic part: asymptotically exact.
/// `rigid` and `weak` replace the slope δ of Γ_DA/ρ in an element by 0 and 3δ: after integration a
/// kinetic part of 1 and 4 times E_0 (kh)²/12 sin²ωt. The sup is 1, 1 and 2 times √E_0 kh/√12, the
/// mean √½, 1 and √(5/2) times.
#[test]
fn order_one_in_h() {
    let root = MODE.energy().sqrt();
    let factors = [
        (Acceleration::Closest, 1.0, 0.5_f64.sqrt()),
        (Acceleration::Rigid, 1.0, 1.0),
        (Acceleration::Weak, 2.0, 2.5_f64.sqrt()),
    ];
    for (choice, sup, mean) in factors {
        for elements in [40, 80, 160, 320] {
            let kh = MODE.wave_number() * MODE.length / elements as f64;
            let (motion, estimate, _) = run(elements, 0.9, choice);
            let unit = root * kh / 12.0_f64.sqrt();
            // What is left out is of relative order (kh)², the next terms of Taylor's series; the factors
            // measured are 0.41 at most.
            let tolerance = 0.6 * kh * kh;
            let close = |a: f64, b: f64| (a / unit - b).abs() < tolerance * b;
            let error = &estimate.error;
            let told = format!("{choice}, {elements}: {} {} for {sup} {mean}", error.sup / unit, error.mean / unit);
            assert!(close(error.sup, sup) && close(error.mean, mean), "{told}");
            let (true_sup, true_mean) = distance(&motion, exact);
            let told = format!("true error, {elements}: {} {}", true_sup / unit, true_mean / unit);
            assert!(close(true_sup, 1.0) && close(true_mean, 0.5_f64.sqrt()), "{told}");
        }
    }
}

/// In Δt on a fixed mesh. The phase is behind by ωt (kh)²(1 − r²)/24 at Courant number r, so that
/// e_mean² = E_0 [(kh)²/24 + ((kh)²(1 − r²)ωT/24)²/3]: as Δt goes to zero, the true error approaches a
/// plateau as Δt², from below, for the lumped mass and the time steps make opposite phase errors.
/// The estimate has no part in the phase: it stays on its plateau √E_0 kh/√24 at all r.
#[test]
fn plateau_in_time() {
    let kh = MODE.wave_number() * MODE.length / 40.0;
    let root = MODE.energy().sqrt();
    // Relative order (kh)² is left out, as above.
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 0.6 * kh * kh;
    let errors = |courant: f64| {
        let (motion, estimate, _) = run(40, courant, Acceleration::Closest);
        (distance(&motion, exact).1, estimate.error.mean)
    };
    let limit = errors(0.02);
    let mut left = Vec::new();
    for courant in [0.8, 0.4, 0.2, 0.1] {
        let (truth, estimate) = errors(courant);
        let drift = kh * kh * (1.0 - courant * courant) * 2.0 * PI * PERIODS / 24.0;
        let predicted = root * (kh * kh / 24.0 + drift * drift / 3.0).sqrt();
        assert!(close(truth, predicted), "true error at {courant}: {truth} instead of {predicted}");
        let plateau = root * kh / 24.0_f64.sqrt();
        assert!(close(estimate, plateau), "estimate at {courant}: {estimate} instead of {plateau}");
        left.push(limit.0 - truth);
    }
    for (coarse, fine) in left[1..].iter().zip(&left[2..]) {
        // Between 4 − O(r²) and what the limit, taken at r = 0.02 instead of 0, adds: 4 % of the last.
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.15, "order {order}: {left:?}");
    }
}

/// The time part alone. Against the mode of the mesh in continuous time, the simulation is ahead by
/// ψ = ωt x²/24, and v_n, the mean of two half-step velocities, is too small by x²/8:
/// e² = E_0 [ψ² sin²ωt + (ψ cos ωt − x²/8 sin ωt)²], of order 2 in Δt. The estimate sees
/// nothing of ψ, which accumulates; its kinetic part is zero at the t_n, where u̇_DA = v_n, and
/// between them u̇_DA − u̇_CA = Δt(a_{n+1} − a_n)/8: √(E_0) x²/8 |sin ωt|, of order 2 too.
#[test]
fn order_two_in_time() {
    let root = MODE.energy().sqrt();
    let elements = 40;
    let (k, h) = (MODE.wave_number(), MODE.length / elements as f64);
    let omega = 2.0 * 2.0 / h * (0.5 * k * h).sin();
    // P1 fields of the mesh's mode.
    let at_node = |i: f64| MODE.amplitude * (k * h * i).sin();
    let semi_discrete = |x: f64, t: f64| {
        let (i, s) = ((x / h).floor(), x / h - (x / h).floor());
        let (a, b) = (at_node(i), at_node(i + 1.0));
        let force = MODE.young * MODE.section * (b - a) / h * (omega * t).cos();
        (force, -omega * (a + s * (b - a)) * (omega * t).sin())
    };
    for courant in [0.8, 0.4, 0.2, 0.1] {
        let (motion, estimate, step) = run(elements, courant, Acceleration::Closest);
        let x = omega * step;
        let predicted = |t: f64| {
            let (psi, (sin, cos)) = (omega * t * x * x / 24.0, (omega * t).sin_cos());
            ((psi * sin).powi(2) + (psi * cos - x * x / 8.0 * sin).powi(2)).sqrt()
        };
        let sup = motion.times.iter().fold(0.0_f64, |m, t| m.max(predicted(*t)));
        let measured = distance(&motion, semi_discrete).0 / root;
        let kinetic = estimate.over_time.iter().fold(0.0_f64, |m, s| m.max(s.parts.kinetic)).sqrt() / root;
        // Of relative order (kh)² = 0.076: the energy of a P1 sine is smaller by (kh)²/6 than that of
        // the sine, and ω_0² by (kh)²/12; together (kh)²/8 of the norm, here 0.94 %. The shorter T of whole
        // steps and higher orders of x add at most 0.3 %.
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 0.25 * (k * h).powi(2);
        assert!(close(measured, sup), "true time error at {courant}: {measured} instead of {sup}");
        assert!(close(kinetic, x * x / 8.0), "kinetic part at {courant}: {kinetic} instead of {}", x * x / 8.0);
    }
}

/// What the auxiliary solution of `corrected` is for: the phase that the simulation loses, which the balance of its own
/// displacements loses too, and never tells, is seen.
#[test]
fn the_drift_of_the_phase_is_seen() {
    for (elements, courant) in [(20, 0.3), (40, 0.3), (40, 0.8)] {
        let of = |reconstruction| {
            let (motion, estimate, _) = run_with(elements, courant, Options { reconstruction, ..Options::default() });
            estimate.error.mean / distance(&motion, exact).1
        };
        let kh = MODE.wave_number() * MODE.length / elements as f64;
        let (corrected, consistent) = (of(Reconstruction::Corrected), of(Reconstruction::Consistent));
        let told = format!("{elements}, {courant}: {corrected} and {consistent}");
        // The auxiliary solution's own phase error, of relative order (kh)², is what is left of the drift.
        assert!((corrected - 1.0).abs() < 0.6 * kh * kh, "{told}");
        // Its plateau over the true error, as above.
        let drift = kh * kh * (1.0 - courant * courant) * 2.0 * PI * PERIODS / 24.0;
        let plateau = kh / 24.0_f64.sqrt();
        let lost = plateau / (plateau * plateau + drift * drift / 3.0).sqrt();
        assert!((consistent - lost).abs() < 0.6 * kh * kh, "{told}, {lost}");
    }
}
