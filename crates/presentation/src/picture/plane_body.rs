//! The error of each triangle, on the mesh.

use super::frame::Frame;
use super::{AXIS_BELOW, AXIS_LEFT, Body, Deformed, Elements, LEGEND, Plane, Shown, marks, planes, worst};
use crate::axes::{Look, Plot, colour_bar};
use crate::png;
use crate::scale::{Scale, prefixed, viridis};
use crate::svg::{Anchor, Svg};

/// Room for the scale of colours: a gap, the colours, its numbers (pixels).
const SCALE: [f64; 3] = [22.0, 18.0, 90.0];
/// Elements are outlined from this size on (pixels).
const OUTLINED: f64 = 7.0;
/// Strokes shorter than this may be a point (pixels): places are written to a tenth.
const SHORTEST: f64 = 0.1;
/// Distance of the strokes that hatch the far side of a plane (pixels).
const HATCH: f64 = 9.0;
/// A plane is in the picture if its distance is at most this part of the size of the body.
const NEAR: f64 = 0.25;

/// Around the body, its outline and the planes near it.
fn frame(shown: &Shown<'_>) -> Frame {
    let [mut low, mut high] = shown.body.bounds();
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let near = planes(shown.document).into_iter().filter_map(|plane| foot(shown.body, &plane, NEAR * size));
    for point in shown.deformed.iter().flat_map(Deformed::points).chain(near) {
        (low, high) = ([0, 1].map(|c| low[c].min(point[c])), [0, 1].map(|c| high[c].max(point[c])));
    }
    Frame::around(low, high)
}

/// The point of a plane that is nearest to the body, if it is near.
fn foot(body: &Body, plane: &Plane, near: f64) -> Option<[f64; 2]> {
    let gap = |p: &[f64; 2]| (0..2).map(|c| (p[c] - plane.point[c]) * plane.normal[c]).sum::<f64>();
    let nearest = body.points.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)))?;
    (gap(nearest) <= near).then(|| [0, 1].map(|c| nearest[c] - gap(nearest) * plane.normal[c]))
}

pub(super) fn size(shown: &Shown<'_>) -> [f64; 2] {
    let [width, height] = frame(shown).pixels.map(f64::from);
    [AXIS_LEFT + width + SCALE.iter().sum::<f64>(), shown.top + height + AXIS_BELOW]
}

/// Draws the mesh, the planes, the outline, the scale of colours and the places of the worst elements.
pub(super) fn draw(svg: &mut Svg, shown: &Shown<'_>, elements: Elements, marked: usize) {
    let Shown { body, document, top, .. } = *shown;
    let (values, frame) = (document.column("by_element"), frame(shown));
    let size = frame.pixels.map(f64::from);
    let colours = Scale::of_colours(&values);
    let most = frame.low.iter().chain(&frame.high).fold(0.0_f64, |most, x| most.max(x.abs()));
    let (factor, unit) = prefixed("m", most);
    let axis = |c: usize| Scale::linear(frame.low[c] * factor, frame.high[c] * factor);
    let scaled = Plot { corner: [AXIS_LEFT, top], size, x: axis(0), y: axis(1) };
    let plot =
        Plot { x: Scale::linear(frame.low[0], frame.high[0]), y: Scale::linear(frame.low[1], frame.high[1]), ..scaled };
    let drawn = |svg: &mut Svg, plot: &Plot| draw_elements(svg, plot, &frame, body, &values, &colours);
    match elements {
        Elements::Vectors => drawn(svg, &plot),
        Elements::Pixels => {
            let mut alone = Svg::new(size);
            drawn(&mut alone, &Plot { corner: [0.0, 0.0], ..plot });
            // Without memory for the pixels, the page has polygons.
            match png::marks(&alone) {
                Ok(png) => svg.image("map", &png, plot.corner, [0, 1].map(|c| plot.corner[c] + size[c])),
                Err(_) => drawn(svg, &plot),
            }
        }
    }
    planes(document).iter().for_each(|plane| draw_plane(svg, &plot, &frame, plane));
    if let Some(deformed) = &shown.deformed {
        draw_outline(svg, &plot, deformed);
    }
    let count = [size[0] / 90.0, size[1] / 60.0].map(|count| count.max(3.0) as usize);
    let labels = ["x", "y"].map(|axis| format!("{axis} ({unit})"));
    scaled.axes(svg, &Look { x: &labels[0], y: &labels[1], marks: count, whole: false, grid: [false; 2] });
    let centroids = worst(document, marked).map(|worst| crate::document::numbers(&worst["centroid"]));
    let places = centroids.filter_map(|at| <[f64; 2]>::try_from(at).ok()).map(|[x, y]| plot.at(x, y));
    marks(svg, &places.collect::<Vec<_>>());
    let bar = [AXIS_LEFT + size[0] + SCALE[0], top];
    let less = values.iter().any(|&value| value < colours.low);
    colour_bar(svg, bar, [SCALE[1], size[1]], &colours, (&format!("e_E ({})", document.unit("J^½")), less));
}

/// Draws the outline, seen on dark and on light elements, and says above the plot what it is.
fn draw_outline(svg: &mut Svg, plot: &Plot, deformed: &Deformed) {
    let at = [AXIS_LEFT, plot.corner[1] - LEGEND + 12.0];
    for class in ["halo", "outline"] {
        deformed.lines.iter().for_each(|line| svg.polyline(class, line.iter().map(|&[x, y]| plot.at(x, y))));
    }
    svg.polyline("outline", [at, [at[0] + 26.0, at[1]]]);
    svg.text("label", [at[0] + 32.0, at[1] + 4.5], Anchor::Start, false, &deformed.label);
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
    // Strokes that begin beyond the frame may end in it.
    for i in 0..=((to - from) / spacing).floor() as usize + 1 {
        let s = from + i as f64 * spacing;
        let Some(stroke) = frame.within(at(s, 0.0), at(s - spacing, spacing)) else { continue };
        let [start, end] = [place(stroke[0]), place(stroke[1])];
        // A stroke in a corner of the frame alone is there or not by rounding.
        if (0..2).any(|c| (end[c] - start[c]).abs() > SHORTEST) {
            svg.line("hatch", start, end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The strokes of a plane through the centre of a frame of 200 by 200 pixels.
    fn strokes(normal: [f64; 2]) -> Vec<[f64; 4]> {
        let frame = Frame { low: [0.0, 0.0], high: [200.0, 200.0], pixels: [200, 200] };
        let side = Scale::linear(0.0, 200.0);
        let plot = Plot { corner: [0.0, 0.0], size: [200.0, 200.0], x: side, y: side };
        let mut svg = Svg::new([200.0, 200.0]);
        draw_plane(&mut svg, &plot, &frame, &Plane { point: [100.0, 100.0], normal });
        let text = svg.alone();
        let of = |line: &str, key: &str| -> f64 {
            line.split(&format!(" {key}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
        };
        let lines = text.lines().filter(|line| line.starts_with("<line class=\"hatch\""));
        lines.map(|line| ["x1", "y1", "x2", "y2"].map(|key| of(line, key))).collect()
    }

    #[test]
    fn a_plane_is_hatched_from_end_to_end() {
        for degrees in [0.0_f64, 10.0, -10.0, 35.0, 80.0, 100.0, -135.0, 180.0] {
            let (cos, sin) = (degrees.to_radians().cos(), degrees.to_radians().sin());
            let strokes = strokes([-sin, cos]);
            assert!(strokes.iter().flatten().all(|x| (-0.1..=200.1).contains(x)), "{degrees}: {strokes:?}");
            assert!(strokes.iter().all(|s| s[0] != s[2] || s[1] != s[3]), "{degrees}: {strokes:?}");
            // Along the plane, from end to end of its part in the frame, no gap is longer than two distances of
            // strokes.
            let along = |x: f64, y: f64| (x - 100.0) * cos + (100.0 - y) * sin;
            let half = 100.0 / cos.abs().max(sin.abs());
            let mut places: Vec<f64> = strokes.iter().flat_map(|s| [along(s[0], s[1]), along(s[2], s[3])]).collect();
            places.extend([-half, half]);
            places.sort_by(f64::total_cmp);
            let gap = places.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            assert!(gap <= 1.2 * HATCH, "{degrees}: a gap of {gap}");
        }
    }
}
