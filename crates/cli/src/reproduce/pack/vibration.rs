//! Case 5: standing waves of a bar and of a block, and a bar under a traction that grows.

use super::super::{ReproduceError, Tally};
use super::field_error::mean_error;
use super::row::PackRow;
use super::text::CaseText;
use super::trial::{Trial, bar, plane};
use super::{Curve, Outcome};
use percute_exact::{BarEnds, BarMode, BarRamp, BlockMode, Wave};

/// Elements of a bar.
const BARS: [usize; 4] = [10, 20, 40, 80];
/// Cells of a block along its width.
const BLOCKS: [usize; 3] = [10, 20, 40];
const WAVES: [Wave; 2] = [Wave::Pressure, Wave::Shear];
/// Elements of the bar that is pulled.
const RAMPS: [usize; 4] = [25, 50, 100, 200];
pub(super) const MODE_RUNS: usize = BARS.len();
pub(super) const BLOCK_RUNS: usize = BLOCKS.len() * WAVES.len();
pub(super) const RAMP_RUNS: usize = RAMPS.len();

const SMOOTH: &str = "the frequencies of the scheme are right to O(h²) with Δt ∝ h";
const LINEAR: &str = "the stress of linear elements is right to O(h)";
const KINK: &str = "u'' jumps at the front: a field with s derivatives has an error of order 2s/3, s = 5/2; on coarse meshes the smooth part's, 2";
const AWAY: &str = "the front is near the clamp then; away from it the field is smooth: order 2";
const KINK_OF_STRESS: &str =
    "stress and velocity have a kink at the front: s = 3/2, order 1, which is that of linear elements, too";

const MODE: BarMode = BarMode {
    ends: BarEnds::FixedFree,
    number: 2,
    length: 0.1,
    young: 70e9,
    density: 2700.0,
    section: 1e-4,
    amplitude: 1e-4,
    phase: 0.0,
};

const RAMP: BarRamp = BarRamp { length: 0.1, young: 70e9, density: 2700.0, section: 1e-4, rate: 1e12 };

/// Velocity of the pulled end over time, exact and computed.
fn curve(trial: &Trial<1, 2>, end: usize) -> Curve {
    let time = trial.times();
    Curve {
        quantity: "velocity of the pulled end",
        unit: "m/s",
        exact: time.iter().map(|&t| RAMP.velocity(RAMP.length, t)).collect(),
        computed: trial.motion.velocity.iter().map(|v| v[end][0]).collect(),
        time: time.iter().map(|t| 1e6 * t).collect(),
        time_unit: "µs",
    }
}

/// Case 5, a mode of a bar.
pub(super) fn bar_mode(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let (mut largest, mut energy) = (Vec::new(), Vec::new());
    for elements in BARS {
        let start = (0..=elements).map(|i| MODE.displacement(MODE.length * i as f64 / elements as f64, 0.0));
        let text = CaseText::new("bar_mode", include_str!("../../../../../python/percute/verification/benchmarks/cases/bar_mode.toml"));
        let trial = bar(&text.bar(MODE.length, elements)?.bar_start(start)?, tally)?;
        let last = trial.times().len() - 1;
        let apart = |(x, u): (&[f64; 1], &[f64; 1])| (u[0] - MODE.displacement(x[0], trial.times()[last])).abs();
        let nodes = trial.case.problem.mesh().points().iter().zip(&trial.motion.displacement[last]);
        largest.push(nodes.map(apart).fold(0.0, f64::max) / MODE.amplitude);
        let exact = |x: f64, t: f64| (MODE.velocity(x, t), MODE.normal_force(x, t));
        energy.push(mean_error(&trial, exact) / MODE.energy().sqrt());
    }
    let rows = vec![
        PackRow::of_order(
            "largest error of a node after 2.25 periods over the amplitude",
            "",
            0.0,
            largest,
            2.0,
            SMOOTH,
        ),
        PackRow::of_order("error over the energy norm, mean over time", "", 0.0, energy, 1.0, LINEAR),
    ];
    Ok(Outcome { rows, curve: None })
}

/// The mode (1, 1) of the block of the case file.
fn block(wave: Wave) -> BlockMode {
    let (young, poisson) = (70e9, 0.3);
    BlockMode {
        wave,
        numbers: [1, 1],
        sides: [0.05, 0.04],
        thickness: 0.01,
        lambda: young * poisson / (1.0 - poisson * poisson),
        shear: young / (2.0 * (1.0 + poisson)),
        density: 2700.0,
        amplitude: 1e-5,
        phase: 0.0,
    }
}

/// Root mean square of the nodal error at the end over the amplitude.
fn block_error(mode: &BlockMode, cells: usize, tally: &mut Tally<'_>) -> Result<f64, ReproduceError> {
    let counts = [cells, cells * 4 / 5];
    let nodes = (0..=counts[1]).flat_map(|j| (0..=counts[0]).map(move |i| [i, j]));
    let start = nodes.map(|at| {
        let point = [0, 1].map(|c| mode.sides[c] * at[c] as f64 / counts[c] as f64);
        let u = mode.displacement(point, 0.0);
        // On the rollers sin(nπ) is rounding only; the supports want exact zeros.
        [0, 1].map(|c| if at[c] == 0 || at[c] == counts[c] { 0.0 } else { u[c] })
    });
    let end = 1.2 * std::f64::consts::TAU / mode.angular_frequency();
    let text = CaseText::new("block_mode", include_str!("../../../../../python/percute/verification/benchmarks/cases/block_mode.toml"));
    let trial = plane(&text.rectangle(mode.sides, counts)?.plane_start(start)?.number("end", end)?, tally)?;
    let problem = &trial.case.problem;
    let last = trial.times().len() - 1;
    let nodes = problem.mesh().points().iter().zip(&trial.motion.displacement[last]).zip(problem.mass());
    let squares: f64 = nodes
        .map(|((point, u), mass)| {
            let exact = mode.displacement(*point, trial.times()[last]);
            mass * ((u[0] - exact[0]).powi(2) + (u[1] - exact[1]).powi(2))
        })
        .sum();
    Ok((squares / trial.mass()).sqrt() / mode.amplitude)
}

/// Case 5, modes of a block.
pub(super) fn block_modes(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let mut rows = Vec::new();
    for wave in WAVES {
        let mut errors = Vec::new();
        for cells in BLOCKS {
            errors.push(block_error(&block(wave), cells, tally)?);
        }
        let name = if wave == Wave::Pressure { "pressure" } else { "shear" };
        let quantity = format!("{name} wave: root mean square error after 1.2 periods over the amplitude");
        rows.push(PackRow::of_order(quantity, "", 0.0, errors, 2.0, SMOOTH));
    }
    Ok(Outcome { rows, curve: None })
}

/// Case 5, a traction that grows.
pub(super) fn ramp(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let (mut mean, mut energy, mut end, mut shown) = (Vec::new(), Vec::new(), Vec::new(), None);
    let mut exact_end = f64::NAN;
    for elements in RAMPS {
        let text = CaseText::new("bar_ramp", include_str!("../../../../../python/percute/verification/benchmarks/cases/bar_ramp.toml"));
        let trial = bar(&text.bar(RAMP.length, elements)?, tally)?;
        let last = trial.times().len() - 1;
        let time = trial.times()[last];
        exact_end = RAMP.displacement(RAMP.length, time);
        let apart = |(x, u): (&[f64; 1], &[f64; 1])| (u[0] - RAMP.displacement(x[0], time)).powi(2);
        let nodes = trial.case.problem.mesh().points().iter().zip(&trial.motion.displacement[last]);
        mean.push((nodes.map(apart).sum::<f64>() / (elements + 1) as f64).sqrt() / exact_end);
        let exact = |x: f64, t: f64| (RAMP.velocity(x, t), RAMP.normal_force(x, t));
        // The energy of a bar in equilibrium with the traction at the end.
        let scale = (RAMP.rate * time).powi(2) * RAMP.section * RAMP.length / (2.0 * RAMP.young);
        energy.push(mean_error(&trial, exact) / scale.sqrt());
        end.push(trial.motion.displacement[last][elements][0]);
        shown = shown.or_else(|| Some(curve(&trial, elements)));
    }
    let rows = vec![
        PackRow::of_order(
            "root mean square error of the displacement at the end over the largest",
            "",
            0.0,
            mean,
            5.0 / 3.0,
            KINK,
        ),
        PackRow::of_order("displacement of the pulled end", "m", exact_end, end, 2.0, AWAY),
        PackRow::of_order("error over the energy norm, mean over time", "", 0.0, energy, 1.0, KINK_OF_STRESS),
    ];
    Ok(Outcome { rows, curve: shown })
}
