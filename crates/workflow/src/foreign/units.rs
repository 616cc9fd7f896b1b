//! Quantities in other units, or simply wrong: factors of the terms of the balance, and the start.

use super::complete::Derived;
use super::limits::BALANCE;
use super::measure::Evidence;
use super::residual::{INERTIA, LOAD, REACTION, STIFFNESS};
use super::tried::{FALL, Tried};
use crate::message::times;

/// Two numbers that agree to this, relatively, are taken for equal.
const AGREE: f64 = 0.02;

/// A quantity, the factor that its numbers need, and the unit in which they are.
const UNITS: [(Quantity, f64, &str); 14] = [
    (Quantity::Length, 1e-3, "mm"),
    (Quantity::Length, 1e-2, "cm"),
    (Quantity::Length, 1e-6, "µm"),
    (Quantity::Time, 1e-3, "ms"),
    (Quantity::Time, 1e-6, "µs"),
    (Quantity::Modulus, 1e3, "kPa"),
    (Quantity::Modulus, 1e6, "MPa"),
    (Quantity::Modulus, 1e9, "GPa"),
    (Quantity::Density, 1e3, "g/cm³"),
    (Quantity::Density, 1e9, "kg/mm³"),
    (Quantity::Density, 1e12, "t/mm³"),
    (Quantity::Force, 1e3, "kN"),
    (Quantity::Force, 1e-3, "mN"),
    (Quantity::Force, 1e6, "MN"),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    Length,
    Time,
    Modulus,
    Density,
    Force,
}

impl Quantity {
    /// The hint that a factor gives, in brackets; nothing for any other factor.
    fn hint(self, factor: f64) -> String {
        if let Some((.., unit)) = UNITS.iter().find(|(quantity, value, _)| *quantity == self && agree(factor, *value)) {
            return format!(" (given in {unit}?)");
        }
        let power = factor.abs().log10() / 3.0;
        let whole = power.round() != 0.0 && agree(factor.abs(), 1000f64.powf(power.round()));
        if whole { " (units)".to_string() } else { String::new() }
    }
}

/// Factors of one term, or of two, that leave the least residual.
pub(super) fn scales<const D: usize, const N: usize>(evidence: &Evidence<'_, D, N>, derived: &[Derived]) -> Vec<Tried> {
    let (residual, open) = (&evidence.residual, derived.contains(&Derived::Reaction));
    let speed = evidence.ends.speed;
    let one = |term: usize| {
        let factors = residual.fit(&[term])?;
        // A factor of 1 is no cause.
        ((factors[term] - 1.0).abs() > 0.5 * BALANCE).then(|| (factors[term], residual.norm(factors)))
    };
    let named = [
        one(REACTION).map(|(factor, left)| (force(factor, speed), left)),
        one(INERTIA).filter(|(factor, _)| *factor > 0.0).map(|(factor, left)| (mass(factor, speed, open), left)),
        one(STIFFNESS).filter(|(factor, _)| *factor > 0.0 && !open).map(|(factor, left)| (young(factor), left)),
        one(LOAD).map(|(factor, left)| (load(factor, speed), left)),
    ];
    let mut tried: Vec<Tried> = named.into_iter().flatten().map(|(text, left)| Tried { text, left }).collect();
    tried.extend(residual.fit(&[INERTIA, REACTION]).and_then(|factors| {
        // Lengths in another unit: the mass of a plane body grows by its square, stiffness does not.
        let (of_m, of_r) = (factors[INERTIA], factors[REACTION]);
        let lengths = agree(of_m * of_r * of_r, 1.0) && speed.is_some_and(|speed| agree(speed, of_r));
        let text = format!("mesh and displacements {}", should(1.0 / of_r, Quantity::Length));
        lengths.then(|| Tried { text, left: residual.norm(factors) })
    }));
    tried
}

/// A displacement in another unit, by the velocity at the start and by the place of contact.
pub(super) fn displacements<const D: usize, const N: usize>(evidence: &Evidence<'_, D, N>) -> Option<String> {
    let speed = evidence.ends.speed.filter(|speed| speed.is_finite() && (speed - 1.0).abs() > BALANCE)?;
    let paths = evidence.contact.paths();
    let whole = paths.iter().all(|path| agree(path * speed, 1.0));
    let hint = Quantity::Length.hint(1.0 / speed);
    // Missing forces of the first step change the velocity, too.
    let whole = whole && (!hint.is_empty() || evidence.contact.forced.contains(&true));
    match () {
        () if !paths.is_empty() && whole => {
            Some(format!("the displacements {}", should(1.0 / speed, Quantity::Length)))
        }
        () if paths.is_empty() && !hint.is_empty() => Some(format!(
            "`initial_velocity`, or the unit of the displacements or of `time`, is not that of the history: it starts \
             with {} the stated velocity",
            times(speed)
        )),
        () => None,
    }
}

/// A factor of the contact forces.
fn force(factor: f64, speed: Option<f64>) -> String {
    if agree(factor, -1.0) {
        return "the sign of the contact forces is wrong: they are the forces of the planes on the body".to_string();
    }
    if of_displacements(factor, speed) {
        return format!("the displacements {}", should(1.0 / factor, Quantity::Length));
    }
    let half = if agree(factor, 2.0) || agree(factor, 0.5) { " (symmetry or thickness)" } else { "" };
    format!("the contact forces {}{half}", should(factor, Quantity::Force))
}

fn load(factor: f64, speed: Option<f64>) -> String {
    if of_displacements(factor, speed) {
        return format!("the displacements {}", should(1.0 / factor, Quantity::Length));
    }
    format!("the loads {}", should(factor, Quantity::Force))
}

/// Whether forces need the factor that the displacements have by the start.
fn of_displacements(factor: f64, speed: Option<f64>) -> bool {
    speed.is_some_and(|speed| agree(speed, factor) && (speed - 1.0).abs() > BALANCE)
}

fn young(factor: f64) -> String {
    format!("`young` is not that of the history: it {}", should(factor, Quantity::Modulus))
}

/// Another mass, or other times: the velocity at the start tells which. Without given contact forces, another modulus
/// has the same effect as another mass.
fn mass(factor: f64, speed: Option<f64>, open: bool) -> String {
    let scale = factor.sqrt();
    let time = format!("the steps should be {} as long{}", times(1.0 / scale), Quantity::Time.hint(1.0 / scale));
    let density = format!("it {}", should(factor, Quantity::Density));
    let modulus = format!("`young` {}", should(1.0 / factor, Quantity::Modulus));
    let [of_time, of_density] = speed.map_or([1.0; 2], |speed| [(speed * scale - 1.0).abs(), (speed - 1.0).abs()]);
    match () {
        () if of_time <= FALL * of_density => format!("`time` is not that of the history: {time}"),
        () if of_density <= FALL * of_time && open => {
            format!(
                "`density` or `young` is not that of the history: the density {}, or {modulus}",
                should(factor, Quantity::Density)
            )
        }
        () if of_density <= FALL * of_time => format!("`density` is not that of the history: {density}"),
        () => format!(
            "`density` or `time` is not that of the history: the density {}, or {time}",
            should(factor, Quantity::Density)
        ),
    }
}

/// The factor that numbers need, with the unit that it hints at.
fn should(factor: f64, quantity: Quantity) -> String {
    format!("should be {} as large{}", times(factor), quantity.hint(factor))
}

fn agree(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() <= AGREE
}
