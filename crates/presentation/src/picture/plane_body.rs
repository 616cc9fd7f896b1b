//! The error of each triangle, on the mesh.

use super::frame::Frame;
use super::{AXIS_BELOW, AXIS_LEFT, Body, Document, Elements, Plane, mark, planes, ranked};
use crate::axes::{Look, Plot, colour_bar};
use crate::png::marks;
use crate::scale::{Scale, prefixed, viridis};
use crate::svg::Svg;

/// Room for the scale of colours: a gap, the colours, its numbers (pixels).
const SCALE: [f64; 3] = [22.0, 18.0, 90.0];
/// Elements are outlined from this size on (pixels).
const OUTLINED: f64 = 7.0;
/// Distance of the strokes that hatch the far side of a plane (pixels).
const HATCH: f64 = 9.0;

fn frame(body: &Body) -> Frame {
    let [low, high] = body.bounds();
    Frame::around(low, high)
}

pub(super) fn size(body: &Body, top: f64) -> [f64; 2] {
    let [width, height] = frame(body).pixels.map(f64::from);
    [AXIS_LEFT + width + SCALE.iter().sum::<f64>(), top + height + AXIS_BELOW]
}

/// Draws the mesh, the planes, the scale of colours and the places of the worst elements.
pub(super) fn draw(svg: &mut Svg, body: &Body, document: &Document, top: f64, elements: Elements, marked: usize) {
    let (values, frame) = (document.column("by_element"), frame(body));
    let size = frame.pixels.map(f64::from);
    let colours = Scale::of_colours(&values);
    let most = frame.low.iter().chain(&frame.high).fold(0.0_f64, |most, x| most.max(x.abs()));
    let (factor, unit) = prefixed("m", most);
    let axis = |c: usize| Scale::linear(frame.low[c] * factor, frame.high[c] * factor);
    let shown = Plot { corner: [AXIS_LEFT, top], size, x: axis(0), y: axis(1) };
    let plot =
        Plot { x: Scale::linear(frame.low[0], frame.high[0]), y: Scale::linear(frame.low[1], frame.high[1]), ..shown };
    let drawn = |svg: &mut Svg, plot: &Plot| draw_elements(svg, plot, &frame, body, &values, &colours);
    match elements {
        Elements::Vectors => drawn(svg, &plot),
        Elements::Pixels => {
            let mut alone = Svg::new(size);
            drawn(&mut alone, &Plot { corner: [0.0, 0.0], ..plot });
            // Without memory for the pixels, the page has polygons.
            match marks(&alone) {
                Ok(png) => svg.image("map", &png, plot.corner, [0, 1].map(|c| plot.corner[c] + size[c])),
                Err(_) => drawn(svg, &plot),
            }
        }
    }
    planes(document).iter().for_each(|plane| draw_plane(svg, &plot, &frame, plane));
    let marks = [size[0] / 90.0, size[1] / 60.0].map(|count| count.max(3.0) as usize);
    let labels = ["x", "y"].map(|axis| format!("{axis} ({unit})"));
    shown.axes(svg, &Look { x: &labels[0], y: &labels[1], marks, grid: [false; 2] });
    for (rank, worst) in ranked(document, marked) {
        if let &[x, y] = crate::document::numbers(&worst["centroid"]).as_slice() {
            mark(svg, plot.at(x, y), rank);
        }
    }
    let bar = [AXIS_LEFT + size[0] + SCALE[0], top];
    let less = values.iter().any(|&value| value < colours.low);
    colour_bar(svg, bar, [SCALE[1], size[1]], &colours, ("e_E (J^½)", less));
}

fn draw_elements(svg: &mut Svg, plot: &Plot, frame: &Frame, body: &Body, values: &[f64], colours: &Scale) {
    let outlined = frame.scale() * body.mean_size() >= OUTLINED;
    svg.begin(if outlined { "class=\"outlined\"" } else { "class=\"mesh\"" });
    for (element, &value) in values.iter().take(body.elements()).enumerate() {
        svg.polygon(viridis(colours.fraction(value)), body.corners(element).map(|[x, y]| plot.at(x, y)));
    }
    svg.end();
}

/// A plane as a line, hatched on the side where the body cannot go.
fn draw_plane(svg: &mut Svg, plot: &Plot, frame: &Frame, plane: &Plane) {
    let Plane { point, normal } = plane;
    let centre = [0, 1].map(|c| 0.5 * (frame.low[c] + frame.high[c]));
    let gap: f64 = (0..2).map(|c| (centre[c] - point[c]) * normal[c]).sum();
    let foot = [0, 1].map(|c| centre[c] - gap * normal[c]);
    let along = [normal[1], -normal[0]];
    let Some((from, to)) = frame.clip(foot, along) else { return };
    let at = |s: f64, depth: f64| [0, 1].map(|c| foot[c] + s * along[c] - depth * normal[c]);
    let place = |p: [f64; 2]| plot.at(p[0], p[1]);
    svg.line("plane", place(at(from, 0.0)), place(at(to, 0.0)));
    let spacing = HATCH / frame.scale();
    for i in 1..=((to - from) / spacing).floor() as usize {
        let s = from + i as f64 * spacing;
        let end = at(s - spacing, spacing);
        if frame.holds(end) {
            svg.line("hatch", place(at(s, 0.0)), place(end));
        }
    }
}
