//! A verification over the size of the elements.

use super::{ROOM, SIZE, legend};
use crate::axes::{Look, Plot};
use crate::scale::Scale;
use crate::svg::{Anchor, Svg};
use percute_workflow::verify::{Level, Verification};

/// Height of a plot, and distance of two (pixels).
const HEIGHT: f64 = 190.0;
const DISTANCE: f64 = 100.0;

/// A quantity of a level, with its name.
type Quantity = (&'static str, fn(&Level) -> Option<f64>);

const ERRORS: [Quantity; 4] = [
    ("estimate, mean", |level| Some(level.estimate.mean)),
    ("true error, mean", |level| level.error.map(|error| error.mean)),
    ("estimate, sup", |level| Some(level.estimate.sup)),
    ("true error, sup", |level| level.error.map(|error| error.sup)),
];
const INDICES: [Quantity; 2] = [
    ("effectivity index of the mean", |level| level.effectivity.map(|index| index.mean)),
    ("of the sup", |level| level.effectivity.map(|index| index.sup)),
];
const CONTACT: [Quantity; 3] = [
    ("peak force", |level| level.peak_force),
    ("impulse", |level| level.impulse),
    ("rebound velocity", |level| level.rebound),
];

/// Estimate and true error, effectivity index, and peak force, impulse and rebound velocity over their values on the finest mesh, all
/// over the size of the elements, as an SVG document. The range of the index that the verdict expects is shaded. None with fewer
/// than two meshes or without an error.
#[must_use]
pub fn convergence(verification: &Verification) -> Option<String> {
    let levels = &verification.levels;
    let errors = lines(levels, &ERRORS, 1.0);
    let y = around(&errors, 1.25).filter(|_| levels.len() > 1)?;
    let mut charts = vec![Chart { lines: errors, label: "error (J^½)", y, band: None, one: false }];
    let (indices, band) = (lines(levels, &INDICES, 1.0), levels[0].expected);
    let shown: Vec<f64> = indices.iter().flat_map(|line| &line.points).map(|point| point.1).chain(band).collect();
    if indices.iter().any(|line| !line.points.is_empty()) {
        let y = padded(&shown);
        charts.push(Chart { lines: indices, label: "effectivity index", y, band: Some(band), one: true });
    }
    let contact = over_the_finest(levels);
    let shown: Vec<f64> = contact.iter().flat_map(|line| &line.points).map(|point| point.1).collect();
    if !shown.is_empty() {
        charts.push(Chart { lines: contact, label: "over the finest", y: padded(&shown), band: None, one: true });
    }
    let count = charts.len() as f64;
    let mut svg = Svg::new([SIZE[0], ROOM[1] + ROOM[3] + count * HEIGHT + (count - 1.0) * DISTANCE]);
    for (k, chart) in charts.iter().enumerate() {
        chart.draw(&mut svg, ROOM[1] + k as f64 * (HEIGHT + DISTANCE), levels.len());
    }
    Some(svg.alone())
}

/// A quantity at the levels that have it: element size over that of the first mesh, and value.
struct Line {
    name: &'static str,
    points: Vec<(f64, f64)>,
}

/// One of the plots, with its scale and a range that is shaded.
struct Chart {
    lines: Vec<Line>,
    label: &'static str,
    y: Scale,
    band: Option<[f64; 2]>,
    /// Whether a line marks the value 1.
    one: bool,
}

impl Chart {
    fn draw(&self, svg: &mut Svg, top: f64, levels: usize) {
        let x = Scale::logarithmic(size(levels - 1) / 1.1, 1.1);
        let plot = Plot { corner: [ROOM[0], top], size: [SIZE[0] - ROOM[0] - ROOM[2], HEIGHT], x, y: self.y };
        if let Some([low, high]) = self.band {
            svg.rectangle("class=\"area\"", plot.at(x.low, low), plot.at(x.high, high));
        }
        let label = "element size over that of the first mesh";
        plot.axes(svg, &Look { x: label, y: self.label, marks: [0, 5], grid: [true; 2] });
        for k in 0..levels {
            let ([at, bottom], name) = (plot.at(size(k), self.y.low), fraction(k));
            svg.line("axis", [at, bottom], [at, bottom + 5.0]);
            svg.text("label", [at, bottom + 18.0], Anchor::Middle, false, &name);
        }
        if self.one {
            svg.line("now", plot.at(x.low, 1.0), plot.at(x.high, 1.0));
        }
        for (k, line) in self.lines.iter().enumerate() {
            let (class, places) = (format!("s{k}"), line.points.iter().map(|&(x, y)| plot.at(x, y)));
            let places: Vec<_> = places.collect();
            places.iter().for_each(|&at| svg.circle(&class, at, 3.5));
            svg.polyline(&class, places);
        }
        let names: Vec<_> = self.lines.iter().map(|line| line.name).collect();
        legend(svg, top - ROOM[1], &names);
    }
}

/// Element size of a level over that of the first mesh.
fn size(level: usize) -> f64 {
    0.5_f64.powi(level as i32)
}

fn fraction(level: usize) -> String {
    if level == 0 { "1".to_string() } else { format!("1/{}", 1 << level) }
}

/// The lines of quantities; values that are not positive have no place on a logarithmic scale.
fn lines(levels: &[Level], quantities: &[Quantity], scale: f64) -> Vec<Line> {
    let points = |of: fn(&Level) -> Option<f64>| {
        let all = levels.iter().enumerate().filter_map(move |(k, level)| Some((size(k), of(level)? / scale)));
        all.filter(|(_, value)| *value > 0.0 && value.is_finite()).collect()
    };
    quantities.iter().map(|&(name, of)| Line { name, points: points(of) }).collect()
}

/// The lines of contact, each over its value on the finest mesh; those without one are left out.
fn over_the_finest(levels: &[Level]) -> Vec<Line> {
    let finest = |of: fn(&Level) -> Option<f64>| levels.last().and_then(of).filter(|value| *value != 0.0);
    let line = |quantity: &Quantity| Some(lines(levels, &[*quantity], finest(quantity.1)?).remove(0));
    CONTACT.iter().filter_map(line).collect()
}

/// A logarithmic scale with room on both sides of the values; none without values.
fn around(lines: &[Line], room: f64) -> Option<Scale> {
    let values = || lines.iter().flat_map(|line| &line.points).map(|point| point.1);
    Some(Scale::logarithmic(values().reduce(f64::min)? / room, values().reduce(f64::max)? * room))
}

/// A linear scale around values and 1.
fn padded(values: &[f64]) -> Scale {
    let (low, high) = values.iter().fold((1.0_f64, 1.0_f64), |(low, high), &v| (low.min(v), high.max(v)));
    let room = 0.1 * (high - low).max(0.05);
    Scale::linear(low - room, high + room)
}
