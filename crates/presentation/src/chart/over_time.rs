//! Quantities over time.

use super::envelope::envelope;
use super::{Legend, ROOM, SIZE};
use crate::axes::{Look, Plot};
use crate::scale::{Scale, prefixed};
use crate::svg::{Anchor, Svg};

/// Most points of a line; of longer ones, each piece gives its smallest and its largest value.
const POINTS: usize = 1200;
/// Most lines of a chart: there are as many looks.
pub(crate) const LINES: usize = 6;

/// A quantity over time.
#[derive(Clone, Debug)]
pub(crate) struct Line<'a> {
    pub(crate) name: &'a str,
    pub(crate) values: Vec<f64>,
}

/// A chart of quantities over time.
#[derive(Clone, Debug)]
pub(crate) struct OverTime<'a> {
    /// Instants (s), for all lines.
    pub(crate) time: Vec<f64>,
    /// Name and unit of the quantity; with an SI prefix if `prefixes` says so.
    pub(crate) quantity: &'a str,
    pub(crate) unit: &'a str,
    pub(crate) prefixes: bool,
    pub(crate) lines: Vec<Line<'a>>,
    /// An instant to show (s), with its name.
    pub(crate) mark: Option<(f64, &'a str)>,
}

impl OverTime<'_> {
    /// Draws the chart; none without two instants or without a finite value.
    pub(crate) fn draw(&self) -> Option<Svg> {
        let (&from, &to) = (self.time.first()?, self.time.last()?);
        let values = || self.lines.iter().flat_map(|line| &line.values).copied().filter(|v| v.is_finite());
        let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
        if self.time.len() < 2 || values().next().is_none() {
            return None;
        }
        let (in_time, second) = prefixed("s", from.abs().max(to.abs()));
        let (factor, unit) =
            if self.prefixes { prefixed(self.unit, high.max(-low)) } else { (1.0, self.unit.to_string()) };
        let room = 0.04 * (high - low);
        let y = Scale::linear(factor * if low < 0.0 { low - room } else { 0.0 }, factor * (high + room));
        // A single line is named by its axis.
        let named = if self.lines.len() > 1 { &self.lines[..self.lines.len().min(LINES)] } else { &[] };
        let legend = Legend::new(named.iter().map(|line| line.name));
        let [left, top, right, below] = ROOM;
        let (corner, size) = ([left, top + legend.further()], [SIZE[0] - left - right, SIZE[1] - top - below]);
        let plot = Plot { corner, size, x: Scale::linear(from * in_time, to * in_time), y };
        let mut svg = Svg::new([SIZE[0], SIZE[1] + legend.further()]);
        let quantity = if unit.is_empty() { self.quantity.to_string() } else { format!("{} ({unit})", self.quantity) };
        let labels = (format!("t ({second})"), quantity);
        // Numbers of things have no halves.
        let whole = unit.is_empty();
        plot.axes(&mut svg, &Look { x: &labels.0, y: &labels.1, marks: [7, 5], whole, grid: [true, false] });
        if let Some((at, name)) = self.mark {
            let [x, _] = plot.at(at * in_time, 0.0);
            svg.line("now", [x, corner[1]], [x, corner[1] + size[1]]);
            svg.text("faint", [x, corner[1] - 4.0], Anchor::Middle, false, name);
        }
        for (k, line) in self.lines.iter().enumerate().take(LINES) {
            let at = |t: f64, value: f64| plot.at(t * in_time, value * factor);
            let Some(ranges) = envelope(&self.time, &line.values) else {
                let points = thinned(&self.time, &line.values).into_iter();
                svg.polyline(&format!("s{k}"), points.map(|(t, value)| at(t, value)));
                continue;
            };
            let (low, high) =
                (ranges.iter().map(|r| at(r.time, r.low)), ranges.iter().rev().map(|r| at(r.time, r.high)));
            svg.polyline(&format!("range r{k}"), low.chain(high));
            svg.polyline(&format!("s{k}"), ranges.iter().map(|r| at(r.time, r.mean)));
        }
        legend.draw(&mut svg);
        Some(svg)
    }
}

/// A line of at most [`POINTS`] points, with its peaks; values that are not finite are left out.
fn thinned(time: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    let all: Vec<(f64, f64)> =
        time.iter().copied().zip(values.iter().copied()).filter(|(_, v)| v.is_finite()).collect();
    if all.len() <= POINTS {
        return all;
    }
    let extremes = |piece: &[(f64, f64)]| {
        let order = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let mut both: Vec<_> =
            piece.iter().min_by(order).into_iter().chain(piece.iter().max_by(order)).copied().collect();
        both.sort_by(|a, b| a.0.total_cmp(&b.0));
        both
    };
    let length = all.len().div_ceil(POINTS / 2);
    let mut points: Vec<_> = all.chunks(length).flat_map(extremes).collect();
    points.extend(all.last());
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_keep_their_peaks() {
        let time: Vec<f64> = (0..50_000).map(f64::from).collect();
        let mut values = vec![0.0; 50_000];
        (values[12_345], values[23_456]) = (7.0, -3.0);
        let points = thinned(&time, &values);
        assert!(points.len() <= POINTS + 1 && points.contains(&(12_345.0, 7.0)) && points.contains(&(23_456.0, -3.0)));
        assert!(points.is_sorted_by(|a, b| a.0 <= b.0));
        assert_eq!(thinned(&[0.0, 1.0], &[f64::NAN, 2.0]), [(1.0, 2.0)]);
    }

    #[test]
    fn numbers_of_things_have_whole_marks() {
        for (most, marks) in [(1.0, &["0", "1"][..]), (2.0, &["0", "1", "2"]), (3.0, &["0", "1", "2", "3"])] {
            let chart = OverTime {
                time: vec![0.0, 2e-5],
                quantity: "nodes",
                unit: "",
                prefixes: false,
                lines: vec![Line { name: "all", values: vec![0.0, most] }],
                mark: None,
            };
            let drawn = chart.draw().unwrap().alone();
            let labels = drawn.lines().filter(|line| line.contains("text-anchor=\"end\""));
            let labels: Vec<_> = labels.filter_map(|line| line.split(['>', '<']).nth(2)).collect();
            assert_eq!(labels, marks);
        }
    }

    #[test]
    fn nothing_to_draw_is_no_chart() {
        let chart = |time: Vec<f64>, values: Vec<f64>| OverTime {
            time,
            quantity: "force",
            unit: "N",
            prefixes: true,
            lines: vec![Line { name: "all", values }],
            mark: None,
        };
        assert!(chart(vec![], vec![]).draw().is_none());
        assert!(chart(vec![0.0, 1.0], vec![f64::NAN; 2]).draw().is_none());
        let drawn = chart(vec![0.0, 2e-6], vec![0.0, 5e3]).draw().unwrap().alone();
        assert!(drawn.contains("t (µs)") && drawn.contains("force (kN)"), "{drawn}");
    }
}
