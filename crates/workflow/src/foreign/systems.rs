//! Arrays in another consistent system of units than the problem.
//!
//! Lengths, times and forces in units L, T and F that fit each other leave the balance as it is if all arrays are in
//! them. Of arrays in such units beside a problem in SI units, each term has a factor of its own.

use super::attempt::{Attempt, FALL};
use super::complete::{Completed, Derived, Lacks};
use super::diagnosis::Diagnosis;
use super::limits::exceeded;
use super::measure::measure;
use super::residual::{INERTIA, REACTION, STIFFNESS};
use super::samples::Samples;
use crate::message::trimmed;
use percute_core::dynamics::critical_time_step;
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::time::TimeGrid;

/// A consistent system of units.
#[derive(Clone, Copy, Debug)]
struct System {
    name: &'static str,
    /// Its units of length (m), time (s) and force (N).
    length: f64,
    time: f64,
    force: f64,
}

impl System {
    const fn new(name: &'static str, [length, time, force]: [f64; 3]) -> Self {
        Self { name, length, time, force }
    }

    /// That of an array in SI units beside a problem in this one.
    fn inverse(self) -> Self {
        Self { length: 1.0 / self.length, time: 1.0 / self.time, force: 1.0 / self.force, ..self }
    }

    fn speed(self) -> f64 {
        self.length / self.time
    }

    fn acceleration(self) -> f64 {
        self.length / (self.time * self.time)
    }

    /// The factors that arrays need, with their names.
    fn factors(self, given: [bool; 2], forces: bool) -> Vec<(&'static str, f64)> {
        let all = [
            ("displacements", self.length, true),
            ("times", self.time, true),
            ("contact forces", self.force, forces),
            ("velocities", self.speed(), given[0]),
            ("accelerations", self.acceleration(), given[1]),
        ];
        all.into_iter().filter(|&(_, factor, given)| given && !same(factor)).map(|(name, f, _)| (name, f)).collect()
    }
}

const INCH: f64 = 0.0254;
const POUND: f64 = 4.448_221_615_260_5;
/// Systems of explicit codes.
const SYSTEMS: [System; 8] = [
    System::new("mm-ms-kN-kg (GPa)", [1e-3, 1e-3, 1e3]),
    System::new("mm-ms-N-g (MPa)", [1e-3, 1e-3, 1.0]),
    System::new("mm-s-N-t (MPa)", [1e-3, 1.0, 1.0]),
    System::new("mm-s-mN-kg (kPa)", [1e-3, 1.0, 1e-3]),
    System::new("cm-µs-g (Mbar)", [1e-2, 1e-6, 1e7]),
    System::new("cm-s-dyn-g", [1e-2, 1.0, 1e-5]),
    System::new("in-s-lbf (psi)", [INCH, 1.0, POUND]),
    System::new("ft-s-lbf-slug", [12.0 * INCH, 1.0, POUND]),
];

/// Whether a factor changes nothing.
fn same(factor: f64) -> bool {
    (factor - 1.0).abs() < 1e-9
}

/// A history in other units.
struct Scaled<'s> {
    source: &'s dyn StepSource,
    times: TimeGrid,
    system: System,
    /// Whether contact forces are left out.
    without_forces: bool,
}

impl StepSource for Scaled<'_> {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn count(&self) -> usize {
        self.source.count()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        let system = self.system;
        let of = |field: &[f64], factor: f64| field.iter().map(|x| factor * x).collect::<Vec<f64>>();
        self.source.replay(&mut |step| {
            let velocity = step.velocity.map(|field| of(field, system.speed()));
            let acceleration = step.acceleration.map(|field| of(field, system.acceleration()));
            take(&Step {
                time: self.times.instants()[step.index],
                displacement: &of(step.displacement, system.length),
                reaction: &of(step.reaction, if self.without_forces { 0.0 } else { system.force }),
                velocity: velocity.as_deref(),
                acceleration: acceleration.as_deref(),
                ..*step
            })
        })
    }
}

/// The systems in which the arrays fit the problem in all, if they do not as they are.
pub(super) fn whole(diagnosis: &Diagnosis<'_>) -> Result<Option<String>, SinkError> {
    let (given, forces) = (diagnosis.evidence.given, diagnosis.has_forces());
    for inverse in [false, true] {
        let mut fit = Vec::new();
        for system in SYSTEMS.map(|system| if inverse { system.inverse() } else { system }) {
            // One array in another unit is no other system.
            if system.factors(given, forces).len() < 2 || !balances(diagnosis, system) {
                continue;
            }
            if let Some(left) = left(diagnosis, system)? {
                fit.push((system, left));
            }
        }
        if let Some((first, left)) = fit.first() {
            // Without forces, systems with the same lengths and times are the same.
            let names: Vec<&str> = fit.iter().map(|(system, _)| system.name).collect();
            let text = told(*first, &names.join(" or "), inverse, &first.factors(given, forces));
            let attempt = Attempt { text, before: diagnosis.residual(), left: *left };
            // Where the initial velocity alone contradicts the problem, there is no residual to fall.
            return Ok(Some(if attempt.explains() { attempt.told() } else { attempt.text }));
        }
    }
    Ok(None)
}

/// Whether the factors of all terms leave little of a residual inside the body.
fn balances(diagnosis: &Diagnosis<'_>, system: System) -> bool {
    let mut factors = [1.0; 4];
    (factors[INERTIA], factors[STIFFNESS], factors[REACTION]) = (system.acceleration(), system.length, system.force);
    diagnosis.evidence.residual.inside_with(factors) <= FALL
}

/// The norm of the residual in SI units, if nothing contradicts the problem then.
fn left(diagnosis: &Diagnosis<'_>, system: System) -> Result<Option<f64>, SinkError> {
    let (problem, source) = (diagnosis.problem, diagnosis.source);
    // What was derived in the units that are given is derived again, also if that was nothing.
    let silent = !diagnosis.evidence.contact.forced.contains(&true);
    let [reaction, touching] =
        [Derived::Reaction, Derived::Touching].map(|part| silent || diagnosis.derived.contains(&part));
    let instants = source.times().instants().iter().map(|t| system.time * t).collect();
    let Ok(times) = TimeGrid::from_instants(instants) else { return Ok(None) };
    let scaled = Scaled { source, times, system, without_forces: reaction };
    let Ok(complete) = Completed::new(problem, &scaled, Lacks { reaction, touching }) else { return Ok(None) };
    let (found, evidence) = measure(problem, &complete, complete.derived(), 0)?;
    let samples = Samples::of(&complete, &found, evidence.given, critical_time_step(problem));
    Ok(exceeded(&found, samples.is_some()).is_empty().then(|| evidence.residual.norm([1.0; 4])))
}

fn told(system: System, names: &str, inverse: bool, factors: &[(&str, f64)]) -> String {
    let factors: Vec<String> = factors.iter().map(|(name, f)| format!("{name} by {}", trimmed(*f, 6))).collect();
    let factors = factors.join(", ");
    match inverse {
        false => format!("the arrays are in the system of units {names}, the problem in SI units: multiply {factors}"),
        true => format!(
            "the problem is in the system of units {names}, the arrays in SI units: give the problem in SI units, \
             lengths in m ({} m each) and times in s; or multiply {factors}",
            trimmed(1.0 / system.length, 6)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_those_of_consistent_units() {
        let of = |name: &str| SYSTEMS.into_iter().find(|system| system.name.starts_with(name)).unwrap();
        let masses =
            [("mm-ms-kN-kg", 1.0), ("mm-ms-N-g", 1e-3), ("mm-s-N-t", 1e3), ("mm-s-mN-kg", 1.0), ("cm-µs-g", 1e-3)];
        for (name, mass) in masses.into_iter().chain([("cm-s-dyn", 1e-3), ("ft-s-lbf", 14.593_902_937)]) {
            let system = of(name);
            // F = m a, to the digits of the slug.
            assert!((mass * system.acceleration() / system.force - 1.0).abs() < 1e-9, "{name}");
        }
        assert_eq!(of("mm-ms-kN").factors([true; 2], true).len(), 4, "velocities in mm/ms are those in m/s");
        assert_eq!(of("mm-s-N").factors([false; 2], true).len(), 1);
    }
}
