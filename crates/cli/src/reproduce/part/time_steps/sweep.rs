//! Figures 10 (a) and (b): the error over time, and its largest value over the step.

use super::super::block::Impact;
use super::{block, ratios};
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::tally::weight as weight_of;
use crate::reproduce::{Effort, ReproduceError, Section, Tally};
use percute_estimator::{Acceleration, Estimate, Reconstruction, Request, Sample};
use percute_workflow::message::{percent, short};

/// The fraction of a step at which the impact falls.
const FRACTION: f64 = 0.3;
/// What counts as the moment of impact, on both sides of the arrival, in critical steps.
const MOMENT: f64 = 2.0;
/// The ratios of which figure (a) has a curve.
const DRAWN: [f64; 5] = [1.0, 0.7, 0.5, 0.2, 0.1];

/// A ratio with its problem.
pub(super) type Run = (f64, Impact);

pub(super) fn impacts(effort: &Effort) -> Result<Vec<Run>, ReproduceError> {
    ratios(effort).iter().map(|&ratio| Ok((ratio, block(ratio, FRACTION).impact()?))).collect()
}

/// Computes the runs and adds text, figures and tables.
pub(super) fn add(
    section: &mut Section,
    effort: &Effort,
    runs: &[Run],
    tally: &mut Tally<'_>,
) -> Result<(), ReproduceError> {
    let (mut over_time, mut sup) = tables();
    for &reading in Reconstruction::ALL {
        for (ratio, Impact { problem, times, arrival }) in runs {
            let options = effort.options(reading, Acceleration::default());
            let weight = weight_of(problem, times);
            let (_, estimate) = tally.estimate(weight, problem, times, options, &Request::default())?;
            let first = || [Cell::from(reading.to_string()), Cell::from(*ratio)];
            for sample in &estimate.over_time {
                let values = [1e6 * (sample.time - arrival), sample.parts.total().sqrt()];
                over_time.push(first().into_iter().chain(values.map(Cell::from)));
            }
            let moment = MOMENT * times.step(0) / ratio;
            sup.push(first().into_iter().chain(values(&estimate, *arrival, moment)));
        }
    }
    introduce(section);
    section.figure("figure-10a", over_time_figure(&over_time, runs)?, over_time_caption());
    section.figure("figure-10b", sup_figure(&sup)?, sup_caption());
    conclude(section, &sup, runs);
    section.table(sup);
    section.table(over_time);
    Ok(())
}

fn introduce(section: &mut Section) {
    let block = block(1.0, FRACTION);
    section.text(format!(
        "The block of table 1 without friction on {} squares, 640 elements, with steps from the critical one down to a tenth \
         of it. The gap is that which the block crosses in a whole number of steps and {FRACTION} of one, near 0.2 mm, so \
         that the impact falls on the same place inside a step; the instants are counted from the arrival.",
        block.mesh()
    ));
}

fn tables() -> (Table, Table) {
    let first = || [Column::new("contact force"), Column::new("Δt/Δt_c").digits(1)].into_iter();
    let columns = [Column::new("t − t_impact").unit("µs"), Column::new("√η").unit("J^½").equation("[14]")];
    let caption = "The error over time for each step. Where the contact zone changes, an instant has two values.";
    let over_time = Table::new("time-steps-over-time", caption, first().chain(columns).collect()).long();
    let joule = |name: &str, equation: &str| Column::new(name).unit("J^½").equation(equation);
    let columns = [
        joule("e_sup", "[15]"),
        Column::new("at t − t_impact").unit("µs").digits(3),
        joule("largest at impact", "[14]"),
        joule("largest later", "[14]"),
        Column::new("kinetic part of it").unit("%").digits(3),
        joule("e_mean", "[16]"),
    ];
    let caption = format!(
        "The largest error over time, when it is reached, the largest within {MOMENT} critical steps of the arrival and the \
         largest after that, with the kinetic part of η there, and the mean. Contact force as named, Γ_DA `{}`.",
        Acceleration::default()
    );
    (over_time, Table::new("time-steps-sup", caption, first().chain(columns).collect()))
}

fn values(estimate: &Estimate<2>, arrival: f64, moment: f64) -> [Cell; 6] {
    let largest = |keep: &dyn Fn(&Sample) -> bool| {
        let kept = estimate.over_time.iter().filter(|sample| keep(sample));
        kept.fold(Sample::default(), |a, b| if b.parts.total() > a.parts.total() { *b } else { a }).parts
    };
    let impact = largest(&|sample| sample.time <= arrival + moment);
    let later = largest(&|sample| sample.time > arrival + moment);
    [
        estimate.error.sup.into(),
        (1e6 * (estimate.time_of_sup - arrival)).into(),
        impact.total().sqrt().into(),
        later.total().sqrt().into(),
        (100.0 * later.kinetic / later.total()).into(),
        estimate.error.mean.into(),
    ]
}

fn over_time_caption() -> String {
    format!(
        "The paper's figure 10 (a): √η over time [14] (J^½), counted from the arrival at the plane, for several Δt/Δt_c, with \
         each reading of the contact force and Γ_DA `{}`.",
        Acceleration::default()
    )
}

fn over_time_figure(table: &Table, runs: &[Run]) -> Result<String, ReproduceError> {
    let drawn: Vec<f64> = DRAWN.into_iter().filter(|ratio| runs.iter().any(|(other, _)| other == ratio)).collect();
    let panel = |reading: &Reconstruction| {
        let curve = |(k, &ratio): (usize, &f64)| {
            let rows = [("contact force", reading.to_string().into()), ("Δt/Δt_c", ratio.into())];
            let points = table.numbers("t − t_impact", &rows).into_iter().zip(table.numbers("√η", &rows));
            let place = k as f64 / (DRAWN.len() - 1) as f64;
            Series::new(format!("Δt/Δt_c = {ratio}"), points.map(|(t, e)| [t, e]).collect(), Hue::Ordered(1.0 - place))
        };
        Panel { title: reading.to_string(), series: drawn.iter().enumerate().map(curve).collect() }
    };
    let lines = Lines {
        x: Axis::linear("t − t_impact (µs)"),
        y: Axis::linear("√η (J^½)").from(0.0),
        panels: Reconstruction::ALL.iter().map(panel).collect(),
        columns: Reconstruction::ALL.len().min(3),
        bands: vec![],
    };
    Ok(lines.svg()?)
}

fn sup_caption() -> String {
    format!(
        "The paper's figure 10 (b): the largest error over time [15] (J^½) over Δt/Δt_c (logarithmic). Dashed: the largest \
         value of √η later than {MOMENT} critical steps after the arrival, that is without the moment of impact.",
    )
}

fn sup_figure(table: &Table) -> Result<String, ReproduceError> {
    let curve = |name: String, column: &str, reading: &Reconstruction, hue: Hue| {
        let rows = [("contact force", reading.to_string().into())];
        let points = table.numbers("Δt/Δt_c", &rows).into_iter().zip(table.numbers(column, &rows));
        Series::new(name, points.map(|(x, y)| [x, y]).collect(), hue).marked()
    };
    let both = |(k, reading): (usize, &Reconstruction)| {
        let whole = curve(format!("{reading}, e_sup"), "e_sup", reading, Hue::Own(k));
        let later = curve(format!("{reading}, without the impact"), "largest later", reading, Hue::Own(k));
        [whole, later.dashed()]
    };
    let lines = Lines {
        x: Axis::log("Δt/Δt_c").marks(&[0.1, 0.2, 0.3, 0.5, 0.7, 1.0]),
        y: Axis::linear("error (J^½)").from(0.0),
        panels: vec![Panel {
            title: String::new(),
            series: Reconstruction::ALL.iter().enumerate().flat_map(both).collect(),
        }],
        columns: 1,
        bands: vec![],
    };
    Ok(lines.svg()?)
}

/// Says what the smallest steps change.
fn conclude(section: &mut Section, table: &Table, runs: &[Run]) {
    let [.., (before, _), (least, _)] = runs else { return };
    let one = |reading: &Reconstruction| {
        let at = |column: &str, ratio: f64| {
            let rows = [("contact force", reading.to_string().into()), ("Δt/Δt_c", ratio.into())];
            table.numbers(column, &rows).first().copied().unwrap_or(f64::NAN)
        };
        let change = |column: &str| percent((at(column, *least) / at(column, *before) - 1.0).abs());
        format!(
            "with `{reading}` the largest error later than the impact changes by {} and ends at {} J^½, the one at the \
             impact changes by {} and ends at {} J^½",
            change("largest later"),
            short(at("largest later", *least), 4),
            change("largest at impact"),
            short(at("largest at impact", *least), 4),
        )
    };
    let all: Vec<String> = Reconstruction::ALL.iter().map(one).collect();
    section.text(format!(
        "The paper sees the error fall more and more slowly and names two causes that do not depend on the step: the moment \
         of impact, and the lumped mass. Here, from Δt/Δt_c = {before} to {least}, {}. What comes of the moment of impact and \
         what of the mass is taken apart below.",
        all.join("; ")
    ));
}
