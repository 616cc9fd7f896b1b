//! What all pictures share: units, fonts, titles, colours, the SVG document.

use super::DrawError;
use percute_workflow::message::{percent, short, trimmed};
use percute_workflow::report::Report;
use plotters::backend::SVGBackend;
use plotters::chart::{ChartContext, MeshStyle};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};

/// The drawing library rounds to whole units: with eight to a pixel, small triangles keep their shape.
pub(crate) const UNITS: i32 = 8;
/// Room above the plot for two lines (pixels).
pub(super) const HEAD: i32 = 62;
/// Room left of and below the plot for the axes (pixels).
pub(super) const AXIS_LEFT: i32 = 74;
pub(super) const AXIS_BELOW: i32 = 48;
/// Room at the free sides (pixels).
pub(super) const MARGIN: i32 = 16;
/// Length of the marks at the axes, which also keeps the numbers off them (pixels).
pub(super) const MARK: f64 = 5.0;

pub(crate) const INK: RGBColor = RGBColor(40, 40, 48);
pub(crate) const FAINT: RGBColor = RGBColor(110, 110, 120);

/// Axes with a plot between them.
pub(super) type Chart<'c, 's> = ChartContext<'c, SVGBackend<'s>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Pixels in units of the drawing.
pub(crate) fn px(pixels: f64) -> u32 {
    (pixels * f64::from(UNITS)).round() as u32
}

/// A font of this size in pixels.
pub(super) fn font(size: f64, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", f64::from(px(size))).into_font().color(colour)
}

/// The colour of a value between 0 and `most`, from dark to light; equal steps look equal.
pub(super) fn colour(value: f64, most: f64) -> RGBColor {
    let fraction = if most > 0.0 && value.is_finite() { (value / most).clamp(0.0, 1.0) } else { 0.0 };
    ViridisRGB.get_color(fraction)
}

/// The largest finite value, or 1 if all are zero: a scale needs some length.
pub(super) fn largest(values: &[f64]) -> f64 {
    let most = values.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    if most > 0.0 { most } else { 1.0 }
}

/// A coordinate or value at an axis, without trailing zeros.
pub(super) fn tick(value: &f64) -> String {
    // What is left of zero after adding up steps of an axis.
    if value.abs() < 1e-12 { "0".to_string() } else { trimmed(*value, 6) }
}

/// Axes as those of this program.
pub(super) type Axes<'b, 'c, 's> = MeshStyle<'c, 'b, RangedCoordf64, RangedCoordf64, SVGBackend<'s>>;

/// Draws axes in the look of all pictures, with what `own` adds.
pub(super) fn draw_axes<'c, 's>(
    chart: &mut Chart<'c, 's>,
    own: impl for<'a, 'b> FnOnce(&'a mut Axes<'b, 'c, 's>) -> &'a mut Axes<'b, 'c, 's>,
) -> Result<(), DrawError> {
    let mut axes = chart.configure_mesh();
    axes.set_all_tick_mark_size(px(MARK))
        .x_label_formatter(&tick)
        .y_label_formatter(&tick)
        .label_style(font(13.0, &INK))
        .axis_desc_style(font(14.0, &INK))
        .axis_style(INK.stroke_width(UNITS as u32));
    own(&mut axes).draw().map_err(DrawError::from_library)
}

/// Draws a picture of this size in pixels and returns its document.
pub(super) fn picture(
    (width, height): (i32, i32),
    report: &Report,
    body: impl FnOnce(&DrawingArea<SVGBackend<'_>, Shift>) -> Result<(), DrawError>,
) -> Result<String, DrawError> {
    let mut svg = String::new();
    let size = (px(f64::from(width)), px(f64::from(height)));
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).map_err(DrawError::from_library)?;
        head(&root, report)?;
        let (_, below) = root.split_vertically(px(f64::from(HEAD)));
        body(&below)?;
        root.present().map_err(DrawError::from_library)?;
    }
    Ok(document(&svg, size, (width, height)))
}

/// Two lines: the error of the whole, and what is drawn.
fn head(root: &DrawingArea<SVGBackend<'_>, Shift>, report: &Report) -> Result<(), DrawError> {
    let (error, relative) = (short(report.error.sup, 4), percent(report.error.relative_sup));
    let title = format!("Constitutive relation error {error} J^½ ({relative})");
    let cut = if report.interrupted { " (interrupted)" } else { "" };
    let until = trimmed(report.end, 4);
    let name = std::path::Path::new(&report.case).file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
    let line = format!(
        "{name}: contribution of each element up to t = {until} s{cut}; the squares add up to that of the mean error, ({} J^½)²",
        short(report.error.mean, 4)
    );
    let left = px(f64::from(MARGIN)) as i32;
    root.draw_text(&title, &font(19.0, &INK), (left, px(14.0) as i32)).map_err(DrawError::from_library)?;
    root.draw_text(&line, &font(13.0, &FAINT), (left, px(38.0) as i32)).map_err(DrawError::from_library)
}

/// The document in pixels instead of the drawing's units, and without the hairlines that smoothing
/// leaves between neighbouring triangles.
pub(crate) fn document(svg: &str, units: (u32, u32), pixels: (i32, i32)) -> String {
    let drawn = format!("<svg width=\"{}\" height=\"{}\"", units.0, units.1);
    let shown = format!("<svg width=\"{}\" height=\"{}\"", pixels.0, pixels.1);
    let sharp = "<style>polygon,rect{shape-rendering:crispEdges}</style>";
    let (start, rest) = svg.split_once(">\n").unwrap_or((svg, ""));
    format!("{}>\n{sharp}\n{rest}", start.replacen(&drawn, &shown, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short() {
        let shown: Vec<_> =
            [0.0, 1e-17, 0.01, 0.030_000_000_000_000_002, -2.0, 5e-5, 250_000.0].iter().map(tick).collect();
        assert_eq!(shown, ["0", "0", "0.01", "0.03", "-2", "5e-5", "250000"]);
    }

    #[test]
    fn colours_run_from_dark_to_light_and_take_anything() {
        let brightness = |c: RGBColor| u32::from(c.0) + u32::from(c.1) + u32::from(c.2);
        let steps: Vec<_> = (0..=10).map(|i| brightness(colour(f64::from(i), 10.0))).collect();
        assert!(steps.is_sorted(), "{steps:?}");
        assert_eq!(colour(f64::NAN, 1.0), colour(0.0, 1.0));
        assert_eq!(colour(3.0, 0.0), colour(0.0, 1.0));
    }
}
