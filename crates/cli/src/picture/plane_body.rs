//! The error of each triangle, on the mesh.

use super::DrawError;
use super::canvas::{AXIS_BELOW, AXIS_LEFT, Chart, HEAD, INK, MARGIN, UNITS, colour, draw_axes, largest, picture, px};
use super::frame::Frame;
use percute_core::contact::Obstacle;
use percute_core::ids::ElementId;
use percute_core::problem::TriangleProblem;
use percute_workflow::report::Report;
use plotters::backend::SVGBackend;
use plotters::chart::LabelAreaPosition;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Room for the scale of colours: a gap, the colours, its numbers (pixels).
const SCALE: [i32; 3] = [26, 18, 78];
/// Steps of the scale of colours.
const SHADES: usize = 128;
/// Elements are outlined from this size on (pixels).
const OUTLINED: f64 = 14.0;
/// Distance of the strokes that hatch the far side of a plane, and their length (pixels).
const HATCH: f64 = 9.0;

/// Draws the mesh, the planes and the scale of colours.
pub(super) fn draw(problem: &TriangleProblem, report: &Report) -> Result<String, DrawError> {
    let corner = |corner: &[f64]| [corner[0], corner[1]];
    let frame = Frame::around(corner(&report.problem.lower_corner), corner(&report.problem.upper_corner));
    let width = MARGIN + AXIS_LEFT + frame.pixels[0] + SCALE.iter().sum::<i32>() + MARGIN;
    let height = HEAD + frame.pixels[1] + AXIS_BELOW + MARGIN;
    let most = largest(&report.by_element);
    picture((width, height), report, |area| {
        let (map, scale) = area.split_horizontally(px(f64::from(MARGIN + AXIS_LEFT + frame.pixels[0])));
        draw_map(&map, &frame, problem, &report.by_element, most)?;
        draw_scale(&scale, most)
    })
}

fn draw_map(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    frame: &Frame,
    problem: &TriangleProblem,
    values: &[f64],
    most: f64,
) -> Result<(), DrawError> {
    let mut chart = ChartBuilder::on(area)
        .margin_left(px(f64::from(MARGIN)))
        .margin_bottom(px(f64::from(MARGIN)))
        .x_label_area_size(px(f64::from(AXIS_BELOW)))
        .y_label_area_size(px(f64::from(AXIS_LEFT)))
        .build_cartesian_2d(frame.low[0]..frame.high[0], frame.low[1]..frame.high[1])
        .map_err(DrawError::from_library)?;
    draw_axes(&mut chart, |axes| {
        let labels = [frame.pixels[0] / 90, frame.pixels[1] / 60].map(|count| count.max(3) as usize);
        axes.disable_mesh().x_labels(labels[0]).y_labels(labels[1]).x_desc("x (m)").y_desc("y (m)")
    })?;
    draw_elements(&mut chart, frame, problem, values, most)?;
    problem.obstacles().iter().try_for_each(|plane| draw_plane(&mut chart, frame, plane))
}

fn draw_elements(
    chart: &mut Chart<'_, '_>,
    frame: &Frame,
    problem: &TriangleProblem,
    values: &[f64],
    most: f64,
) -> Result<(), DrawError> {
    let mesh = problem.mesh();
    let corners = |e: usize| mesh.cell_points(ElementId::new(e)).map(|p| (p[0], p[1]));
    let filled = |(e, &value): (usize, &f64)| Polygon::new(corners(e).to_vec(), colour(value, most).filled());
    chart.draw_series(values.iter().enumerate().map(filled)).map_err(DrawError::from_library)?;
    let area: f64 = (0..mesh.element_count()).map(|e| mesh.cell_geometry(ElementId::new(e)).volume).sum();
    if frame.scale() * (area / mesh.element_count() as f64).sqrt() < OUTLINED {
        return Ok(());
    }
    let outline = WHITE.mix(0.3).stroke_width(UNITS as u32 / 2);
    let outlined = |e: usize| {
        let [a, b, c] = corners(e);
        PathElement::new(vec![a, b, c, a], outline)
    };
    chart.draw_series((0..mesh.element_count()).map(outlined)).map_err(DrawError::from_library)?;
    Ok(())
}

/// A plane as a line, hatched on the side where the body cannot go.
fn draw_plane(chart: &mut Chart<'_, '_>, frame: &Frame, plane: &Obstacle<2>) -> Result<(), DrawError> {
    let centre = [0, 1].map(|c| 0.5 * (frame.low[c] + frame.high[c]));
    let (normal, gap) = (*plane.flat_frame().normal(), plane.gap(&centre));
    let foot = [0, 1].map(|c| centre[c] - gap * normal[c]);
    let along = [normal[1], -normal[0]];
    let Some((from, to)) = frame.clip(foot, along) else { return Ok(()) };
    let at = |s: f64, depth: f64| [0, 1].map(|c| foot[c] + s * along[c] - depth * normal[c]);
    let pair = |p: [f64; 2]| (p[0], p[1]);
    let line = PathElement::new(vec![pair(at(from, 0.0)), pair(at(to, 0.0))], INK.stroke_width(2 * UNITS as u32));
    let spacing = HATCH / frame.scale();
    let count = ((to - from) / spacing).floor() as usize;
    let strokes = (1..=count).filter_map(|i| {
        let s = from + i as f64 * spacing;
        let (start, end) = (at(s, 0.0), at(s - spacing, spacing));
        frame.holds(end).then(|| PathElement::new(vec![pair(start), pair(end)], INK.stroke_width(UNITS as u32)))
    });
    chart.draw_series(std::iter::once(line).chain(strokes)).map_err(DrawError::from_library)?;
    Ok(())
}

fn draw_scale(area: &DrawingArea<SVGBackend<'_>, Shift>, most: f64) -> Result<(), DrawError> {
    let mut chart = ChartBuilder::on(area)
        .margin_left(px(f64::from(SCALE[0])))
        .margin_right(px(f64::from(MARGIN)))
        .margin_bottom(px(f64::from(MARGIN + AXIS_BELOW)))
        .set_label_area_size(LabelAreaPosition::Right, px(f64::from(SCALE[2])))
        .build_cartesian_2d(0.0..1.0, 0.0..most)
        .map_err(DrawError::from_library)?;
    let height = most / SHADES as f64;
    let shade = |i: usize| {
        let low = i as f64 * height;
        Rectangle::new([(0.0, low), (1.0, low + height)], colour(low + 0.5 * height, most).filled())
    };
    chart.draw_series((0..SHADES).map(shade)).map_err(DrawError::from_library)?;
    draw_axes(&mut chart, |axes| axes.disable_mesh().disable_x_axis().y_labels(8).y_desc("e_E (J^½)"))
}
