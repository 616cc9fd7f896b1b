//! The paper's table 1, with the assumptions that the paper leaves out.

mod assumptions;
mod paper;

use super::block::{Block, Impact, mesh_name};
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, Part, ReproduceError, Section, Tally, weight};
use paper::{ROWS, Row, deviation};
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, ErrorMeasures, Reconstruction, Request};
use percute_workflow::message::{percent, short};

pub(super) const PART: Part =
    Part { key: "table1", title: "The paper's table 1: an oblique impact on four meshes", make };

/// Meshes of the small effort.
const FEW: usize = 2;

/// The measures of all meshes for one choice of options.
struct Choice {
    reading: Reconstruction,
    acceleration: Acceleration,
    errors: Vec<ErrorMeasures>,
}

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let rows = effort.first(FEW, &ROWS);
    let impacts = rows.iter().map(|row| Block::new(row.cells).impact()).collect::<Result<Vec<_>, _>>()?;
    let variants = assumptions::variants();
    let own: f64 = impacts.iter().map(|i| weight(&i.problem, &i.times)).sum();
    let runs = Reconstruction::ALL.len() * (Acceleration::ALL.len() + variants.len());
    let tally = &mut Tally::new(PART.key, own * runs as f64, observer);
    let choices = choices(effort, &impacts, tally)?;
    let mut section = Section::new(PART.key, PART.title);
    introduce(&mut section);
    let (absolute, relative) = tables(rows, &impacts, &choices);
    section.figure("table1-errors", figure(&absolute)?, caption());
    conclude(&mut section, &choices, rows);
    section.table(absolute);
    section.table(relative);
    assumptions::add(&mut section, effort, rows, &variants, tally)?;
    Ok(section)
}

fn choices(effort: &Effort, impacts: &[Impact], tally: &mut Tally<'_>) -> Result<Vec<Choice>, ReproduceError> {
    let mut choices = Vec::new();
    for &reading in Reconstruction::ALL {
        for &acceleration in Acceleration::ALL {
            let mut errors = Vec::new();
            for Impact { problem, times, .. } in impacts {
                let (options, weight) = (effort.options(reading, acceleration), weight(problem, times));
                errors.push(tally.estimate(weight, problem, times, options, &Request::default())?.1.error);
            }
            choices.push(Choice { reading, acceleration, errors });
        }
    }
    Ok(choices)
}

fn introduce(section: &mut Section) {
    let base = Block::new(ROWS[0].cells);
    section.text(format!(
        "An aluminium block of 50 × 40 mm strikes a plane at 400 m/s along it and 400 m/s towards it, with friction \
         (μ = {}); the step is {} of the critical one. The table has the largest error over time, e_sup [15], and the \
         mean, e_mean [16], for every reading of the contact force and every Γ_DA that percute offers, beside the \
         paper's values. The paper's method is `published`; the default is `{}` with `{}`.",
        base.friction,
        base.courant,
        Reconstruction::default(),
        Acceleration::default(),
    ));
    section.text(format!(
        "The paper leaves out the distance from which the block starts, the end T of the interval, and whether the \
         block is in plane stress or plane strain. Taken here: plane stress, a gap that the block crosses in 1.3 steps, \
         and the first whole step past {} µs. How the values move with each of these is below.",
        short(1e6 * base.past, 3),
    ));
}

fn conclude(section: &mut Section, choices: &[Choice], rows: &[Row]) {
    let off = |choice: &&Choice| {
        let errors: Vec<_> = choice.errors.iter().map(|e| [e.sup, e.mean]).collect();
        deviation(&errors).map(|off| (choice.acceleration, off))
    };
    let paper: Vec<_> =
        choices.iter().filter(|c| c.reading == Reconstruction::Published).filter_map(|c| off(&c)).collect();
    if let Some((nearest, least)) = paper.iter().min_by(|a, b| a.1.total_cmp(&b.1)) {
        let others = paper.iter().filter(|(a, _)| a != nearest);
        let others: Vec<_> = others.map(|(a, off)| format!("{} with `{a}`", percent(*off))).collect();
        section.text(format!(
            "With the reading `published`, the eight absolute values differ from the paper's by {} (root mean square) with \
             `{nearest}`, by {}.",
            percent(*least),
            others.join(" and by "),
        ));
    }
    let ours = choices.iter().flat_map(|c| &c.errors).map(|e| e.reference_sup);
    let (low, high) = ours.fold((f64::INFINITY, 0.0_f64), |(low, high), d| (low.min(d), high.max(d)));
    let implied: Vec<String> = rows.iter().map(|row| short(row.denominators()[0], 4)).collect();
    section.text(format!(
        "The relative errors differ by their denominator. D_sup by [22]–[24] as printed is {} to {} J^½ here; absolute \
         over relative error of the paper's own table gives {} J^½. That is a norm which [22]–[24] do not give; the \
         absolute errors do not depend on it.",
        short(low, 4),
        short(high, 4),
        implied.join(", "),
    ));
}

fn tables(rows: &[Row], impacts: &[Impact], choices: &[Choice]) -> (Table, Table) {
    let first = || ["contact force", "Γ_DA", "mesh", "elements"].into_iter().map(Column::new);
    let joule = |name: &str, equation: &str| Column::new(name).unit("J^½").equation(equation);
    let columns =
        [joule("e_sup", "[15]"), joule("paper's e_sup", ""), joule("e_mean", "[16]"), joule("paper's e_mean", "")];
    let caption = "Absolute errors of the four meshes, beside the paper's.";
    let mut absolute = Table::new("table1-absolute", caption, first().chain(columns).collect());
    let percents = |name: &str, equation: &str| Column::new(name).unit("%").equation(equation).digits(3);
    let columns = [
        percents("ε_sup", "[22]"),
        percents("paper's ε_sup", ""),
        percents("ε_mean", "[22]"),
        percents("paper's ε_mean", ""),
        joule("D_sup", "[23]"),
        joule("paper's D_sup", ""),
        joule("D_mean", ""),
        joule("paper's D_mean", ""),
    ];
    let caption =
        "Relative errors, and what they are relative to. The paper's D is its absolute over its relative error.";
    let mut relative = Table::new("table1-relative", caption, first().chain(columns).collect());
    for choice in choices {
        for ((row, impact), error) in rows.iter().zip(impacts).zip(&choice.errors) {
            let elements = impact.problem.mesh().element_count();
            let first: [Cell; 4] = [
                choice.reading.to_string().into(),
                choice.acceleration.to_string().into(),
                mesh_name(row.cells).into(),
                elements.into(),
            ];
            let values = [error.sup, row.absolute[0], error.mean, row.absolute[1]];
            absolute.push(first.clone().into_iter().chain(values.map(Cell::from)));
            let [sup, mean] = row.denominators();
            let values = [100.0 * error.relative_sup, row.relative[0], 100.0 * error.relative_mean, row.relative[1]];
            let norms = [error.reference_sup, sup, error.reference_mean, mean];
            relative.push(first.into_iter().chain(values.into_iter().chain(norms).map(Cell::from)));
        }
    }
    (absolute, relative)
}

fn caption() -> String {
    format!(
        "Absolute error over the number of elements (logarithmic): largest over time [15] on the left, mean [16] on \
         the right, each reading of the contact force with Γ_DA `{}`, and the paper's values in black.",
        Acceleration::default()
    )
}

fn figure(table: &Table) -> Result<String, ReproduceError> {
    let curve = |name: String, column: &str, reading: Reconstruction, hue: Hue| {
        let rows =
            [("contact force", reading.to_string().into()), ("Γ_DA", Acceleration::default().to_string().into())];
        let points = table.numbers("elements", &rows).into_iter().zip(table.numbers(column, &rows));
        Series::new(name, points.map(|(x, y)| [x, y]).collect(), hue).marked()
    };
    let panel = |measure: &str| {
        let readings = Reconstruction::ALL.iter().enumerate();
        let ours = readings.map(|(k, &reading)| curve(reading.to_string(), measure, reading, Hue::Own(k)));
        let paper =
            curve("the paper's table".into(), &format!("paper's {measure}"), Reconstruction::default(), Hue::Ink);
        Panel { title: measure.to_string(), series: ours.chain([paper.dashed()]).collect() }
    };
    let elements = table.numbers("elements", &[]);
    let lines = Lines {
        x: Axis::log("elements").marks(&elements),
        y: Axis::linear("error (J^½)").from(0.0),
        panels: vec![panel("e_sup"), panel("e_mean")],
        columns: 2,
        bands: vec![],
    };
    Ok(lines.svg()?)
}
