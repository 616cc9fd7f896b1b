//! Case 7: impulses and energies of a block that strikes the ground.

use super::super::{ReproduceError, Tally};
use super::row::Expected::{self, Order, Within};
use super::row::PackRow;
use super::text::CaseText;
use super::trial::{Trial, plane};
use super::{Curve, Outcome};

/// Cells along the width of the block.
const MESHES: [usize; 4] = [10, 20, 40, 80];
pub(super) const RUNS: usize = 2 * MESHES.len();

/// That of the block towards the ground (m/s).
const SPEED: f64 = 10.0;
const FRICTION: f64 = 0.2;
/// Height of the block and its distance from the ground (m).
const HEIGHT: f64 = 0.04;
const GAP: f64 = 2.3e-6;

const RETURN: &str = "the blow ends when the smeared front is back: order 2/3";
const CONE: &str = "each node slides all the time, and its force is on the cone: rounding";
const HALF_MASS: &str =
    "what the ground takes besides is the energy of the layer of mass that is stopped at impact: order 1";
const STEP: &str = "forces and paths of the same steps, and of steps beside each other: order 1";

fn run(cells: usize, velocity: f64, friction: f64, tally: &mut Tally<'_>) -> Result<Trial<2, 3>, ReproduceError> {
    let text = CaseText::new("oblique", include_str!("../../../../../python/percute/verification/benchmarks/cases/oblique.toml"));
    let text = text.rectangle([0.05, HEIGHT], [cells, cells * 4 / 5])?.number("friction", friction)?;
    plane(&text.with("velocity", &format!("[{velocity:e}, {:e}]", -SPEED))?, tally)
}

/// μ Σ R_n |v_{n+½}| Δt_n over all nodes: the work of the sliding forces (J).
fn sliding_work(trial: &Trial<2, 3>) -> f64 {
    let Some(steps) = &trial.contact.steps else { return f64::NAN };
    let nodes = trial.contact.nodes.len();
    let share = |row: usize| {
        let dt = trial.case.times.velocity_step((row / nodes).min(trial.case.times.step_count()));
        FRICTION * steps.force[row][1] * steps.sliding_velocity[row][0].abs() * dt
    };
    (0..steps.force.len()).map(share).sum()
}

/// Case 7.
pub(super) fn momentum(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let [mut normal, mut ratio, mut lost, mut work] = [const { Vec::new() }; 4];
    let (mut shown, mut impulse) = (None, f64::NAN);
    for cells in MESHES {
        let straight = run(cells, 0.0, 0.0, tally)?;
        let last = straight.times().len() - 1;
        impulse = 2.0 * straight.mass() * SPEED;
        normal.push(straight.contact.total[last].impulse[1]);
        let oblique = run(cells, 40.0, FRICTION, tally)?;
        let last = oblique.times().len() - 1;
        let [along, across] = oblique.contact.total[last].impulse;
        ratio.push(along / across);
        let flight = 0.5 * oblique.mass() * SPEED * SPEED;
        let friction = oblique.simulation.balance.friction;
        lost.push((oblique.energy(0) - oblique.energy(last) - friction) / flight);
        work.push(sliding_work(&oblique) / friction);
        shown = shown.or_else(|| Some(curve(&oblique)));
    }
    let row = |quantity: &str, unit, exact, computed, expected: Expected, reason| PackRow {
        quantity: quantity.to_string(),
        unit,
        exact,
        computed,
        expected,
        reason,
    };
    let rows = vec![
        row("normal impulse of a straight blow, 2mv", "N s", impulse, normal, Order(2.0 / 3.0), RETURN),
        row("tangential over normal impulse, −μ", "", -FRICTION, ratio, Within(1e-12), CONE),
        row("energy lost but for friction over that of the normal motion", "", 0.0, lost, Order(1.0), HALF_MASS),
        row("work of the sliding forces μ∫F_n|v_t|dt over the energy dissipated", "", 1.0, work, Order(1.0), STEP),
    ];
    Ok(Outcome { rows, curve: shown })
}

/// Tangential impulse over time; the exact one grows evenly while the wave runs through the block and back.
fn curve(trial: &Trial<2, 3>) -> Curve {
    let time = trial.times();
    let law = &trial.case.problem.materials()[0];
    let (impact, blow) = (GAP / SPEED, 2.0 * HEIGHT / law.wave_speed());
    let whole = -FRICTION * 2.0 * trial.mass() * SPEED;
    Curve {
        quantity: "tangential impulse",
        unit: "N s",
        exact: time.iter().map(|t| whole * ((t - impact) / blow).clamp(0.0, 1.0)).collect(),
        computed: trial.contact.total.iter().map(|total| total.impulse[0]).collect(),
        time: time.iter().map(|t| 1e6 * t).collect(),
        time_unit: "µs",
    }
}
