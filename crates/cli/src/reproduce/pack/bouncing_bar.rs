//! Case 2: a bar that bounces under gravity.

use super::super::{ReproduceError, Tally};
use super::field_error::mean_error;
use super::row::Expected::Order;
use super::row::PackRow;
use super::text::CaseText;
use super::trial::{Trial, bar};
use super::{Curve, Outcome};
use percute_exact::BouncingBar;

/// Elements of the bar.
const MESHES: [usize; 4] = [50, 100, 200, 400];
pub(super) const RUNS: usize = MESHES.len();

const GRAVITY: f64 = 10.0;
const HEIGHT: f64 = 5.0;

const FRONT: &str = "each bounce sends jumps of velocity through the bar: order 1/3 in the energy norm";
const RETURN: &str = "a bounce ends when the smeared front is back: order 2/3";
const HALF_MASS: &str =
    "at each impact the mass of the node that touches, ρSh/2, is stopped, and its energy is lost: order 1";

/// Doyen, Ern and Piperno's.
fn exact() -> Result<BouncingBar, ReproduceError> {
    BouncingBar::new(10.0, 900.0, 1.0, 1.0, GRAVITY, HEIGHT)
        .ok_or_else(|| ReproduceError::Unexpected("the bar does not bounce for ever".to_string()))
}

/// Error, impulse (N s) of all bounces, second impact (s), height (m) after a period, energy (J) after two.
fn measure(trial: &Trial<1, 2>, exact: &BouncingBar) -> [f64; 5] {
    let error = mean_error(trial, |x, t| (exact.velocity(x, t), exact.normal_force(x, t))) / exact.energy().sqrt();
    let airborne = exact.impact_time() + exact.contact_duration() + exact.impact_time();
    let second = trial.between(airborne, f64::INFINITY).find(|&n| trial.normal_force(n) > 0.0);
    let second = second.map_or(f64::NAN, |n| trial.times()[n] + 0.5 * trial.step());
    let height = trial.mean_displacement_at(exact.period())[0] + HEIGHT;
    let last = trial.times().len() - 1;
    let impulse = trial.contact.total[last].impulse[0];
    let potential = trial.mass() * GRAVITY * (trial.mean_displacement(last)[0] + HEIGHT);
    [error, impulse, second, height, trial.energy(last) + potential]
}

/// Case 2.
pub(super) fn bouncing(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let exact = exact()?;
    let (mut runs, mut curve) = (Vec::new(), None);
    for elements in MESHES {
        let text = CaseText::new("bouncing_bar", include_str!("../../../../../python/percute/verification/benchmarks/cases/bouncing_bar.toml"));
        let trial = bar(&text.bar(10.0, elements)?, tally)?;
        runs.push(measure(&trial, &exact));
        let time = trial.times().to_vec();
        curve = curve.or_else(|| {
            Some(Curve {
                quantity: "gap of the lower end",
                unit: "m",
                exact: time.iter().map(|&t| exact.displacement(0.0, t) + HEIGHT).collect(),
                computed: trial.motion.displacement.iter().map(|u| u[0][0] + HEIGHT).collect(),
                time,
                time_unit: "s",
            })
        });
    }
    let row = |which: usize, quantity: &str, unit, exact: f64, order: f64, reason| PackRow {
        quantity: quantity.to_string(),
        unit,
        exact,
        computed: runs.iter().map(|run| run[which]).collect(),
        expected: Order(order),
        reason,
    };
    let contact = exact.contact_duration();
    // It is at rest again: the bounces have given back what the weight gave.
    let impulse = exact.energy() / HEIGHT * 2.0 * exact.period();
    let second = exact.impact_time() + contact + 2.0 * exact.impact_time();
    let rows = vec![
        row(0, "error over the energy norm, mean over two periods", "", 0.0, 1.0 / 3.0, FRONT),
        row(1, "impulse of four bounces", "N s", impulse, 2.0 / 3.0, RETURN),
        row(2, "second impact", "s", second, 2.0 / 3.0, RETURN),
        row(3, "height of the bar after a period of 16/3 s", "m", HEIGHT, 2.0 / 3.0, RETURN),
        row(4, "energy after four bounces", "J", exact.energy(), 1.0, HALF_MASS),
    ];
    Ok(Outcome { rows, curve })
}
