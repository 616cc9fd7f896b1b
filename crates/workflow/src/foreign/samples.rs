//! Histories that are sampled more coarsely than the steps of their solver.

use super::figures::Consistency;
use super::limits::BALANCE;
use super::window::{Held, windows};
use crate::message::{percent, trimmed};
use percute_core::history::{SinkError, Step, StepSource};
use percute_core::time::{TimeError, TimeGrid, is_stable};
use serde::Serialize;

/// Courant number of the instants between samples.
const COURANT: f64 = 0.9;
/// Instants that are more critical steps apart are samples: the critical step is known to 1e-3, and other programs
/// round theirs.
const SAMPLED: f64 = 1.05;
/// Instants that balance to this are all steps of a solver, however long: it may be unstable.
const EXACT: f64 = 1e-6;
/// Samples at most so many critical steps apart have the mean of all steps within some 10 % (docs/foreign.md).
const GOOD: f64 = 5.0;

/// Between samples that are more critical steps apart, nothing of the motion is known: waves have crossed 50 elements
/// or more. The estimate of the bar is several times too large at 40 (docs/foreign.md).
const FAR: f64 = 50.0;

/// The samples of a history.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Samples {
    /// Their number.
    pub count: usize,
    /// The longest time between two of them (s).
    pub distance: f64,
    /// The same over the critical step.
    pub critical_steps: f64,
}

impl Samples {
    /// The samples, if velocities and accelerations are `given` and the steps of the solver were shorter: beyond the
    /// critical step (s), or by the accelerations.
    pub(super) fn of(source: &dyn StepSource, found: &Consistency, given: [bool; 2], critical: f64) -> Option<Self> {
        let (count, distance) = (source.count(), source.times().longest_step());
        let shorter = !is_stable(distance, critical) || found.acceleration.is_some_and(|differs| differs > BALANCE);
        let samples = Self { count, distance, critical_steps: distance / critical };
        (shorter && given == [true; 2]).then_some(samples)
    }
}

/// What samples without velocities or accelerations show, and the way out; a body that `touches` nothing may fly in
/// long steps. Where non-matching interfaces have contact forces, velocities and accelerations are not enough.
pub(super) fn lacking(
    source: &dyn StepSource,
    found: &Consistency,
    (given, [touches, slides]): ([bool; 2], [bool; 2]),
    critical: f64,
) -> Option<(String, String)> {
    let (times, distance) = (source.times(), source.times().longest_step());
    let whole = given == [true; 2];
    if whole && !slides {
        return None;
    }
    let long = (0..times.step_count()).filter(|&n| times.step(n) > SAMPLED * critical).count();
    // A few long steps are steps, or instants are missing there: the balance tells.
    let flight = !touches && found.balance.max(found.initial_velocity) <= BALANCE;
    // An instant between two others has a balance; that of given accelerations says nothing about steps.
    let exact = found.balance <= EXACT && source.count() > 2 && !whole;
    let beyond = 2 * long > times.step_count() && !exact && !flight;
    let differs = |differs: &f64| given == [false, true] && *differs > BALANCE && found.balance <= BALANCE;
    let differs = found.acceleration.filter(differs);
    if !beyond && differs.is_none() {
        return None;
    }
    let figure = match differs {
        Some(differs) => {
            format!("its accelerations differ from those of the displacements by {}", percent(differs))
        }
        None => format!("its instants are up to {} critical steps apart (limit 1)", trimmed(distance / critical, 3)),
    };
    let way_out = if slides {
        ", since contact forces of non-matching interfaces are not derived between samples".to_string()
    } else {
        format!(", or give {} too, {}", missing(given), near(times, critical))
    };
    Some((figure, format!("{}{way_out}; or `time` is not in seconds", all_steps(times, critical))))
}

/// That samples with velocities and accelerations are too far apart, and the way out.
pub(super) fn too_far(times: &TimeGrid, critical: f64) -> Option<(String, String)> {
    let apart = times.longest_step() / critical;
    (apart > FAR).then(|| {
        let figure = format!("its instants are up to {} critical steps apart (limit {FAR})", trimmed(apart, 3));
        let every = format!("store each n-th step, {}", near(times, critical));
        (figure, format!("{}, or {every}; or `time` is not in seconds", all_steps(times, critical)))
    })
}

/// The first way out of samples: all steps.
fn all_steps(times: &TimeGrid, critical: f64) -> String {
    format!(
        "the instants are samples, not the steps of the solver: give all steps, at most {} s apart ({} instants or \
         more)",
        trimmed(critical, 4),
        instants(times, critical)
    )
}

/// How near samples should be.
fn near(times: &TimeGrid, critical: f64) -> String {
    let count = instants(times, GOOD * critical);
    format!("at most {GOOD} critical steps apart for a good estimate ({count} instants or more)")
}

/// The number of instants so far apart (s).
fn instants(times: &TimeGrid, apart: f64) -> usize {
    (times.end() / apart).ceil() as usize + 1
}

/// What samples need that is not `given`.
pub(super) fn missing(given: [bool; 2]) -> &'static str {
    match given {
        [false, false] => "velocities and accelerations",
        [false, true] => "velocities",
        _ => "accelerations",
    }
}

/// A history with instants between its samples, less than a critical step apart. The motion between two samples is the
/// polynomial of degree 5 that has their displacements, velocities and accelerations. It has no contact forces.
pub(crate) struct Between<'s> {
    samples: &'s dyn StepSource,
    dimension: usize,
    /// The index of each sample among all instants.
    pub(crate) starts: Vec<usize>,
    times: TimeGrid,
}

/// Weights of the displacement, velocity and acceleration (each over its power of Δt) of the first and the second
/// sample.
type Weights = [f64; 6];

impl<'s> Between<'s> {
    /// Instants between samples for this critical step (s).
    pub(crate) fn new(samples: &'s dyn StepSource, dimension: usize, critical: f64) -> Result<Self, TimeError> {
        let given = &samples.times().instants()[..samples.count()];
        let (mut instants, mut starts) = (vec![given[0]], vec![0]);
        for pair in given.windows(2) {
            let parts = ((pair[1] - pair[0]) / (COURANT * critical)).ceil().max(1.0) as usize;
            let inner = (1..parts).map(|j| pair[0] + (pair[1] - pair[0]) * (j as f64 / parts as f64));
            instants.extend(inner);
            instants.push(pair[1]);
            starts.push(instants.len() - 1);
        }
        Ok(Self { samples, dimension, starts, times: TimeGrid::from_instants(instants)? })
    }

    /// The motion at an instant between two samples.
    fn motion(&self, from: &Step<'_>, to: &Step<'_>, index: usize) -> Option<[Vec<f64>; 3]> {
        let dt = to.time - from.time;
        let s = (self.times.instants()[index] - from.time) / dt;
        let (velocity, acceleration) = (from.velocity?, from.acceleration?);
        let (next_velocity, next_acceleration) = (to.velocity?, to.acceleration?);
        let of = |weights: Weights, scale: f64| {
            let value = |at: usize| {
                let values = [
                    from.displacement[at],
                    dt * velocity[at],
                    dt * dt * acceleration[at],
                    to.displacement[at],
                    dt * next_velocity[at],
                    dt * dt * next_acceleration[at],
                ];
                weights.iter().zip(values).map(|(weight, value)| weight * value).sum::<f64>() / scale
            };
            (0..from.displacement.len()).map(value).collect()
        };
        let [place, rate, curvature] = weights(s);
        Some([of(place, 1.0), of(rate, dt), of(curvature, dt * dt)])
    }
}

/// The quintic Hermite polynomials at s in [0, 1], and their first and second derivatives.
fn weights(s: f64) -> [Weights; 3] {
    const POWERS: [[f64; 6]; 6] = [
        [1.0, 0.0, 0.0, -10.0, 15.0, -6.0],
        [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
        [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
        [0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
        [0.0, 0.0, 0.0, -4.0, 7.0, -3.0],
        [0.0, 0.0, 0.0, 0.5, -1.0, 0.5],
    ];
    let derivative = |powers: [f64; 6]| -> [f64; 6] {
        std::array::from_fn(|k| if k < 5 { (k + 1) as f64 * powers[k + 1] } else { 0.0 })
    };
    let value = |powers: [f64; 6]| powers.iter().rev().fold(0.0, |sum, power| sum * s + power);
    [
        POWERS.map(value),
        POWERS.map(|powers| value(derivative(powers))),
        POWERS.map(|powers| value(derivative(derivative(powers)))),
    ]
}

impl StepSource for Between<'_> {
    fn times(&self) -> &TimeGrid {
        &self.times
    }

    fn count(&self) -> usize {
        self.times.instants().len()
    }

    fn replay(&self, take: &mut dyn FnMut(&Step<'_>) -> Result<(), SinkError>) -> Result<(), SinkError> {
        windows(self.samples, self.dimension, &mut |window| {
            let now = window.now.step();
            let (reaction, touching) = (vec![0.0; now.reaction.len()], vec![false; now.touching.len()]);
            let start = self.starts[now.index];
            take(&Step { index: start, time: now.time, reaction: &reaction, touching: &touching, ..now })?;
            let Some(after) = window.after.map(Held::step) else { return Ok(()) };
            for index in start + 1..self.starts[after.index] {
                let Some([displacement, velocity, acceleration]) = self.motion(&now, &after, index) else { continue };
                take(&Step {
                    index,
                    time: self.times.instants()[index],
                    displacement: &displacement,
                    reaction: &reaction,
                    touching: &touching,
                    internal: &[],
                    velocity: Some(&velocity),
                    acceleration: Some(&acceleration),
                })?;
            }
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_five_are_exact() {
        // u = s⁵ between 0 and 1: u, u', u'' are 0 at 0, and 1, 5, 20 at 1.
        for s in [0.0, 0.3, 0.5, 1.0] {
            let [place, rate, curvature] = weights(s);
            let of = |w: Weights| w[3] + 5.0 * w[4] + 20.0 * w[5];
            let expected = [s.powi(5), 5.0 * s.powi(4), 20.0 * s.powi(3)];
            for (found, expected) in [place, rate, curvature].map(of).into_iter().zip(expected) {
                // A few roundings of numbers up to 20 · 60.
                assert!((found - expected).abs() < 1e-12, "{s}: {found} {expected}");
            }
        }
    }
}
