//! Displacements against the integral of given velocities, and velocities against that of given accelerations.
//!
//! The integrals are trapezoidal sums from t_0 on: errors of samples far apart do not add up there, as those of single
//! steps do.

use super::quantity::{ScaledQuantity, agree, should};
use super::units::{displaced, steps};
use super::{Contradiction, ratio};
use crate::message::times;
use percute_core::history::{SinkError, StepSource};
use percute_core::problem::AnyProblem;

/// Limit of the factor between displacements and integral, less 1. Histories of percute (bar, block, tilted block and
/// disc, normal and oblique, 0.1 to 0.9 Δt_c) have at most 0.01 at the distance of 1.8 Δt_c, and 0.046 at that of 9.
const FACTOR: f64 = 0.05;
/// Farther apart, the sums miss what happens between two samples, and the factor says less. It is at most so many times
/// the square of the misfit that it leaves: 4.6 for the same histories with 2 to 100 samples up to 45 Δt_c apart.
const SCATTER: f64 = 6.0;
/// Accelerations tell between two causes that ask of them for factors this share of the whole factor apart, or more.
const TELLS: f64 = 0.5;

/// Sums over all nodes and instants of a field and of the integral of its rate.
#[derive(Clone, Debug)]
struct Integral {
    start: Vec<f64>,
    rate: Vec<f64>,
    sum: Vec<f64>,
    /// ∑x·s, ∑s², ∑x² of the change x of the field and of the integral s.
    products: [f64; 3],
}

impl Integral {
    fn new(field: &[f64], rate: &[f64]) -> Self {
        let [start, rate] = [field, rate].map(<[_]>::to_vec);
        Self { sum: vec![0.0; start.len()], start, rate, products: [0.0; 3] }
    }

    /// Takes in the field and its rate dt (s) later.
    fn take(&mut self, field: &[f64], rate: &[f64], dt: f64) {
        for (at, (value, now)) in field.iter().zip(rate).enumerate() {
            self.sum[at] += 0.5 * dt * (self.rate[at] + now);
            let (x, s) = (value - self.start[at], self.sum[at]);
            self.products[0] += x * s;
            self.products[1] += s * s;
            self.products[2] += x * x;
        }
        self.rate.copy_from_slice(rate);
    }

    /// The field over the integral, and the square of the misfit that this factor leaves, relative; none at rest.
    fn factor(&self) -> Option<[f64; 2]> {
        let [both, integral, field] = self.products;
        let factor = both / integral;
        let rest = (1.0 - both * factor / field).max(0.0);
        (factor.is_finite() && rest.is_finite()).then_some([factor, rest])
    }
}

/// What given velocities and accelerations say of each other and of the displacements.
struct Travel {
    /// Displacements over the integral of the velocities, and the square of the misfit.
    way: [f64; 2],
    /// The same of the velocities and the integral of the accelerations.
    speed: Option<[f64; 2]>,
    /// The given velocity at t_0 over that of the problem.
    start: Option<f64>,
}

/// That the displacements have a factor against the integral of the velocities, with its likely cause; none without
/// velocities.
pub(super) fn contradiction(problem: &AnyProblem, source: &dyn StepSource) -> Result<Option<Contradiction>, SinkError> {
    let Some(travel) = Travel::of(problem, source)? else { return Ok(None) };
    let ([factor, rest], limit) = (travel.way, travel.limit());
    Ok(((factor - 1.0).abs() > limit).then(|| Contradiction {
        figure: format!(
            "the displacements since t_0 are {} the integral of the velocities, with a misfit of {} (limits {} and {})",
            times(factor),
            crate::message::percent(rest.sqrt()),
            times(1.0 - limit),
            times(1.0 + limit)
        ),
        cause: Some(travel.cause()),
        can_be_accepted: true,
    }))
}

impl Travel {
    fn of(problem: &AnyProblem, source: &dyn StepSource) -> Result<Option<Self>, SinkError> {
        let (mut way, mut speed, mut start) = (None, None, None);
        let (mut before, mut absent) = (0.0, false);
        let read = source.replay(&mut |step| {
            let Some(velocity) = step.velocity else {
                absent = true;
                return Err("no velocities".into());
            };
            let dt = step.time - std::mem::replace(&mut before, step.time);
            if step.index == 0 {
                start = share(velocity, problem.initial_velocity());
                way = Some(Integral::new(step.displacement, velocity));
                speed = step.acceleration.map(|acceleration| Integral::new(velocity, acceleration));
                return Ok(());
            }
            if let Some(way) = &mut way {
                way.take(step.displacement, velocity, dt);
            }
            if let (Some(speed), Some(acceleration)) = (&mut speed, step.acceleration) {
                speed.take(velocity, acceleration, dt);
            }
            Ok(())
        });
        // Nothing more is read without velocities.
        if absent {
            return Ok(None);
        }
        read?;
        let speed = speed.and_then(|speed| speed.factor());
        Ok(way.and_then(|way| way.factor()).map(|way| Self { way, speed, start }))
    }

    /// How far the factor may be from 1.
    fn limit(&self) -> f64 {
        FACTOR.max(SCATTER * self.way[1])
    }

    /// The array with the factor: times, displacements or velocities, as far as the initial velocity and the
    /// accelerations tell.
    fn cause(&self) -> String {
        let factor = known(self.way[0]);
        let near = |a: Option<f64>| a.is_some_and(|a| (a - 1.0).abs() <= self.limit());
        let velocities = format!("the velocities {}", should(factor, ScaledQuantity::Velocity));
        if near(self.start.map(|start| start * factor)) {
            return velocities;
        }
        if factor < 0.0 {
            return displaced(factor);
        }
        let told = [
            (factor.ln(), format!("`time` is not that of the history: {}", steps(factor))),
            (0.0, displaced(factor)),
            (-factor.ln(), velocities),
        ];
        let may_be_velocities = !near(self.start);
        let told = &told[..if may_be_velocities { 3 } else { 2 }];
        // Contact forces change between samples: a sum of accelerations that misses much of them tells little.
        let tells = |[speed, rest]: &[f64; 2]| *speed > 0.0 && factor.ln().abs() > SCATTER * rest;
        let speed = self.speed.filter(tells).map(|[speed, _]| speed.ln());
        let fits = |expected: f64| speed.is_some_and(|found| (found - expected).abs() < TELLS * factor.ln().abs());
        let choose = |of: &dyn Fn(&(f64, String)) -> bool| -> Vec<&str> {
            told.iter().filter(|one| of(one)).map(|(_, text)| text.as_str()).collect()
        };
        let [by_speed, by_unit] = [choose(&|one| fits(one.0)), choose(&|one| one.1.contains("given in"))];
        let all = choose(&|_| true);
        [by_speed, by_unit, all].into_iter().find(|chosen| !chosen.is_empty()).unwrap_or_default().join(", or ")
    }
}

/// A factor in the digits that samples tell: a power of ten of units, else two digits.
fn known(factor: f64) -> f64 {
    let power = 10f64.powf(factor.abs().log10().round());
    if agree(factor.abs(), power) {
        return power.copysign(factor);
    }
    let digit = 10f64.powf(factor.abs().log10().floor() - 1.0);
    (factor / digit).round() * digit
}

/// The factor of the second field that fits the first best; none if it is zero.
fn share(field: &[f64], stated: &[f64]) -> Option<f64> {
    let pairs = field.iter().zip(stated);
    let [along, own] = pairs.fold([0.0; 2], |[along, own], (v, v0)| [along + v * v0, own + v0 * v0]);
    (own > 0.0).then(|| ratio(along, own))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn travel(way: f64, speed: Option<f64>, start: Option<f64>) -> Travel {
        Travel { way: [way, 1e-4], speed: speed.map(|speed| [speed, 1e-3]), start }
    }

    #[test]
    fn initial_velocity_and_accelerations_tell_the_array() {
        let said = |way, speed, start| travel(way, speed, start).cause();
        let (micro, none) = (Some(1e-6), None);
        // Times in µs, displacements in mm, velocities in mm/s: each with the accelerations and without.
        for speed in [micro, none] {
            assert!(said(1e-6, speed, Some(1.0)).contains("1e-6 times as long (given in µs?)"), "{speed:?}");
        }
        for speed in [Some(0.3), none] {
            assert!(said(1e3, speed, Some(1.0)).starts_with("the displacements should be 0.001 times"), "{speed:?}");
            assert!(said(1e-3, speed, Some(1e3)).starts_with("the velocities should be 0.001 times"), "{speed:?}");
        }
        // A body that starts at rest: the accelerations alone.
        assert!(
            said(1e-3, Some(1e3), none).starts_with("the velocities should be 0.001 times as large (given in mm/s?)")
        );
        // Nothing tells: all of them.
        let all = said(0.9, none, none);
        assert!(
            ["time", "the displacements should be 1.111 times", "the velocities should be 0.9 times"]
                .iter()
                .all(|t| all.contains(t))
        );
        let scattered = Travel { speed: Some([1.0, 0.2]), ..travel(0.9, none, Some(1.0)) };
        let two = scattered.cause();
        assert!(two.contains("0.9 times as long, or the displacements") && !two.contains("velocities"), "{two}");
    }

    #[test]
    fn the_trapezoidal_sum_is_exact_for_a_constant_acceleration() {
        let at = |t: f64| ([3.0 * t + t * t], [3.0 + 2.0 * t]);
        let ((u, v), dt) = (at(0.0), 0.5);
        let mut way = Integral::new(&u, &v);
        for n in 1..5 {
            let (u, v) = at(n as f64 * dt);
            way.take(&u.map(|u| 0.8 * u), &v, dt);
        }
        let [factor, rest] = way.factor().unwrap();
        assert!((factor - 0.8).abs() < 1e-14 && rest < 1e-14, "{factor} {rest}");
    }
}
