//! Smooth fields, and one with a kink.

use crate::rows::check;

/// The lag of phase after a time T is ωT(kh)²(1 − r²)/24: with 2.25 periods, kL = 3π/2, r = 0.7 and 80 elements 1.043e-3, and 5 % for
/// the next term and the rounding of r. The energy norm has the piecewise constant stress: kh/√12 of half of the energy, 0.0120.
#[test]
fn bar_mode() {
    let (kh, turns) = (1.5 * std::f64::consts::PI / 80.0, 2.25 * std::f64::consts::TAU);
    let lag = turns * kh * kh * (1.0 - 0.49) / 24.0;
    let stress = kh / 12.0_f64.sqrt() * 0.5_f64.sqrt();
    check("bar_mode", &[("largest error", 1.95..=2.05, 1.05 * lag), ("error over", 0.9..=1.1, 1.05 * stress)]);
}

/// As for the bar, times the root mean square ½ of a mode, and half as much again for the shape of the elements: 1.2 periods, 40 cells.
#[test]
fn block_mode() {
    let pi = std::f64::consts::PI;
    let squares = (pi / 0.05).powi(2) + (pi / 0.04).powi(2);
    let lag = 0.5 * 1.2 * std::f64::consts::TAU * squares * (0.05_f64 / 40.0).powi(2) / 24.0;
    check("block_mode", &[("pressure", 1.9..=2.1, 1.5 * lag), ("shear", 1.9..=2.1, 1.5 * lag)]);
}

/// On 200 elements: a kink of u'' smeared over 0.03 L; (1/n)^(5/3), n⁻² and 1/n of what is largest, all with a factor below 1.
#[test]
fn bar_ramp() {
    let n = 200.0_f64;
    check(
        "bar_ramp",
        &[
            // From 2, of the smooth part, to 5/3.
            ("root mean square", 1.6..=2.1, n.powf(-5.0 / 3.0)),
            ("displacement of the pulled end", 1.7..=2.2, 1.29e-4 / (n * n)),
            ("error over", 0.9..=1.1, 1.0 / n),
        ],
    );
}
