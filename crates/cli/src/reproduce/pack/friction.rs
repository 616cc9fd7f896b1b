//! Case 6: a block that is almost rigid, on a tilted plane and under a push to and fro.

use super::super::{ReproduceError, Tally};
use super::row::PackRow;
use super::text::CaseText;
use super::trial::{Trial, plane};
use super::{Curve, Outcome};
use percute_exact::RigidSlide;
use percute_workflow::case::CaseOf;

/// Young's moduli (Pa): the wave speed doubles from one to the next.
const STIFFNESS: [f64; 4] = [3.2e6, 1.28e7, 5.12e7, 2.048e8];
pub(super) const TILT_RUNS: usize = 2 * STIFFNESS.len();
pub(super) const STICK_SLIP_RUNS: usize = STIFFNESS.len();

const TILTED_PLANE: &str = include_str!("../../../../../python/percute/verification/benchmarks/cases/tilted_plane.toml");

const DENSITY: f64 = 1000.0;
const GRAVITY: f64 = 9.81;
/// MomentCorrection of the plane (rad).
const TILT: f64 = std::f64::consts::FRAC_PI_6;
/// Coefficients with which it slides and sticks: tan 30° is 0.577.
const SLIDES: f64 = 0.3;
const STICKS: f64 = 0.7;
/// Times (s) and peaks (Pa/m) of the push.
const PUSH: [(f64, f64); 6] = [(0.0, 0.0), (0.1, 5886.0), (0.3, -5886.0), (0.5, 5886.0), (0.7, -5886.0), (0.9, 5886.0)];

const LATE: &str = "sliding begins when the shear wave of the push has loaded the ground: late by O(H/c); order in 1/c";
const LATE_TWICE: &str = "a start late by τ changes the second difference of the distances by ½aτ²: order 2 in 1/c";
const OVERSHOOT: &str =
    "the weight pulls suddenly, its shear overshoots for 2H/c: a slip of up to ½g(2H/c)², order 2 in 1/c";

/// A block of some sides and cells that its weight presses, so that it does not begin with a bounce.
fn pressed(
    text: CaseText,
    sides: [f64; 2],
    cells: [usize; 2],
    young: f64,
    weight: f64,
) -> Result<CaseText, ReproduceError> {
    let height = sides[1];
    let rows = (0..=cells[1]).map(move |j| height * j as f64 / cells[1] as f64);
    let down = move |y: f64| -weight / young * y * (height - 0.5 * y);
    let start = rows.flat_map(move |y| (0..=cells[0]).map(move |_| [0.0, down(y)]));
    text.plane_start(start)?.number("young", young)
}

/// How far the centre of mass has come along the plane, exact and computed.
fn curve(trial: &Trial<2, 3>, exact: &RigidSlide) -> Curve {
    let time = trial.times().to_vec();
    Curve {
        quantity: "distance",
        unit: "m",
        exact: time.iter().map(|&t| exact.position(t)).collect(),
        computed: (0..time.len()).map(|n| trial.mean_displacement(n)[0]).collect(),
        time,
        time_unit: "s",
    }
}

fn rigid(mass: f64, limit: f64, push: &[(f64, f64)]) -> Result<RigidSlide, ReproduceError> {
    RigidSlide::new(mass, limit, push).ok_or_else(|| ReproduceError::Unexpected("no rigid block".to_string()))
}

fn tilted(young: f64, friction: f64, tally: &mut Tally<'_>) -> Result<Trial<2, 3>, ReproduceError> {
    let text = CaseText::new("tilted_plane", TILTED_PLANE);
    let text = pressed(text, [0.4, 0.2], [4, 2], young, DENSITY * GRAVITY * TILT.cos())?;
    plane(&text.number("friction", friction)?, tally)
}

/// The block on the tilted plane as its file has it.
pub(in crate::reproduce) fn sliding_block() -> Result<CaseOf<2, 3>, ReproduceError> {
    CaseText::new("tilted_plane", TILTED_PLANE).read_plane()
}

/// Case 6, the tilted plane.
pub(super) fn tilted_plane(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let [mut distance, mut acceleration, mut energy, mut slip] = [const { Vec::new() }; 4];
    let mut shown = None;
    for young in STIFFNESS {
        let trial = tilted(young, SLIDES, tally)?;
        let last = trial.times().len() - 1;
        distance.push(trial.mean_displacement(last)[0]);
        let end = trial.times()[last];
        // What is left of the late start drops out of the second difference.
        let halfway = trial.mean_displacement_at(0.5 * end)[0];
        acceleration.push(4.0 * (trial.mean_displacement(last)[0] - 2.0 * halfway) / (end * end));
        energy.push(trial.simulation.balance.friction);
        shown = Some((slide(trial.mass())?, end));
        let still = tilted(young, STICKS, tally)?;
        slip.push(ground_slip(&still));
    }
    let (exact, end) = shown.ok_or_else(|| ReproduceError::Unexpected("no run".to_string()))?;
    let rows = vec![
        PackRow::of_order("distance, ½(g sin θ − μg cos θ)t²", "m", exact.position(end), distance, 1.0, LATE),
        PackRow::of_order(
            "acceleration, g sin θ − μg cos θ",
            "m/s²",
            exact.velocity(end) / end,
            acceleration,
            2.0,
            LATE_TWICE,
        ),
        PackRow::of_order("energy dissipated by friction", "J", exact.dissipated(end), energy, 1.0, LATE),
        PackRow::of_order("slip with μ = 0.7 > tan θ", "m", 0.0, slip, 2.0, OVERSHOOT),
    ];
    Ok(Outcome { rows, curve: None })
}

/// The rigid block on the tilted plane.
fn slide(mass: f64) -> Result<RigidSlide, ReproduceError> {
    let weight = mass * GRAVITY;
    rigid(mass, SLIDES * weight * TILT.cos(), &[(0.0, weight * TILT.sin())])
}

/// Mean slip of the nodes on the ground at the end (m).
fn ground_slip(trial: &Trial<2, 3>) -> f64 {
    let last = &trial.motion.displacement[trial.times().len() - 1];
    let nodes = &trial.contact.nodes;
    nodes.iter().map(|place| last[place.node.index()][0]).sum::<f64>() / nodes.len() as f64
}

/// Case 6, stick and slip.
pub(super) fn stick_slip(tally: &mut Tally<'_>) -> Result<Outcome, ReproduceError> {
    let [mut apart, mut energy] = [const { Vec::new() }; 2];
    let (mut dissipated, mut shown) = (f64::NAN, None);
    for young in STIFFNESS {
        let text = CaseText::new("stick_slip", include_str!("../../../../../python/percute/verification/benchmarks/cases/stick_slip.toml"));
        let trial = plane(&pressed(text, [0.4, 0.05], [1, 1], young, DENSITY * GRAVITY)?, tally)?;
        let mass = trial.mass();
        let push = PUSH.map(|(t, f)| (t, f * mass / DENSITY));
        let exact = rigid(mass, SLIDES * mass * GRAVITY, &push)?;
        let path = curve(&trial, &exact);
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let differences: Vec<f64> = path.exact.iter().zip(&path.computed).map(|(a, b)| b - a).collect();
        apart.push(largest(&differences) / largest(&path.exact));
        energy.push(trial.simulation.balance.friction);
        let end = trial.times()[trial.times().len() - 1];
        dissipated = exact.dissipated(end);
        shown = shown.or(Some(path));
    }
    let rows = vec![
        PackRow::of_order("largest error of the position over the largest distance", "", 0.0, apart, 1.0, LATE),
        PackRow::of_order("energy dissipated by friction", "J", dissipated, energy, 1.0, LATE),
    ];
    Ok(Outcome { rows, curve: shown })
}
