//! The figure: effectivity over refinement.

use super::body::Body;
use super::cases::Kind;
use super::study::{Case, ESTIMATED};
use super::tables::{MEASURES, Result, on_mesh};
use crate::reproduce::ReproduceError;
use crate::reproduce::chart::{Axis, Band, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Table};
use percute_estimator::Reconstruction;

/// Where a good estimate lies.
pub(super) const GOOD: [f64; 2] = [0.9, 1.5];
/// Marks of the effectivity.
const MARKS: [f64; 10] = [0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0];

/// The family of a case: its colour and its name in the legend.
fn family(case: &Case) -> (usize, String) {
    match (case.body, case.kind()) {
        (Body::Disc, _) => (6, "disc".to_string()),
        (Body::Rounded, _) => (5, "rounded corner".to_string()),
        (_, Kind::Tilted) => (3, "tilted by ±3°".to_string()),
        (_, Kind::Corner) => (4, "tilted by ±10°".to_string()),
        // Of the friction, whatever else varies.
        _ => ((case.friction * 10.0).round() as usize / 2, format!("flat, μ = {}", case.friction)),
    }
}

/// A row of panels for each measure, a panel for each reading, a curve for each case.
pub(super) fn draw(table: &Table, results: &[Result]) -> std::result::Result<String, ReproduceError> {
    let curve = |case: &Case, reading: &Reconstruction, measure: &str| {
        let rows = [("case", Cell::from(case.name())), ("contact force", reading.to_string().into())];
        let value = |mesh| table.numbers(&on_mesh(measure, mesh), &rows).first().copied().unwrap_or(f64::NAN);
        let points = ESTIMATED.iter().enumerate().map(|(mesh, &level)| [f64::from(1 << level), value(mesh)]);
        let (hue, name) = family(case);
        Series::new(name, points.collect(), Hue::Own(hue)).marked()
    };
    let panel = |measure: &str, reading: &Reconstruction| Panel {
        title: format!("{reading}, {measure}"),
        series: results.iter().map(|(case, _)| curve(case, reading, measure)).collect(),
    };
    let panels =
        MEASURES.iter().flat_map(|measure| Reconstruction::ALL.iter().map(move |reading| panel(measure, reading)));
    let lines = Lines {
        x: Axis::log("times finer than mesh 1").marks(&[1.0, 2.0, 4.0, 8.0]),
        y: Axis::log("e/e_ref").marks(&MARKS),
        panels: panels.collect(),
        columns: Reconstruction::ALL.len().min(3),
        bands: vec![Band { low: GOOD[0], high: GOOD[1] }],
    };
    Ok(lines.svg()?)
}
