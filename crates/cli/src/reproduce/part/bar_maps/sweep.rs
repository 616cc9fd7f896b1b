//! The effectivity over the instant of impact inside a step.

use super::PAPER;
use super::grid::{ENDS, MEASURES};
use super::study::{Choice, Outcome, Setting};
use crate::reproduce::chart::{Axis, Band, Hue, Lines, Panel, Series};
use crate::reproduce::part::parallel::{in_order, threads};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::{Effort, ReproduceError};
use percute_core::observer::Observer;
use percute_estimator::{Acceleration, Reconstruction};

/// N_s and α.
pub(super) const ELEMENTS: usize = 80;
pub(super) const RATIOS: [f64; 2] = [0.5, 0.9];
/// Fractions of a step, in twentieths: 20 is a whole step.
const TWENTIETHS: [usize; 20] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20];

const FORCE: &str = "contact force";
const RATIO: &str = "Δt/Δt_c";
const FRACTION: &str = "fraction";

/// Runs over the fractions with each reading and the default Γ_DA.
pub(super) fn table(
    stage: &'static str,
    effort: &Effort,
    observer: &mut dyn Observer,
) -> Result<Table, ReproduceError> {
    let setting = |ratio: f64, k: usize| Setting {
        elements: ELEMENTS,
        ratio,
        fraction: k as f64 / TWENTIETHS.len() as f64,
        after_impact: ENDS[1],
    };
    let settings: Vec<_> = RATIOS.iter().flat_map(|&ratio| TWENTIETHS.map(|k| setting(ratio, k))).collect();
    let choices: Vec<Choice> = Reconstruction::ALL.iter().map(|&reading| (reading, Acceleration::default())).collect();
    let outcomes: Vec<Outcome> =
        in_order(stage, threads(effort.threads), &settings, observer, |setting, stop| setting.run(&choices, stop))?;
    let effectivity = MEASURES.map(|measure| Column::new(measure).digits(3));
    let columns = [Column::new(FORCE), Column::new(RATIO), Column::new(FRACTION).unit("steps").digits(2)];
    let caption = format!("Effectivity on {ELEMENTS} elements over the fraction of a step at which the impact falls.");
    let mut table = Table::new("bar-maps-instants", caption, columns.into_iter().chain(effectivity).collect()).long();
    for (c, (reading, _)) in choices.iter().enumerate() {
        for (setting, outcome) in settings.iter().zip(&outcomes) {
            let numbers = [setting.ratio, setting.fraction].into_iter().chain(outcome.effectivity(c));
            table.push([Cell::from(reading.to_string())].into_iter().chain(numbers.map(Cell::from)));
        }
    }
    Ok(table)
}

/// A panel for each measure and step, a curve for each reading.
pub(super) fn figure(table: &Table) -> Result<String, ReproduceError> {
    let series = |measure: &str, ratio: f64| {
        let curve = move |(k, reading): (usize, &Reconstruction)| {
            let rows = [(FORCE, Cell::from(reading.to_string())), (RATIO, ratio.into())];
            let points = table.numbers(FRACTION, &rows).into_iter().zip(table.numbers(measure, &rows));
            Series::new(reading.to_string(), points.map(|(x, y)| [x, y]).collect(), Hue::Own(k)).marked()
        };
        Reconstruction::ALL.iter().enumerate().map(curve).collect()
    };
    let panels = MEASURES.iter().flat_map(|measure| {
        RATIOS.map(|ratio| Panel { title: format!("{measure}, Δt/Δt_c = {ratio}"), series: series(measure, ratio) })
    });
    let lines = Lines {
        x: Axis::linear("fraction of a step at which the impact falls").from(0.0).to(1.0),
        y: Axis::linear("effectivity").from(0.0),
        panels: panels.collect(),
        columns: RATIOS.len(),
        bands: vec![Band { low: PAPER[0], high: PAPER[1] }],
    };
    Ok(lines.svg()?)
}
