//! How table 1 moves with what the paper leaves out.

use super::paper::{Row, deviation};
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::part::block::{Block, Gap, mesh_name};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, ReproduceError, Section, Tally, weight};
use percute_estimator::{Acceleration, Reconstruction, Request};
use percute_workflow::message::{percent, short};

/// Gaps in steps: fractions 0.1 to 0.9 of a step beyond a whole one. Below, a node may touch at the first step already.
const GAPS: [f64; 5] = [1.1, 1.3, 1.5, 1.7, 1.9];
/// Ends (s).
const ENDS: [f64; 5] = [8e-6, 10e-6, 12e-6, 14e-6, 16e-6];

/// One assumption with another value.
pub(super) struct Variant {
    assumption: &'static str,
    value: String,
    block: Block,
}

/// All of them, one assumption at a time.
pub(super) fn variants() -> Vec<Variant> {
    let base = Block::new([1, 1]);
    let gap = |steps: f64| Variant {
        assumption: "gap",
        value: format!("{steps} steps"),
        block: Block { gap: Gap::Steps(steps), ..base },
    };
    let end = |past: f64| Variant {
        assumption: "T",
        value: format!("{} µs", short(1e6 * past, 2)),
        block: Block { past, ..base },
    };
    let plane = |strain: bool| Variant {
        assumption: "plane",
        value: if strain { "strain" } else { "stress" }.to_string(),
        block: Block { strain, ..base },
    };
    GAPS.map(gap).into_iter().chain(ENDS.map(end)).chain([false, true].map(plane)).collect()
}

/// Computes them and adds what they say.
pub(super) fn add(
    section: &mut Section,
    effort: &Effort,
    rows: &[Row],
    variants: &[Variant],
    tally: &mut Tally<'_>,
) -> Result<(), ReproduceError> {
    let mut table = table();
    for &reading in Reconstruction::ALL {
        for variant in variants {
            let mut errors = Vec::new();
            for row in rows {
                let impact = Block { cells: row.cells, ..variant.block }.impact()?;
                let options = effort.options(reading, Acceleration::default());
                let weight = weight(&impact.problem, &impact.times);
                let run = tally.estimate(weight, &impact.problem, &impact.times, options, &Request::default())?;
                errors.push([run.1.error.sup, run.1.error.mean]);
            }
            let on = |k: usize| super::ROWS.iter().enumerate().map(move |(i, _)| (i, k));
            let values = on(0).chain(on(1)).map(|(i, k)| Cell::from(errors.get(i).map(|e| e[k])));
            let first = [reading.to_string().into(), variant.assumption.into(), variant.value.as_str().into()];
            let off = Cell::from(deviation(&errors).map(|off| 100.0 * off));
            table.push(first.into_iter().chain(values).chain([off]));
        }
    }
    section.heading("How it moves with what the paper leaves out");
    section.text(text(&table));
    section.figure("table1-gap", figure(&table, rows)?, caption());
    section.table(table);
    Ok(())
}

fn table() -> Table {
    let errors = |measure: &'static str, equation: &'static str| {
        let column = move |row: &Row| format!("{measure} {}", mesh_name(row.cells));
        super::ROWS.iter().map(move |row| Column::new(column(row)).unit("J^½").equation(equation))
    };
    let columns = ["contact force", "assumption", "value"].into_iter().map(Column::new);
    let off = Column::new("from the paper").unit("%").digits(3);
    let columns = columns.chain(errors("e_sup", "[15]")).chain(errors("e_mean", "[16]")).chain([off]);
    let caption = format!(
        "Absolute errors with Γ_DA `{}`, one assumption changed at a time; the last column is the root mean square of the \
         eight relative differences from the paper's table.",
        Acceleration::default()
    );
    Table::new("table1-assumptions", caption, columns.collect())
}

/// Says by how much each assumption moves the errors.
fn text(table: &Table) -> String {
    let spread = |reading: &Reconstruction, assumption: &str| {
        let rows = [("contact force", Cell::from(reading.to_string())), ("assumption", Cell::from(assumption))];
        let numbers = table.columns.iter().filter(|c| c.unit == "J^½").map(|c| table.numbers(&c.name, &rows));
        let ratio = |values: Vec<f64>| {
            let of = |pick: fn(f64, f64) -> f64| values.iter().copied().fold(f64::NAN, pick);
            of(f64::max) / of(f64::min) - 1.0
        };
        numbers.map(ratio).fold(f64::NAN, f64::max)
    };
    let one = |reading: &Reconstruction| {
        let by = ["gap", "T", "plane"].map(|assumption| percent(spread(reading, assumption)));
        format!("with `{reading}` by up to {} (gap), {} (T) and {} (plane hypothesis)", by[0], by[1], by[2])
    };
    let all: Vec<String> = Reconstruction::ALL.iter().map(one).collect();
    format!(
        "Where the impact falls inside a step, when the interval ends, and the plane hypothesis each move the errors: from \
         its least to its largest value, an error on one mesh moves {}.",
        all.join("; ")
    )
}

fn caption() -> String {
    format!(
        "The largest error [15] over the gap in steps of flight, for each reading of the contact force with Γ_DA `{}`, one \
         curve for each mesh: the instant of impact inside a step is felt on all meshes.",
        Acceleration::default()
    )
}

fn figure(table: &Table, rows: &[Row]) -> Result<String, ReproduceError> {
    let panel = |reading: &Reconstruction| {
        let picked = [("contact force", reading.to_string().into()), ("assumption", "gap".into())];
        let curve = |(k, row): (usize, &Row)| {
            let name = mesh_name(row.cells);
            let values = table.numbers(&format!("e_sup {name}"), &picked);
            let points = GAPS.into_iter().zip(values).map(|(gap, value)| [gap, value]).collect();
            let place = k as f64 / (super::ROWS.len() - 1) as f64;
            Series::new(name, points, Hue::Ordered(place)).marked()
        };
        Panel { title: reading.to_string(), series: rows.iter().enumerate().map(curve).collect() }
    };
    let lines = Lines {
        x: Axis::linear("gap (steps)").marks(&GAPS),
        y: Axis::linear("e_sup (J^½)").from(0.0),
        panels: Reconstruction::ALL.iter().map(panel).collect(),
        columns: Reconstruction::ALL.len().min(3),
        bands: vec![],
    };
    Ok(lines.svg()?)
}
