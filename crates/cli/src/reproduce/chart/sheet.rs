//! What charts are drawn on: plotters' drawing area, in pixels.

use crate::picture::DrawError;
use crate::picture::canvas::{UNITS, document, px};
use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::element::{Circle, DashedPathElement, PathElement, Polygon, Rectangle};
use plotters::prelude::{DrawingArea, IntoDrawingArea, IntoFont, RGBColor, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontStyle, FontTransform};

/// The ground, which the page makes dark on dark screens.
pub(super) const GROUND: RGBColor = RGBColor(255, 255, 255);
/// Lines of the grid, and what is behind heat maps; the page knows it too.
pub(super) const GRID: RGBColor = RGBColor(225, 226, 232);
/// Sizes of text (pixels).
pub(super) const SMALL: f64 = 11.0;
pub(super) const NORMAL: f64 = 12.5;
pub(super) const TITLE: f64 = 13.5;
/// Width of an average character, as a part of its size; rather too much.
const CHARACTER: f64 = 0.58;
/// The drawing library makes text smaller than it is told to.
const SHRINK: f64 = 1.24;

/// A point (pixels from the upper left corner).
pub(super) type Point = [f64; 2];

/// How a text stands at its point.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    pub(super) size: f64,
    pub(super) colour: RGBColor,
    pub(super) side: HPos,
    pub(super) height: VPos,
    pub(super) bold: bool,
    pub(super) upwards: bool,
}

impl Lettering {
    /// Text of this size and colour that begins at its point.
    pub(super) fn new(size: f64, colour: RGBColor) -> Self {
        Self { size, colour, side: HPos::Left, height: VPos::Center, bold: false, upwards: false }
    }

    pub(super) fn centred(self) -> Self {
        Self { side: HPos::Center, ..self }
    }

    pub(super) fn ending(self) -> Self {
        Self { side: HPos::Right, ..self }
    }

    pub(super) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub(super) fn upwards(self) -> Self {
        Self { upwards: true, ..self.centred() }
    }

    /// Width that a text needs at most (pixels).
    pub(super) fn width(&self, text: &str) -> f64 {
        CHARACTER * self.size * text.chars().count() as f64
    }
}

/// A sheet to draw on.
pub(super) struct Sheet<'a, 'b> {
    area: &'a DrawingArea<SVGBackend<'b>, Shift>,
}

/// Draws a sheet of this size in pixels and returns its document.
pub(super) fn sheet(
    [width, height]: [f64; 2],
    body: impl FnOnce(&Sheet<'_, '_>) -> Result<(), DrawError>,
) -> Result<String, DrawError> {
    let mut svg = String::new();
    let pixels = (width.round() as i32, height.round() as i32);
    let size = (px(f64::from(pixels.0)), px(f64::from(pixels.1)));
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&GROUND).map_err(DrawError::from_library)?;
        body(&Sheet { area: &area })?;
        area.present().map_err(DrawError::from_library)?;
    }
    Ok(document(&svg, size, pixels))
}

/// A point in units of the drawing.
fn units(point: &Point) -> (i32, i32) {
    let unit = |x: f64| (x * f64::from(UNITS)).round() as i32;
    (unit(point[0]), unit(point[1]))
}

impl Sheet<'_, '_> {
    /// A line through some points.
    pub(super) fn path(&self, points: &[Point], width: f64, colour: RGBColor) -> Result<(), DrawError> {
        let points: Vec<_> = points.iter().map(units).collect();
        self.area.draw(&PathElement::new(points, colour.stroke_width(px(width)))).map_err(DrawError::from_library)
    }

    /// A dashed line through some points.
    pub(super) fn dashes(&self, points: &[Point], width: f64, colour: RGBColor) -> Result<(), DrawError> {
        let points = points.iter().map(units);
        let line = DashedPathElement::new(points, px(5.0), px(4.0), colour.stroke_width(px(width)));
        self.area.draw(&line).map_err(DrawError::from_library)
    }

    /// A filled polygon.
    pub(super) fn polygon(&self, points: &[Point], colour: RGBColor) -> Result<(), DrawError> {
        let points: Vec<_> = points.iter().map(units).collect();
        self.area.draw(&Polygon::new(points, colour.filled())).map_err(DrawError::from_library)
    }

    /// A filled rectangle.
    pub(super) fn rectangle(&self, corners: [Point; 2], colour: RGBColor, opacity: f64) -> Result<(), DrawError> {
        let filled = colour.mix(opacity).filled();
        self.area.draw(&Rectangle::new(corners.map(|p| units(&p)), filled)).map_err(DrawError::from_library)
    }

    /// A filled circle.
    pub(super) fn dot(&self, centre: Point, radius: f64, colour: RGBColor) -> Result<(), DrawError> {
        self.area.draw(&Circle::new(units(&centre), px(radius), colour.filled())).map_err(DrawError::from_library)
    }

    /// A text.
    pub(super) fn text(&self, at: Point, text: &str, letters: Lettering) -> Result<(), DrawError> {
        let font = ("sans-serif", f64::from(px(letters.size)) * SHRINK).into_font();
        let font = if letters.bold { font.style(FontStyle::Bold) } else { font };
        let font = if letters.upwards { font.transform(FontTransform::Rotate270) } else { font };
        let style = TextStyle::from(font).pos(Pos::new(letters.side, letters.height)).color(&letters.colour);
        self.area.draw_text(text, &style, units(&at)).map_err(DrawError::from_library)
    }
}
