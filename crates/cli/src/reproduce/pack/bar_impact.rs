//! Cases 1 and 4: the impact of a bar, of aluminium and for any gap, and of steel.

use super::super::{ReproduceError, Tally};
use super::row::Expected::{Order, Within};
use super::row::PackRow;
use super::text::CaseText;
use super::trial::{Trial, bar};
use super::{Curve, Outcome};
use percute_estimator::reference::bar_impact_error;
use percute_exact::BarImpact;

/// The bar of the paper, §7.1.4.
const ALUMINIUM: BarImpact =
    BarImpact { length: 0.1, young: 70e9, density: 2700.0, section: 0.02, speed: 400.0, gap: 2e-4 };
const STEEL: BarImpact =
    BarImpact { length: 1.0, young: 210e9, density: 7800.0, section: 3.14e-4, speed: 0.1, gap: 5e-5 };

/// Elements of the bar.
const MESHES: [usize; 4] = [50, 100, 200, 400];
/// Where in a step the impact lies.
const GAPS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Whole steps before it.
const FLIGHT: f64 = 2.0;
/// Of the critical step.
const COURANT: f64 = 0.9;

/// How many runs each case makes.
pub(super) const RUNS: usize = MESHES.len() * GAPS.len();
pub(super) const STEEL_RUNS: usize = MESHES.len();

const FRONT: &str =
    "a jump that the scheme disperses over a width of h^(2/3) (Airy front): its energy norm is of order 1/3";
const RETURN: &str = "what waits for the smeared front is as late as it is wide, h^(2/3)";
const PLATEAU: &str = "between the fronts only their tails are left: a thousandth of the force";

/// What one run says: error, rebound (m/s), duration (s), force (N), impact (s).
fn measure(trial: &Trial<1, 2>, exact: &BarImpact) -> Result<[f64; 5], ReproduceError> {
    let (impact, release) = (exact.impact_time(), exact.release_time());
    let contact = release - impact;
    let flight = 0.5 * trial.mass() * exact.speed * exact.speed;
    let error = bar_impact_error(&trial.case.problem, &trial.motion, exact)?.mean / flight.sqrt();
    let rebound = trial.mean_velocity(trial.times().len() - 1)[0];
    let force = trial.mean_force(impact + 0.25 * contact, impact + 0.75 * contact);
    // The first force brings the end to the plane: the impact is in that step.
    let first = trial.contact.first_touch().unwrap_or(f64::NAN) - 0.5 * trial.step();
    Ok([error, rebound, trial.contact_time(0.0, f64::INFINITY), force, first])
}

/// Of several gaps, the value furthest from the exact one on each mesh.
fn worst(runs: &[[f64; 5]], which: usize, exact: f64) -> f64 {
    let further = |a: f64, b: f64| if (b - exact).abs() > (a - exact).abs() { b } else { a };
    runs.iter().map(|run| run[which]).fold(exact, further)
}

/// The rows of a bar whose runs, mesh by mesh, are given; `step` is the longest one (s).
fn rows(exact: &BarImpact, meshes: &[Vec<[f64; 5]>], step: f64) -> Vec<PackRow> {
    let contact = exact.release_time() - exact.impact_time();
    let force = exact.contact_force(exact.impact_time() + 0.5 * contact);
    let row = |which: usize, quantity: &str, unit, exact: f64, expected, reason| PackRow {
        quantity: quantity.to_string(),
        unit,
        exact,
        computed: meshes.iter().map(|runs| worst(runs, which, exact)).collect(),
        expected,
        reason,
    };
    vec![
        row(0, "error over the energy norm of the flight, mean over time", "", 0.0, Order(1.0 / 3.0), FRONT),
        row(1, "velocity of the rebound", "m/s", exact.speed, Order(2.0 / 3.0), RETURN),
        row(2, "duration of contact", "s", contact, Order(2.0 / 3.0), RETURN),
        row(3, "contact force, middle half", "N", force, Within(1e-3 * force), PLATEAU),
        row(4, "impact", "s", exact.impact_time(), Within(step), "known to the step in which it falls"),
    ]
}

/// Contact force over time, exact and computed.
fn curve(trial: &Trial<1, 2>, exact: &BarImpact) -> Curve {
    let time = trial.times();
    Curve {
        quantity: "contact force",
        unit: "MN",
        exact: time.iter().map(|&t| 1e-6 * exact.contact_force(t)).collect(),
        computed: (0..time.len()).map(|n| 1e-6 * trial.normal_force(n)).collect(),
        time: time.iter().map(|t| 1e6 * t).collect(),
        time_unit: "µs",
    }
}

/// A bar whose wall is a fraction of a step away, and some steps.
fn aluminium_trial(
    elements: usize,
    gap: f64,
    tally: &mut Tally<'_>,
) -> Result<(Trial<1, 2>, BarImpact), ReproduceError> {
    let mut exact = ALUMINIUM;
    let steps = (exact.length / elements as f64) * COURANT / exact.wave_speed();
    exact.gap = (FLIGHT + gap) * steps * exact.speed;
    let end = exact.release_time() + 0.5 * (exact.release_time() - exact.impact_time());
    let text = CaseText::new("bar_impact", include_str!("../../../../../python/percute/verification/benchmarks/cases/bar_impact.toml"));
    let text = text.bar(exact.length, elements)?.number("point", -exact.gap)?.number("end", end)?;
    Ok((bar(&text, tally)?, exact))
}

/// Case 1.
pub(super) fn aluminium(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let (mut meshes, mut step, mut shown) = (Vec::new(), f64::NAN, None);
    for elements in MESHES {
        let mut runs = Vec::new();
        for gap in GAPS {
            let (trial, exact) = aluminium_trial(elements, gap, tally)?;
            let mut run = measure(&trial, &exact)?;
            // Each gap has an impact of its own.
            run[4] += ALUMINIUM.impact_time() - exact.impact_time();
            runs.push(run);
            step = trial.step();
            shown = shown.or_else(|| Some(curve(&trial, &exact)));
        }
        meshes.push(runs);
    }
    Ok(Outcome { rows: rows(&ALUMINIUM, &meshes, step), curve: shown })
}

/// Case 4.
pub(super) fn steel(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let (mut meshes, mut step) = (Vec::new(), f64::NAN);
    for elements in MESHES {
        let text = CaseText::new("steel_bar", include_str!("../../../../../python/percute/verification/benchmarks/cases/steel_bar.toml"));
        let trial = bar(&text.bar(STEEL.length, elements)?, tally)?;
        meshes.push(vec![measure(&trial, &STEEL)?]);
        step = trial.step();
    }
    Ok(Outcome { rows: rows(&STEEL, &meshes, step), curve: None })
}
