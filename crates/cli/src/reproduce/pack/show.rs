//! The section of the pack: one table of all rows, and a figure of curves.

use super::super::chart::{Axis, Hue, Lines, Panel, Series};
use super::super::table::{Cell, Column, Table};
use super::super::{Effort, Part, ReproduceError, Section, Tally};
use super::{CASES, Curve, Expected, PackCase, PackRow};
use percute_core::observer::Observer;

/// The pack as a part of the evidence.
pub(in super::super) const PART: Part =
    Part { key: "pack", title: "Exact and published cases, and how the simulation comes to them", make };

/// Points of a curve in the figure and in its table.
const POINTS: usize = 400;

/// It takes seconds: the small effort does all of it.
fn make(_: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let total: usize = CASES.iter().map(PackCase::runs).sum();
    let tally = &mut Tally::new(PART.key, total as f64, observer);
    let mut section = Section::new(PART.key, PART.title);
    let (mut cases, mut rows, mut runs, mut curves) = (case_table(), row_table(), run_table(), Vec::new());
    for case in CASES {
        let outcome = case.run(tally)?;
        cases.push([case.key.into(), case.title.into(), case.refined.into(), case.source.into()]);
        for row in &outcome.rows {
            rows.push(cells(case.key, row));
            for (run, &computed) in row.computed.iter().enumerate() {
                let name = row.quantity.as_str().into();
                runs.push([case.key.into(), name, (run + 1).into(), computed.into(), (computed - row.exact).into()]);
            }
        }
        curves.extend(outcome.curve.map(|curve| (case, curve)));
    }
    section.text(INTRODUCTION);
    section.table(cases);
    section.table(rows);
    for (case, curve) in curves {
        let table = curve_table(case.key, &curve);
        section.figure(format!("pack-{}", case.key), figure(&curve, &table)?, caption(case.title, &curve));
        section.table(table);
    }
    section.table(runs);
    Ok(section)
}

const INTRODUCTION: &str = "Each case is a file in `examples/pack`, with a script that makes the same comparison. It runs several times, each \
     time with what its table names halved. The difference is that of the last run; its order is the mean one over all of them, beside the order that theory \
     predicts, or the bound, with the reason. Where velocities jump, central differences smear the front over a width of h^(2/3): \
     errors of order 1/3 in the energy norm and of order 2/3 in all that waits for the front are the scheme's, and no fault of contact.";

fn case_table() -> Table {
    let columns = ["case", "what happens", "halved from run to run", "source"].map(Column::new);
    Table::new("pack-cases", "The cases, and where their solutions are from.", columns.to_vec())
}

fn row_table() -> Table {
    let columns = vec![
        Column::new("case"),
        Column::new("quantity"),
        Column::new("unit"),
        Column::new("exact").digits(6),
        Column::new("computed").digits(6),
        Column::new("difference").digits(2),
        Column::new("order").digits(2),
        Column::new("expected order").digits(2),
        Column::new("bound").digits(2),
        Column::new("reason"),
    ];
    Table::new("pack", "What is exact, what came out of the last run, and how the difference falls.", columns)
}

fn run_table() -> Table {
    let columns = vec![
        Column::new("case"),
        Column::new("quantity"),
        Column::new("run"),
        Column::new("computed").digits(6),
        Column::new("difference").digits(3),
    ];
    Table::new("pack-runs", "The same of all runs.", columns).long()
}

fn cells(case: &str, row: &PackRow) -> Vec<Cell> {
    let (order, bound) = match row.expected {
        Expected::Order(order) => (Some(order), None),
        Expected::Within(bound) => (None, Some(bound)),
    };
    vec![
        case.into(),
        row.quantity.as_str().into(),
        row.unit.into(),
        row.exact.into(),
        row.finest().into(),
        row.difference().into(),
        row.observed().into(),
        order.into(),
        bound.into(),
        row.reason.into(),
    ]
}

/// A curve, thinned out.
fn curve_table(key: &str, curve: &Curve) -> Table {
    let columns = vec![
        Column::new("time").unit(curve.time_unit).digits(6),
        Column::new("exact").unit(curve.unit).digits(6),
        Column::new("computed").unit(curve.unit).digits(6),
    ];
    let mut table =
        Table::new(format!("pack-{key}"), format!("{}: {} over time.", key, curve.quantity), columns).long();
    let every = curve.time.len().div_ceil(POINTS).max(1);
    for n in (0..curve.time.len()).step_by(every) {
        table.push([curve.time[n].into(), curve.exact[n].into(), curve.computed[n].into()]);
    }
    table
}

fn figure(curve: &Curve, table: &Table) -> Result<String, ReproduceError> {
    let time = table.numbers("time", &[]);
    let points = |name: &str| time.iter().zip(table.numbers(name, &[])).map(|(t, y)| [*t, y]).collect::<Vec<_>>();
    let lines = Lines {
        x: Axis::linear(format!("time ({})", curve.time_unit)),
        y: Axis::linear(format!("{} ({})", curve.quantity, curve.unit)),
        panels: vec![Panel {
            title: String::new(),
            series: vec![
                Series::new("computed", points("computed"), Hue::Own(0)),
                Series::new("exact", points("exact"), Hue::Ink).dashed(),
            ],
        }],
        columns: 1,
        bands: Vec::new(),
    };
    Ok(lines.svg()?)
}

fn caption(title: &str, curve: &Curve) -> String {
    format!("{title}: {} over time, exact (dashed) and computed in the first run, the coarsest.", curve.quantity)
}
