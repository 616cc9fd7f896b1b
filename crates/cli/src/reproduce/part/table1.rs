//! The paper's table 1.

use super::block::{Block, Impact};
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, Part, ReproduceError, Section, Tally, weight};
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, ContactForce, ErrorMeasures, Request};

pub(super) const PART: Part =
    Part { key: "table1", title: "The paper's table 1: an oblique impact on four meshes", make };

/// A row of the paper's table 1.
struct Paper {
    cells: [usize; 2],
    /// Relative and absolute error, sup and mean (%, J^½).
    relative: [f64; 2],
    absolute: [f64; 2],
}

const PAPER: [Paper; 4] = [
    Paper { cells: [5, 4], relative: [31.6, 26.6], absolute: [499.0, 394.0] },
    Paper { cells: [10, 8], relative: [25.5, 21.3], absolute: [396.0, 313.0] },
    Paper { cells: [20, 16], relative: [22.1, 17.8], absolute: [346.0, 260.0] },
    Paper { cells: [40, 32], relative: [20.0, 15.7], absolute: [312.0, 228.0] },
];

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let rows = effort.first(2, &PAPER);
    let impacts = rows.iter().map(|row| Block::new(row.cells).impact()).collect::<Result<Vec<_>, _>>()?;
    let choices = ContactForce::ALL.len() * Acceleration::ALL.len();
    let total: f64 = impacts.iter().map(|i| weight(&i.problem, &i.times)).sum();
    let tally = &mut Tally::new(PART.key, total * choices as f64, observer);
    let mut section = Section::new(PART.key, PART.title);
    let mut absolute = absolute_table();
    for &reading in ContactForce::ALL {
        for &acceleration in Acceleration::ALL {
            for (paper, Impact { problem, times, .. }) in rows.iter().zip(&impacts) {
                let options = effort.options(reading, acceleration);
                let (_, estimate) =
                    tally.estimate(weight(problem, times), problem, times, options, &Request::default())?;
                absolute.push(absolute_row(
                    paper,
                    reading,
                    acceleration,
                    problem.mesh().element_count(),
                    &estimate.error,
                ));
            }
        }
    }
    section.figure("table1", figure(&absolute)?, "");
    section.table(absolute);
    Ok(section)
}

fn absolute_table() -> Table {
    let columns = vec![
        Column::new("contact force"),
        Column::new("Γ_DA"),
        Column::new("mesh"),
        Column::new("elements"),
        Column::new("e_sup").unit("J^½").equation("[15]"),
        Column::new("paper's e_sup").unit("J^½"),
        Column::new("e_mean").unit("J^½").equation("[16]"),
        Column::new("paper's e_mean").unit("J^½"),
    ];
    Table::new("table1-absolute", "Absolute errors.", columns)
}

fn absolute_row(
    paper: &Paper,
    reading: ContactForce,
    acceleration: Acceleration,
    elements: usize,
    error: &ErrorMeasures,
) -> [Cell; 8] {
    [
        reading.to_string().into(),
        acceleration.to_string().into(),
        format!("{}×{}", paper.cells[0], paper.cells[1]).into(),
        elements.into(),
        error.sup.into(),
        paper.absolute[0].into(),
        error.mean.into(),
        paper.absolute[1].into(),
    ]
}

fn figure(table: &Table) -> Result<String, ReproduceError> {
    let panel = |measure: &str| {
        let curve = |k: usize, reading: &ContactForce| {
            let rows =
                [("contact force", reading.to_string().into()), ("Γ_DA", Acceleration::default().to_string().into())];
            let points = table.numbers("elements", &rows).into_iter().zip(table.numbers(measure, &rows));
            Series::new(reading.to_string(), points.map(|(x, y)| [x, y]).collect(), Hue::Own(k)).marked()
        };
        Panel {
            title: measure.to_string(),
            series: ContactForce::ALL.iter().enumerate().map(|(k, r)| curve(k, r)).collect(),
        }
    };
    Ok(Lines {
        x: Axis::log("elements"),
        y: Axis::linear("error (J^½)").from(0.0),
        panels: vec![panel("e_sup"), panel("e_mean")],
        columns: 2,
        bands: vec![],
    }
    .svg()?)
}
