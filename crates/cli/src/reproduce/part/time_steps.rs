//! The paper's figure 10: the error and the length of the step.

use super::block::{Block, Gap, Impact};
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, Part, ReproduceError, Section, Tally, weight};
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, ContactForce, Estimate, Request};

pub(super) const PART: Part = Part { key: "time-steps", title: "The paper's figure 10: the error and the step", make };

/// The mesh: 640 elements.
const CELLS: [usize; 2] = [20, 16];
/// Δt/Δt_c, the small effort's first.
const RATIOS: [f64; 10] = [1.0, 0.5, 0.9, 0.8, 0.7, 0.6, 0.4, 0.3, 0.2, 0.1];
const FEW: usize = 2;
/// Distance from the plane (m), to a whole number of steps and a fraction.
const GAP: Gap = Gap::Near { metres: 0.2e-3, fraction: 0.3 };
/// What counts as the moment of impact (s): from the arrival on.
const MOMENT: f64 = 1e-6;

fn make(effort: &Effort, observer: &mut dyn Observer) -> Result<Section, ReproduceError> {
    let ratios = effort.first(FEW, &RATIOS);
    let block = |&courant: &f64| Block { courant, friction: 0.0, gap: GAP, ..Block::new(CELLS) }.impact();
    let impacts = ratios.iter().map(block).collect::<Result<Vec<_>, _>>()?;
    let total: f64 = impacts.iter().map(|i| weight(&i.problem, &i.times)).sum();
    let tally = &mut Tally::new(PART.key, total * ContactForce::ALL.len() as f64, observer);
    let mut section = Section::new(PART.key, PART.title);
    let mut sup = sup_table();
    for &reading in ContactForce::ALL {
        for (&ratio, Impact { problem, times, arrival }) in ratios.iter().zip(&impacts) {
            let options = effort.options(reading, Acceleration::default());
            let run = tally.estimate(weight(problem, times), problem, times, options, &Request::default())?;
            sup.push(sup_row(reading, ratio, *arrival, &run.1));
        }
    }
    section.table(sup);
    Ok(section)
}

fn sup_table() -> Table {
    let columns = vec![
        Column::new("contact force"),
        Column::new("Δt/Δt_c").digits(2),
        Column::new("e_sup").unit("J^½").equation("[15]"),
        Column::new("at").unit("µs"),
        Column::new("impact").unit("J^½"),
        Column::new("e_sup later").unit("J^½").equation("[15]"),
        Column::new("at later").unit("µs"),
        Column::new("kin").unit("%"),
        Column::new("e_mean").unit("J^½").equation("[16]"),
    ];
    Table::new("time-steps-sup", "x", columns)
}

fn sup_row(reading: ContactForce, ratio: f64, arrival: f64, estimate: &Estimate<2>) -> [Cell; 9] {
    let later = |t: f64| t > arrival + MOMENT;
    let largest = |keep: &dyn Fn(f64) -> bool| {
        estimate
            .over_time
            .iter()
            .filter(|s| keep(s.time))
            .max_by(|a, b| a.parts.total().total_cmp(&b.parts.total()))
            .copied()
            .unwrap_or_default()
    };
    let l = largest(&later);
    let i = largest(&|t| !later(t));
    [
        reading.to_string().into(),
        ratio.into(),
        estimate.error.sup.into(),
        (1e6 * (estimate.time_of_sup - arrival)).into(),
        i.parts.total().sqrt().into(),
        l.parts.total().sqrt().into(),
        (1e6 * (l.time - arrival)).into(),
        (100.0 * l.parts.kinetic / l.parts.total()).into(),
        estimate.error.mean.into(),
    ]
}
