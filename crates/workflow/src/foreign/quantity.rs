//! Quantities, and the units that factors hint at.

use crate::message::times;

/// Two numbers that agree to this, relatively, are taken for equal.
const AGREE: f64 = 0.02;

/// A quantity, the factor that its numbers need, and the unit in which they are.
const UNITS: [(ScaledQuantity, f64, &str); 16] = [
    (ScaledQuantity::Length, 1e-3, "mm"),
    (ScaledQuantity::Length, 1e-2, "cm"),
    (ScaledQuantity::Length, 1e-6, "µm"),
    (ScaledQuantity::Time, 1e-3, "ms"),
    (ScaledQuantity::Time, 1e-6, "µs"),
    (ScaledQuantity::Velocity, 1e-3, "mm/s"),
    (ScaledQuantity::Velocity, 1e-2, "cm/s"),
    (ScaledQuantity::Modulus, 1e3, "kPa"),
    (ScaledQuantity::Modulus, 1e6, "MPa"),
    (ScaledQuantity::Modulus, 1e9, "GPa"),
    (ScaledQuantity::Density, 1e3, "g/cm³"),
    (ScaledQuantity::Density, 1e9, "kg/mm³"),
    (ScaledQuantity::Density, 1e12, "t/mm³"),
    (ScaledQuantity::Force, 1e3, "kN"),
    (ScaledQuantity::Force, 1e-3, "mN"),
    (ScaledQuantity::Force, 1e6, "MN"),
];

/// What a factor belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ScaledQuantity {
    Length,
    Time,
    Velocity,
    Modulus,
    Density,
    Force,
}

impl ScaledQuantity {
    /// The hint that a factor gives, in brackets; nothing for any other factor.
    pub(super) fn hint(self, factor: f64) -> String {
        if let Some((.., unit)) = UNITS.iter().find(|(quantity, value, _)| *quantity == self && agree(factor, *value)) {
            return format!(" (given in {unit}?)");
        }
        let power = factor.abs().log10() / 3.0;
        let whole = power.round() != 0.0 && agree(factor.abs(), 1000f64.powf(power.round()));
        if whole { " (units)".to_string() } else { String::new() }
    }
}

/// Whether a factor of lengths is that of a unit.
pub(super) fn of_unit(factor: f64) -> bool {
    ScaledQuantity::Length.hint(factor).contains("given in")
}

/// The factor that numbers need, with the unit that it hints at.
pub(super) fn should(factor: f64, quantity: ScaledQuantity) -> String {
    format!("should be {} as large{}", times(factor), quantity.hint(factor))
}

/// Whether two numbers are equal but for digits that are not known.
pub(super) fn agree(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() <= AGREE
}
