//! Case 3: a clamped rod that springs back against an obstacle.

use super::super::{ReproduceError, Tally};
use super::field_error::mean_error;
use super::row::Expected::{Order, Within};
use super::row::PackRow;
use super::text::CaseText;
use super::trial::{Trial, bar};
use super::{Curve, Outcome};
use percute_exact::ClampedRod;

const ROD: ClampedRod = ClampedRod { length: 1.0, young: 1.0, density: 1.0, section: 1.0, distance: 0.5 };
/// Elements of the rod.
const MESHES: [usize; 5] = [20, 40, 80, 160, 320];
pub(super) const RUNS: usize = MESHES.len();

const FRONT: &str = "jumps of velocity run through the rod all the time: order 1/3 in the energy norm";
const RETURN: &str = "as late as the smeared front is wide: order 2/3";
const HALF_MASS: &str = "at each impact the energy of half an element is lost: order 1";
const PLATEAU: &str = "between the fronts only their tails are left: a thousandth of the force";

/// Error, distance (m) after a period, energy (J), force (N) and impulse (N s).
fn measure(trial: &Trial<1, 2>) -> [f64; 5] {
    let exact = |x: f64, t: f64| (ROD.velocity(x, t), ROD.normal_force(x, t));
    let error = mean_error(trial, exact) / ROD.energy().sqrt();
    let last = trial.times().len() - 1;
    let returned = trial.motion.displacement[trial.nearest(ROD.period())][0][0];
    let passage = ROD.passage();
    let force = trial.mean_force(1.25 * passage, 1.75 * passage);
    [error, returned, trial.energy(last), force, trial.contact.total[last].impulse[0]]
}

/// Case 3.
pub(super) fn clamped(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let (mut runs, mut curve) = (Vec::new(), None);
    for elements in MESHES {
        let start = (0..=elements).map(|i| ROD.displacement(i as f64 / elements as f64, 0.0));
        let text = CaseText::new("clamped_rod", include_str!("../../../../../python/percute/verification/benchmarks/cases/clamped_rod.toml"));
        let trial = bar(&text.bar(ROD.length, elements)?.bar_start(start)?, tally)?;
        runs.push(measure(&trial));
        let time = trial.times().to_vec();
        curve = curve.or_else(|| {
            Some(Curve {
                quantity: "gap of the free end",
                unit: "m",
                exact: time.iter().map(|&t| ROD.displacement(0.0, t)).collect(),
                computed: trial.motion.displacement.iter().map(|u| u[0][0]).collect(),
                time,
                time_unit: "s",
            })
        });
    }
    let row = |which: usize, quantity: &str, unit, exact: f64, expected, reason| PackRow {
        quantity: quantity.to_string(),
        unit,
        exact,
        computed: runs.iter().map(|run| run[which]).collect(),
        expected,
        reason,
    };
    let force = ROD.contact_force(1.5 * ROD.passage());
    let rows = vec![
        row(0, "error over the energy norm, mean over two periods", "", 0.0, Order(1.0 / 3.0), FRONT),
        row(1, "distance of the end after a period of 3 s", "m", ROD.distance, Order(2.0 / 3.0), RETURN),
        row(2, "energy after two periods", "J", ROD.energy(), Order(1.0), HALF_MASS),
        row(3, "contact force, middle half of the first contact", "N", force, Within(1e-3 * force), PLATEAU),
        row(4, "impulse of two contacts", "N s", 2.0 * force * ROD.passage(), Order(2.0 / 3.0), RETURN),
    ];
    Ok(Outcome { rows, curve })
}
