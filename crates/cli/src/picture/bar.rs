//! The error of each element of a bar, over its length.

use super::DrawError;
use super::canvas::{AXIS_BELOW, AXIS_LEFT, FAINT, HEAD, INK, MARGIN, UNITS, colour, draw_axes, largest, picture, px};
use percute_core::ids::ElementId;
use percute_core::problem::BarProblem;
use percute_workflow::report::Report;
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::prelude::*;

/// Size of the plot (pixels).
const PLOT: (i32, i32) = (760, 360);
/// Room at both ends, as a part of the length, and above the largest value.
const ROOM: f64 = 0.04;

/// Draws the error as a step curve, and the planes.
pub(super) fn draw(problem: &BarProblem, report: &Report) -> Result<String, DrawError> {
    let size = (AXIS_LEFT + PLOT.0 + 3 * MARGIN, HEAD + PLOT.1 + AXIS_BELOW + MARGIN);
    picture(size, report, |area| draw_curve(area, problem, report))
}

/// The pieces of the curve in order: from, to, value.
fn pieces(problem: &BarProblem, values: &[f64]) -> Vec<(f64, f64, f64)> {
    let ends = |e: usize| problem.mesh().cell_points(ElementId::new(e)).map(|p| p[0]);
    let piece = |(e, &value): (usize, &f64)| {
        let [a, b] = ends(e);
        (a.min(b), a.max(b), value)
    };
    let mut pieces: Vec<_> = values.iter().enumerate().map(piece).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    pieces
}

fn draw_curve(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    problem: &BarProblem,
    report: &Report,
) -> Result<(), DrawError> {
    let (low, high) = (report.problem.lower_corner[0], report.problem.upper_corner[0]);
    let room = ROOM * (high - low);
    let shown = low - room..high + room;
    let top = largest(&report.by_element) * (1.0 + 2.0 * ROOM);
    let mut chart = ChartBuilder::on(area)
        .margin_left(px(f64::from(MARGIN)))
        .margin_right(px(f64::from(2 * MARGIN)))
        .margin_bottom(px(f64::from(MARGIN)))
        .x_label_area_size(px(f64::from(AXIS_BELOW)))
        .y_label_area_size(px(f64::from(AXIS_LEFT)))
        .build_cartesian_2d(shown.clone(), 0.0..top)
        .map_err(DrawError::from_library)?;
    draw_axes(&mut chart, |axes| {
        let line = FAINT.mix(0.25).stroke_width(UNITS as u32);
        axes.disable_x_mesh().light_line_style(TRANSPARENT).bold_line_style(line).x_desc("x (m)").y_desc("e_E (J^½)")
    })?;
    let pieces = pieces(problem, &report.by_element);
    let line = colour(0.35, 1.0);
    let bars = pieces.iter().map(|&(a, b, v)| Rectangle::new([(a, 0.0), (b, v)], line.mix(0.25).filled()));
    chart.draw_series(bars).map_err(DrawError::from_library)?;
    let steps: Vec<(f64, f64)> = pieces.iter().flat_map(|&(a, b, v)| [(a, v), (b, v)]).collect();
    let curve = LineSeries::new(steps, line.stroke_width(2 * UNITS as u32));
    chart.draw_series(curve).map_err(DrawError::from_library)?;
    let planes = problem.obstacles().iter().map(|plane| -plane.gap(&[0.0]) * plane.flat_frame().normal()[0]);
    let planes = planes.filter(|x| shown.contains(x));
    let lines = planes.map(|x| PathElement::new(vec![(x, 0.0), (x, top)], INK.stroke_width(2 * UNITS as u32)));
    chart.draw_series(lines).map_err(DrawError::from_library)?;
    Ok(())
}
