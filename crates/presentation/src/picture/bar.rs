//! The error of each element of a bar, over its length.

use super::{AXIS_BELOW, AXIS_LEFT, Body, Document, MARGIN, marks, planes, worst};
use crate::axes::{Look, Plot};
use crate::scale::{Scale, prefixed};
use crate::svg::Svg;

/// Size of the plot (pixels).
const PLOT: [f64; 2] = [760.0, 360.0];
/// Room at both ends, as a part of the length, and above the largest value.
const ROOM: f64 = 0.04;

pub(super) fn size(top: f64) -> [f64; 2] {
    [AXIS_LEFT + PLOT[0] + 2.0 * MARGIN, top + PLOT[1] + AXIS_BELOW]
}

/// Draws the error as a step curve, and the planes.
pub(super) fn draw(svg: &mut Svg, body: &Body, document: &Document, top: f64, marked: usize) {
    let values = document.column("by_element");
    let [low, high] = body.bounds().map(|corner| corner[0]);
    let (factor, unit) = prefixed("m", low.abs().max(high.abs()));
    let room = ROOM * (high - low);
    let x = Scale::linear((low - room) * factor, (high + room) * factor);
    // A curve shows what is small beside what is large; colours do not.
    let most = values.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    let y = Scale::linear(0.0, most * (1.0 + ROOM));
    let plot = Plot { corner: [AXIS_LEFT, top], size: PLOT, x, y };
    let label = format!("x ({unit})");
    plot.axes(
        svg,
        &Look {
            x: &label,
            y: &format!("e_E ({})", document.unit("J^½")),
            marks: [8, 6],
            whole: false,
            grid: [true, false],
        },
    );
    let pieces = pieces(body, &values);
    let at = |x: f64, value: f64| plot.at(x * factor, value);
    for &(a, b, value) in &pieces {
        svg.rectangle("class=\"area\"", at(a, value), at(b, 0.0));
    }
    svg.polyline("s0", pieces.iter().flat_map(|&(a, b, value)| [at(a, value), at(b, value)]));
    let place = |worst: &serde_json::Value| match crate::document::numbers(&worst["centroid"]).as_slice() {
        &[x] => Some(plot.at(x * factor, worst["error"].as_f64().unwrap_or(0.0))),
        _ => None,
    };
    marks(svg, &worst(document, marked).filter_map(place).collect::<Vec<_>>());
    let places = planes(document).into_iter().map(|plane| plane.point[0] * factor);
    for place in places.filter(|place| (x.low..=x.high).contains(place)) {
        svg.line("plane", plot.at(place, 0.0), plot.at(place, y.high));
    }
}

/// The pieces of the curve in order: from, to, value.
fn pieces(body: &Body, values: &[f64]) -> Vec<(f64, f64, f64)> {
    let piece = |(element, &value): (usize, &f64)| {
        let ends = body.corners(element).map(|p| p[0]);
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        (low, high, if value.is_finite() { value } else { 0.0 })
    };
    let mut pieces: Vec<_> = values.iter().take(body.elements()).enumerate().map(piece).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    pieces
}
