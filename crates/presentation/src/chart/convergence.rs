//! A verification over the size of the elements. `python/percute/pictures/convergence.py` draws the same.

use super::{LETTER, ROOM, ROW, SAMPLE, SIZE};
use crate::axes::{Look, Plot};
use crate::scale::Scale;
use crate::svg::{Anchor, Svg};
use percute_workflow::verify::{Level, ProbeValue, Verification};

/// Height of a plot, room below it for the sizes of the elements (pixels).
const HEIGHT: f64 = 190.0;
const BELOW: f64 = 34.0;
/// Room beside the first and the last mesh and around errors, as a factor; around other values, as a part of their
/// range.
const BESIDE: f64 = 1.1;
const AROUND: f64 = 1.25;
const PADDING: f64 = 0.1;

/// A quantity of a level with its look and its name.
struct Quantity {
    class: &'static str,
    name: &'static str,
    of: fn(&Level) -> Option<f64>,
}

const ERRORS: [Quantity; 4] = [
    Quantity { class: "s0 solid", name: "estimate, mean", of: |level| Some(level.estimate.mean) },
    Quantity { class: "s1 solid", name: "estimate, sup", of: |level| Some(level.estimate.sup) },
    Quantity {
        class: "s0 dashed",
        name: "true error against the finest mesh, mean",
        of: |level| level.error.map(|error| error.mean),
    },
    Quantity {
        class: "s1 dashed",
        name: "true error against the finest mesh, sup",
        of: |level| level.error.map(|error| error.sup),
    },
];
const INDICES: [Quantity; 2] = [
    Quantity { class: "s0 solid", name: "of the mean", of: |level| level.effectivity.map(|index| index.mean) },
    Quantity { class: "s1 solid", name: "of the sup", of: |level| level.effectivity.map(|index| index.sup) },
];
const CONTACT: [Quantity; 3] = [
    Quantity { class: "s0 solid", name: "averaged peak force", of: |level| level.averaged_peak_force },
    Quantity { class: "s1 solid", name: "impulse", of: |level| level.impulse },
    Quantity { class: "s2 solid", name: "rebound velocity", of: |level| level.rebound },
];
/// The meaning of the shaded range.
const EXPECTED: &str = "expected by the verdict on the first mesh";

/// Estimate and true error, effectivity index, and peak force, impulse, rebound velocity and probes over their values
/// on the finest mesh, all over the size of the elements, as an SVG document. The range of the index that the verdict
/// expects on the first mesh is shaded. None with fewer than two meshes or without an error.
#[must_use]
pub fn convergence(verification: &Verification) -> Option<String> {
    let levels = &verification.levels;
    let errors = with_values(ERRORS.iter().map(|quantity| LevelLine::new(quantity, levels, 1.0).positive()));
    let y = around(&errors).filter(|_| levels.len() > 1)?;
    let (indices, band) = (INDICES.iter().map(|quantity| LevelLine::new(quantity, levels, 1.0)), levels[0].expected);
    let (indices, contact) = (with_values(indices), over_the_finest(levels));
    let charts = [
        Chart {
            label: format!("error ({})", verification.units().of("J^½")),
            y,
            lines: errors,
            rows: 2,
            band: None,
            none: "",
        },
        Chart {
            label: "effectivity index".to_string(),
            y: padded(&indices, band.as_slice().as_flattened()),
            lines: indices,
            rows: 1,
            band,
            none: "the error is zero to rounding",
        },
        Chart {
            label: "over the finest".to_string(),
            y: padded(&contact, &[]),
            rows: contact.len().div_ceil(3).max(1),
            lines: contact,
            band: None,
            none: "nothing touches",
        },
    ];
    let height = charts.iter().map(|chart| chart.head() + HEIGHT + BELOW).sum::<f64>();
    let mut svg = Svg::new([SIZE[0], height + ROOM[3] - BELOW]);
    let mut top = 0.0;
    for (k, chart) in charts.iter().enumerate() {
        let label = if k + 1 == charts.len() { "element size over that of the first mesh" } else { "" };
        chart.draw(&mut svg, top, levels.len(), label);
        top += chart.head() + HEIGHT + BELOW;
    }
    Some(svg.alone())
}

/// A quantity at the levels that have it: element size over that of the first mesh, and value.
struct LevelLine {
    class: String,
    name: String,
    points: Vec<(f64, f64)>,
}

impl LevelLine {
    /// The values over `scale`.
    fn new(quantity: &Quantity, levels: &[Level], scale: f64) -> Self {
        let (class, name) = (quantity.class.to_string(), quantity.name.to_string());
        Self { class, name, points: points(levels, quantity.of, scale) }
    }

    /// Without the values that a logarithmic scale cannot show.
    fn positive(mut self) -> Self {
        self.points.retain(|&(_, value)| value > 0.0);
        self
    }
}

/// Element size over that of the first mesh, and value over `scale`, at the levels that have one.
fn points(levels: &[Level], of: impl Fn(&Level) -> Option<f64>, scale: f64) -> Vec<(f64, f64)> {
    let point = |(k, level): (usize, &Level)| Some((size(k), of(level)? / scale));
    levels.iter().enumerate().filter_map(point).filter(|(_, value)| value.is_finite()).collect()
}

/// One of the plots, with its scale, the rows of its legend, a range that is shaded, and the reason for no values. On a
/// linear scale a line marks 1.
struct Chart {
    label: String,
    lines: Vec<LevelLine>,
    y: Scale,
    rows: usize,
    band: Option<[f64; 2]>,
    none: &'static str,
}

impl Chart {
    /// Room for the legend.
    fn head(&self) -> f64 {
        ROW * self.rows as f64 + 14.0
    }

    fn draw(&self, svg: &mut Svg, top: f64, levels: usize, below: &str) {
        let x = Scale::logarithmic(size(levels - 1) / BESIDE, BESIDE);
        let corner = [ROOM[0], top + self.head()];
        let plot = Plot { corner, size: [SIZE[0] - ROOM[0] - ROOM[2], HEIGHT], x, y: self.y };
        if let Some([low, high]) = self.band {
            svg.rectangle("class=\"s2 band\"", plot.at(x.low, low), plot.at(x.high, high));
        }
        plot.axes(svg, &Look { x: below, y: &self.label, marks: [0, 5], whole: false, grid: [true; 2] });
        for k in 0..levels {
            let ([at, bottom], name) = (plot.at(size(k), self.y.low), fraction(k));
            svg.line("axis", [at, bottom], [at, bottom + 5.0]);
            svg.text("label", [at, bottom + 18.0], Anchor::Middle, false, &name);
        }
        if !self.y.logarithmic {
            svg.line("now", plot.at(x.low, 1.0), plot.at(x.high, 1.0));
        }
        for line in &self.lines {
            let places: Vec<_> = line.points.iter().map(|&(x, y)| plot.at(x, y)).collect();
            places.iter().for_each(|&at| svg.circle(&line.class, at, 3.5));
            svg.polyline(&line.class, places);
        }
        if self.lines.is_empty() {
            let middle = [corner[0] + 0.5 * plot.size[0], corner[1] + 0.5 * HEIGHT];
            svg.text("faint", middle, Anchor::Middle, false, self.none);
        }
        self.legend(svg, top);
    }

    /// Names beside samples, column by column.
    fn legend(&self, svg: &mut Svg, top: f64) {
        let lines = self.lines.iter().map(|line| (&line.class[..], &line.name[..]));
        let entries: Vec<_> = lines.chain(self.band.map(|_| ("s2 band", EXPECTED))).collect();
        let mut x = ROOM[0];
        for column in entries.chunks(self.rows) {
            for (row, &(class, name)) in column.iter().enumerate() {
                let y = top + 14.0 + ROW * row as f64;
                if class.ends_with("band") {
                    svg.rectangle(&format!("class=\"{class}\""), [x, y - 5.0], [x + SAMPLE, y + 5.0]);
                } else {
                    svg.line(class, [x, y], [x + SAMPLE, y]);
                }
                svg.text("label", [x + SAMPLE + 6.0, y + 4.5], Anchor::Start, false, name);
            }
            let longest = column.iter().map(|(_, name)| name.chars().count()).max().unwrap_or(0);
            x += SAMPLE + 6.0 + LETTER * longest as f64 + 18.0;
        }
    }
}

/// Element size of a level over that of the first mesh.
fn size(level: usize) -> f64 {
    0.5_f64.powi(level as i32)
}

fn fraction(level: usize) -> String {
    if level == 0 { "1".to_string() } else { format!("1/{}", 1 << level) }
}

fn with_values(lines: impl Iterator<Item = LevelLine>) -> Vec<LevelLine> {
    lines.filter(|line| !line.points.is_empty()).collect()
}

/// The lines of contact and of probes, each over its value on the finest mesh; those without one are left out.
fn over_the_finest(levels: &[Level]) -> Vec<LevelLine> {
    let finest = |of: &dyn Fn(&Level) -> Option<f64>| levels.last().and_then(of).filter(|value| *value != 0.0);
    let line = |quantity: &Quantity| Some(LevelLine::new(quantity, levels, finest(&quantity.of)?));
    let probe = |(at, probe): (usize, &ProbeValue)| {
        let of = |level: &Level| level.probes.get(at).map(|probe| probe.value);
        // Three colours are left; a fourth probe has the first of them, and a dashed line.
        let look = if (at / 3).is_multiple_of(2) { "solid" } else { "dashed" };
        let class = format!("s{} {look}", CONTACT.len() + at % 3);
        Some(LevelLine { class, name: probe.name.clone(), points: points(levels, of, finest(&of)?) })
    };
    let probes = levels.last().map_or(&[][..], |level| &level.probes);
    with_values(CONTACT.iter().filter_map(line).chain(probes.iter().enumerate().filter_map(probe)))
}

/// A logarithmic scale with room on both sides of the errors; none without any.
fn around(lines: &[LevelLine]) -> Option<Scale> {
    let values = || lines.iter().flat_map(|line| &line.points).map(|point| point.1);
    Some(Scale::logarithmic(values().reduce(f64::min)? / AROUND, values().reduce(f64::max)? * AROUND))
}

/// A linear scale around the values of lines, others and 1.
fn padded(lines: &[LevelLine], others: &[f64]) -> Scale {
    let values = lines.iter().flat_map(|line| &line.points).map(|point| point.1).chain(others.iter().copied());
    let (low, high) = values.fold((1.0_f64, 1.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    let room = PADDING * (high - low).max(0.05);
    Scale::linear(low - room, high + room)
}
