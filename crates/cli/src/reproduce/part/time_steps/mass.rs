//! The second plateau: the lumped mass, seen on a bar that vibrates and touches nothing.

use super::ratios;
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::tally::weight as weight_of;
use crate::reproduce::{Effort, ReproduceError, Section, Tally};
use percute_core::load::Support;
use percute_core::material::Elastic;
use percute_core::mesh::BarMesh;
use percute_core::problem::{BarProblem, Initial, Problem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Motion, Recorder};
use percute_estimator::{Acceleration, Estimator, Reconstruction};
use percute_exact::{BarEnds, BarMode};
use percute_workflow::message::{percent, short};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A bar of aluminium of 1 m between walls, moving in its fifth mode.
const MODE: BarMode = BarMode {
    ends: BarEnds::FixedFixed,
    number: 5,
    length: 1.0,
    young: 70e9,
    density: 2700.0,
    section: 1e-4,
    amplitude: 1e-4,
    phase: -FRAC_PI_2,
};
/// Elements in a wave length, and the end of the run in periods.
const MESHES: [usize; 2] = [12, 24];
const PERIODS: f64 = 4.0;
/// Points and weights of Gauss's rule on [0, 1], exact to degree 5.
const RULE: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// A bar on a mesh with a step.
pub(super) struct Bar {
    per_wave: usize,
    ratio: f64,
    problem: BarProblem,
    times: TimeGrid,
}

pub(super) fn bars(effort: &Effort) -> Result<Vec<Bar>, ReproduceError> {
    let pairs = MESHES.iter().flat_map(|&mesh| ratios(effort).iter().map(move |&ratio| (mesh, ratio)));
    pairs.map(|(per_wave, ratio)| bar(per_wave, ratio)).collect()
}

fn bar(per_wave: usize, ratio: f64) -> Result<Bar, ReproduceError> {
    let waves = MODE.wave_number() * MODE.length / TAU;
    let elements = (per_wave as f64 * waves).round() as usize;
    let mesh = BarMesh::uniform_bar(MODE.length, elements)?;
    let velocity = mesh.points().iter().map(|x| [MODE.velocity(x[0], 0.0)]).collect();
    let mut builder = Problem::builder(mesh)
        .material(Elastic::bar(MODE.young, MODE.density, MODE.section)?)
        .initial_velocity(Initial::Nodal(velocity));
    for group in ["start", "end"] {
        builder = builder.support(Support { group: group.to_string(), components: [true], velocity: None });
    }
    // Δt_c = h/c on a uniform bar, eq. [33].
    let critical = MODE.length / elements as f64 * (MODE.density / MODE.young).sqrt();
    let end = PERIODS * TAU / MODE.angular_frequency();
    let step = ratio * critical;
    let count = (end / step).round();
    let times = TimeGrid::uniform(step * count, count as usize)?;
    Ok(Bar { per_wave, ratio, problem: builder.build()?, times })
}

pub(super) fn weight(bars: &[Bar]) -> f64 {
    bars.iter().map(|bar| weight_of(&bar.problem, &bar.times)).sum()
}

/// Computes the bars and adds text, figure and table.
pub(super) fn add(
    section: &mut Section,
    effort: &Effort,
    bars: &[Bar],
    tally: &mut Tally<'_>,
) -> Result<(), ReproduceError> {
    let mut table = table();
    for bar in bars {
        let options = effort.options(Reconstruction::default(), Acceleration::default());
        let estimator = Estimator::new(&bar.problem, &bar.times, options)?;
        let mut sink = (Recorder::new(&bar.problem, &bar.times), estimator);
        tally.simulate(weight_of(&bar.problem, &bar.times), &bar.problem, &bar.times, &mut sink)?;
        let (motion, estimate) = (sink.0.finish(), sink.1.finish()?);
        let exact = true_error(&motion);
        let scale = 100.0 / MODE.energy().sqrt();
        let [step, frequency] = [bar.times.step(0), MODE.angular_frequency()];
        let h = MODE.length / bar.problem.mesh().element_count() as f64;
        // sin(ω_hΔt/2) = (cΔt/h) sin(kh/2): central differences on the lumped mass.
        let discrete = 2.0 / step * (bar.ratio * (0.5 * MODE.wave_number() * h).sin()).asin();
        let values = [scale * exact, scale * estimate.error.sup, 100.0 * (discrete / frequency - 1.0)];
        table.push([Cell::from(bar.per_wave), bar.ratio.into()].into_iter().chain(values.map(Cell::from)));
    }
    section.heading("The second cause: the lumped mass");
    section.text(text(&table, bars));
    section.figure("figure-10-mass", figure(&table)?, caption());
    section.table(table);
    Ok(())
}

/// The largest energy norm of the difference between the nodal fields and the mode, over the t_n (J^½).
fn true_error(motion: &Motion<1>) -> f64 {
    let (stiffness, inertia) = (MODE.young * MODE.section, MODE.density * MODE.section);
    let mut largest: f64 = 0.0;
    for ((&t, u), v) in motion.times.iter().zip(&motion.displacement).zip(&motion.velocity) {
        let h = MODE.length / (u.len() - 1) as f64;
        let mut square = 0.0;
        for e in 0..u.len() - 1 {
            let force = stiffness * (u[e + 1][0] - u[e][0]) / h;
            for (s, weight) in RULE {
                let x = h * (e as f64 + s);
                let df = force - MODE.normal_force(x, t);
                let dv = v[e][0] + s * (v[e + 1][0] - v[e][0]) - MODE.velocity(x, t);
                square += 0.5 * h * weight * (df * df / stiffness + inertia * dv * dv);
            }
        }
        largest = largest.max(square);
    }
    largest.sqrt()
}

fn table() -> Table {
    let columns = vec![
        Column::new("elements per wave"),
        Column::new("Δt/Δt_c").digits(1),
        Column::new("true error").unit("% of the norm"),
        Column::new("e_sup").unit("% of the norm").equation("[15]"),
        Column::new("frequency off by").unit("%").digits(3),
    ];
    let caption = format!(
        "A bar in its fifth mode over {PERIODS} periods: the largest true error (against the exact mode, in the energy norm) \
         and the largest estimate, relative to the square root of the energy of the mode, and the relative error of the \
         frequency by sin(½ω_hΔt) = (cΔt/h) sin(½kh)."
    );
    Table::new("time-steps-mass", caption, columns)
}

fn text(table: &Table, bars: &[Bar]) -> String {
    let least = bars.iter().map(|bar| bar.ratio).fold(f64::NAN, f64::min);
    let one = |per_wave: usize| {
        let at = |column: &str, ratio: f64| {
            let rows = [("elements per wave", per_wave.into()), ("Δt/Δt_c", ratio.into())];
            0.01 * table.numbers(column, &rows).first().copied().unwrap_or(f64::NAN)
        };
        format!(
            "with {per_wave} elements in a wave length the true error is {} at the critical step and {} at {} of it, the \
             estimate {} and {}",
            percent(at("true error", 1.0)),
            percent(at("true error", least)),
            short(least, 1),
            percent(at("e_sup", 1.0)),
            percent(at("e_sup", least)),
        )
    };
    format!(
        "Without any contact the same can be seen on a bar that vibrates in one mode, whose exact motion is known. At the \
         critical step the errors of the lumped mass and of central differences cancel, and the nodes move exactly [33]: \
         what is left is the interpolation between them. A smaller step takes only the error of the time integration away, \
         and the waves on the lumped mass are too slow: {}; {}. This cause goes away with the mesh only. It accumulates \
         over the periods, and a measure of local misfit does not see all that has accumulated.",
        one(MESHES[0]),
        one(MESHES[1])
    )
}

fn caption() -> String {
    "A vibrating bar without contact: largest true error (solid) and largest estimate [15] (dashed) over Δt/Δt_c \
     (logarithmic), in per cent of the square root of the energy, for two meshes."
        .to_string()
}

fn figure(table: &Table) -> Result<String, ReproduceError> {
    let both = |(k, &mesh): (usize, &usize)| {
        let curve = |name: &str, column: &str| {
            let rows = [("elements per wave", mesh.into())];
            let points = table.numbers("Δt/Δt_c", &rows).into_iter().zip(table.numbers(column, &rows));
            let name = format!("{name}, {mesh} elements per wave");
            Series::new(name, points.map(|(x, y)| [x, y]).collect(), Hue::Own(k)).marked()
        };
        [curve("true error", "true error"), curve("estimate", "e_sup").dashed()]
    };
    let lines = Lines {
        x: Axis::log("Δt/Δt_c").marks(&[0.1, 0.2, 0.3, 0.5, 0.7, 1.0]),
        y: Axis::linear("error (% of the norm)").from(0.0),
        panels: vec![Panel { title: String::new(), series: MESHES.iter().enumerate().flat_map(both).collect() }],
        columns: 1,
        bands: vec![],
    };
    Ok(lines.svg()?)
}
