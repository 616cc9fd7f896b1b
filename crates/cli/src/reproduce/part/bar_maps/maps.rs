//! Figures 5 and 6: maps over number of elements and step.

use super::grid::{ENDS, FRACTIONS, Grid, MEASURES, Value};
use super::study::Setting;
use crate::reproduce::ReproduceError;
use crate::reproduce::chart::{Colours, HeatMap, HeatMaps};
use crate::reproduce::table::{Cell, Column, Table};
use percute_estimator::Acceleration;
use percute_workflow::message::short;

/// Maps of all choices: a row for each reading, a column for each Γ_DA.
fn maps(grid: &Grid, colours: Colours, map: impl Fn(usize) -> (String, Vec<f64>)) -> Result<String, ReproduceError> {
    let named = grid.choices.iter().enumerate().map(|(c, (reading, option))| {
        let (note, values) = map(c);
        HeatMap { title: format!("{reading}, {option}{note}"), values }
    });
    let maps = HeatMaps {
        x: ("number of elements".to_string(), grid.elements.iter().map(ToString::to_string).collect()),
        y: ("Δt/Δt_c".to_string(), grid.ratios.iter().map(|ratio| short(*ratio, 1)).collect()),
        maps: named.collect(),
        columns: Acceleration::ALL.len(),
        colours,
    };
    Ok(maps.svg()?)
}

/// A value for each cell of the map, row by row.
fn cells(grid: &Grid, values: &[Value]) -> Vec<f64> {
    let cell = |ratio: f64, elements: usize| {
        let found = values.iter().find(|v| v.setting.ratio == ratio && v.setting.elements == elements);
        found.map_or(f64::NAN, |v| v.value)
    };
    grid.ratios.iter().flat_map(|&ratio| grid.elements.iter().map(move |&n| cell(ratio, n))).collect()
}

/// Runs in which the impact falls in the middle of a step, until well after the release.
fn middle(setting: &Setting) -> bool {
    setting.fraction == FRACTIONS[FRACTIONS.len() / 2] && setting.after_impact == ENDS[1]
}

/// Figure 5: ε in per cent, from the lowest to the highest value.
pub(super) fn relative(grid: &Grid) -> Result<String, ReproduceError> {
    let values = |c: usize| -> Vec<Value> {
        grid.relative(c, 0, middle).map(|v| Value { value: 100.0 * v.value, ..v }).collect()
    };
    let all = (0..grid.choices.len()).flat_map(values).map(|v| v.value);
    let [low, high] = all.fold([f64::INFINITY, 0.0], |[low, high], v| [low.min(v), f64::max(high, v)]);
    let colours = Colours::ratio("relative error (%)", low, high);
    maps(grid, colours, |c| (String::new(), cells(grid, &values(c))))
}

/// Figure 6: effectivity of the sup (0) or the mean (1).
pub(super) fn effectivity(grid: &Grid, measure: usize) -> Result<String, ReproduceError> {
    let values = |c: usize| grid.effectivities(c, measure, middle).collect::<Vec<_>>();
    maps(grid, colours(), |c| (String::new(), cells(grid, &values(c))))
}

/// The value of each cell farthest from 1, as a ratio, over all fractions.
pub(super) fn worst(grid: &Grid) -> Result<String, ReproduceError> {
    let values = |c: usize| {
        let mut values: Vec<_> = grid.effectivities(c, 0, |s| s.after_impact == ENDS[1]).collect();
        values.sort_by(|a, b| b.value.ln().abs().total_cmp(&a.value.ln().abs()));
        values
    };
    maps(grid, colours(), |c| (String::new(), cells(grid, &values(c))))
}

/// Figure 6 in numbers: effectivities with the default Γ_DA, a row for each reading, measure and mesh.
pub(super) fn table(grid: &Grid) -> Table {
    let columns = ["contact force", "measure", "elements"].map(Column::new).into_iter();
    let steps = grid.ratios.iter().map(|ratio| Column::new(format!("Δt/Δt_c = {}", short(*ratio, 1))).digits(3));
    let caption = format!("The values of the two maps with Γ_DA `{}`.", Acceleration::default());
    let mut table = Table::new("bar-maps-effectivity", caption, columns.chain(steps).collect());
    for (c, (reading, _)) in grid.choices.iter().enumerate().filter(|(_, choice)| choice.1 == Acceleration::default()) {
        for (m, measure) in MEASURES.into_iter().enumerate() {
            let values: Vec<_> = grid.effectivities(c, m, middle).collect();
            for &elements in grid.elements {
                let row = values.iter().filter(|v| v.setting.elements == elements).map(|v| Cell::from(v.value));
                table.push([reading.to_string().into(), Cell::from(measure), elements.into()].into_iter().chain(row));
            }
        }
    }
    table
}

fn colours() -> Colours {
    Colours::around_one("effectivity", 4.0)
}
