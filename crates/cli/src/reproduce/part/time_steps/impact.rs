//! The first plateau: the moment of impact, and where it falls inside a step.

use super::super::block::{Block, Impact};
use super::block;
use crate::reproduce::chart::{Axis, Hue, Lines, Panel, Series};
use crate::reproduce::table::{Cell, Column, Table};
use crate::reproduce::tally::weight as weight_of;
use crate::reproduce::{Effort, ReproduceError, Section, Tally};
use percute_estimator::{Acceleration, Reconstruction, Request};
use percute_workflow::message::short;

/// Fractions of a step at which the impact falls.
const FRACTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Δt/Δt_c, and those of the small effort.
const RATIOS: [f64; 4] = [0.8, 0.4, 0.2, 0.1];
const FEW: [f64; 2] = [0.8, 0.4];
/// The runs end with the first step past this instant (s), shortly after the impact.
const PAST: f64 = 1.2e-6;

/// A fraction and a ratio with their problem.
pub(super) type Run = ([f64; 2], Impact);

pub(super) fn impacts(effort: &Effort) -> Result<Vec<Run>, ReproduceError> {
    let ratios: &[f64] = effort.either(&FEW, &RATIOS);
    let pairs = FRACTIONS.iter().flat_map(|&fraction| ratios.iter().map(move |&ratio| [fraction, ratio]));
    pairs.map(|pair| Ok((pair, Block { past: PAST, ..block(pair[1], pair[0]) }.impact()?))).collect()
}

/// Computes the runs and adds text, figure and table.
pub(super) fn add(
    section: &mut Section,
    effort: &Effort,
    runs: &[Run],
    tally: &mut Tally<'_>,
) -> Result<(), ReproduceError> {
    let mut table = table();
    for &reading in Reconstruction::ALL {
        for (pair, Impact { problem, times, arrival }) in runs {
            let options = effort.options(reading, Acceleration::default());
            let weight = weight_of(problem, times);
            let (_, estimate) = tally.estimate(weight, problem, times, options, &Request::default())?;
            let values = [estimate.error.sup, 1e6 * (estimate.time_of_sup - arrival)];
            table.push(
                [Cell::from(reading.to_string())].into_iter().chain(pair.iter().chain(&values).map(|&x| x.into())),
            );
        }
    }
    section.heading("The first cause: the moment of impact");
    section.text(text(&table, runs));
    section.figure("figure-10-impact", figure(&table)?, caption());
    section.table(table);
    Ok(())
}

fn table() -> Table {
    let columns = vec![
        Column::new("contact force"),
        Column::new("fraction").unit("steps").digits(1),
        Column::new("Δt/Δt_c").digits(1),
        Column::new("largest error").unit("J^½").equation("[15]"),
        Column::new("at t − t_impact").unit("µs").digits(3),
    ];
    let caption = format!(
        "The largest error of runs that end at {} µs, shortly after the impact, for several fractions of a step at which \
         the impact falls.",
        short(1e6 * PAST, 2)
    );
    Table::new("time-steps-impact", caption, columns)
}

fn text(table: &Table, runs: &[Run]) -> String {
    let ratio = |pick: fn(f64, f64) -> f64| runs.iter().map(|([_, ratio], _)| *ratio).fold(f64::NAN, pick);
    let (large, small) = (ratio(f64::max), ratio(f64::min));
    let one = |reading: &Reconstruction| {
        let range = |ratio: f64| {
            let rows = [("contact force", reading.to_string().into()), ("Δt/Δt_c", ratio.into())];
            let values = table.numbers("largest error", &rows);
            let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().fold(f64::NAN, pick));
            format!("{} to {} J^½", short(low, 3), short(high, 3))
        };
        format!("with `{reading}` {} at Δt/Δt_c = {large} and {} at {small}", range(large), range(small))
    };
    let all: Vec<String> = Reconstruction::ALL.iter().map(one).collect();
    format!(
        "In the step before contact, the nodes must be braked so that they end on the plane: a force that acts before there \
         is contact, and is not admissible. The velocity that it takes away does not shrink with the step, and how much of \
         it falls before the contact depends on where inside a step the impact falls. Over the fractions {} to {} the \
         largest error around the impact is {}.",
        FRACTIONS[0],
        FRACTIONS[FRACTIONS.len() - 1],
        all.join("; ")
    )
}

fn caption() -> String {
    "The largest error around the impact [15] (J^½) over Δt/Δt_c (both logarithmic), for each reading of the contact force, one \
     curve for each fraction of a step at which the impact falls."
        .to_string()
}

fn figure(table: &Table) -> Result<String, ReproduceError> {
    let panel = |reading: &Reconstruction| {
        let curve = |(k, fraction): (usize, &f64)| {
            let rows = [("contact force", reading.to_string().into()), ("fraction", (*fraction).into())];
            let points = table.numbers("Δt/Δt_c", &rows).into_iter().zip(table.numbers("largest error", &rows));
            let place = k as f64 / (FRACTIONS.len() - 1) as f64;
            let name = format!("at {fraction} of a step");
            Series::new(name, points.map(|(x, y)| [x, y]).collect(), Hue::Ordered(place)).marked()
        };
        Panel { title: reading.to_string(), series: FRACTIONS.iter().enumerate().map(curve).collect() }
    };
    let lines = Lines {
        x: Axis::log("Δt/Δt_c").marks(&RATIOS),
        y: Axis::log("largest error (J^½)"),
        panels: Reconstruction::ALL.iter().map(panel).collect(),
        columns: Reconstruction::ALL.len().min(3),
        bands: vec![],
    };
    Ok(lines.svg()?)
}
