//! Curves in one or several panels with the same axes and one legend.

use super::axis::{Axis, Scale};
use super::legend::{Legend, Look};
use super::sheet::{GRID, Lettering, NORMAL, Point, SMALL, Sheet, TITLE, sheet};
use crate::picture::DrawError;
use crate::picture::canvas::{FAINT, INK};
use plotters::style::RGBColor;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};

/// Size of a plot, for one, two and three columns (pixels).
const PLOTS: [[f64; 2]; 3] = [[640.0, 330.0], [345.0, 240.0], [212.0, 190.0]];
/// Room left of, above and below a plot, and beside all (pixels).
const LEFT: f64 = 66.0;
const ABOVE: f64 = 30.0;
const BELOW: f64 = 46.0;
const MARGIN: f64 = 16.0;
/// Room right of a plot (pixels).
const RIGHT: f64 = 18.0;
/// Colours of curves, told apart on white and on black.
const PALETTE: [RGBColor; 9] = [
    RGBColor(47, 121, 200),
    RGBColor(218, 98, 40),
    RGBColor(36, 150, 110),
    RGBColor(155, 85, 190),
    RGBColor(200, 60, 100),
    RGBColor(150, 125, 30),
    RGBColor(20, 150, 175),
    RGBColor(130, 135, 145),
    RGBColor(165, 100, 80),
];

/// Curves in panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// The horizontal axis of all panels.
    pub x: Axis,
    /// The vertical axis of all panels.
    pub y: Axis,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
    /// Panels beside each other, 1 to 3.
    pub columns: usize,
    /// Ranges that are marked in all panels.
    pub bands: Vec<Band>,
}

/// One plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// Its curves.
    pub series: Vec<Series>,
}

/// A range along the vertical axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// From.
    pub low: f64,
    /// To.
    pub high: f64,
}

/// A curve. Those of one name have one entry in the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    name: String,
    points: Vec<[f64; 2]>,
    hue: Hue,
    dashed: bool,
    marked: bool,
}

/// The colour of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hue {
    /// One of eight that are told apart.
    Own(usize),
    /// One of an ordered family, from 0 (dark) to 1 (light).
    Ordered(f64),
    /// That of text, for what is compared with.
    Ink,
}

impl Series {
    /// A curve through points; it is broken where one is not finite.
    #[must_use]
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>, hue: Hue) -> Self {
        Self { name: name.into(), points, hue, dashed: false, marked: false }
    }

    /// With a dot at each point.
    #[must_use]
    pub fn marked(self) -> Self {
        Self { marked: true, ..self }
    }

    /// Dashed.
    #[must_use]
    pub fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    fn look(&self) -> Look {
        Look { name: self.name.clone(), colour: self.hue.colour(), dashed: self.dashed, marked: self.marked }
    }
}

impl Hue {
    fn colour(self) -> RGBColor {
        match self {
            Self::Own(index) => PALETTE[index % PALETTE.len()],
            // Neither so dark nor so light that a ground hides it.
            Self::Ordered(place) => ViridisRGB.get_color(0.28 + 0.54 * place.clamp(0.0, 1.0)),
            Self::Ink => INK,
        }
    }
}

/// A plot's place on the sheet, with its scales.
struct Plot<'a> {
    corner: Point,
    size: [f64; 2],
    x: &'a Scale,
    y: &'a Scale,
}

impl Plot<'_> {
    fn point(&self, [x, y]: [f64; 2]) -> Point {
        [self.at_x(x), self.at_y(y)]
    }

    fn at_x(&self, x: f64) -> f64 {
        self.corner[0] + self.size[0] * self.x.place(x)
    }

    fn at_y(&self, y: f64) -> f64 {
        self.corner[1] + self.size[1] * (1.0 - self.y.place(y))
    }
}

impl Lines {
    /// Draws the panels.
    ///
    /// # Errors
    /// What the drawing library reports.
    pub fn svg(&self) -> Result<String, DrawError> {
        let columns = self.columns.clamp(1, PLOTS.len());
        let size = PLOTS[columns - 1];
        let points = || self.panels.iter().flat_map(|panel| &panel.series).flat_map(|series| &series.points);
        let x = self.x.scale(points().map(|point| point[0]), false, if columns == 1 { 8 } else { 5 });
        let bands = self.bands.iter().flat_map(|band| [band.low, band.high]);
        let y = self.y.scale(points().map(|point| point[1]).chain(bands), true, 6);
        let rows = self.panels.len().div_ceil(columns);
        let cell = [LEFT + size[0] + RIGHT, ABOVE + size[1] + BELOW];
        let width = columns as f64 * cell[0] + 2.0 * MARGIN;
        let looks = self.panels.iter().flat_map(|panel| panel.series.iter().map(Series::look));
        let legend = Legend::new(looks, width - LEFT - 2.0 * MARGIN);
        let height = rows as f64 * cell[1] + legend.height + 1.5 * MARGIN;
        sheet([width, height], |sheet| {
            for (k, panel) in self.panels.iter().enumerate() {
                let [column, row] = [k % columns, k / columns].map(|i| i as f64);
                let corner = [MARGIN + column * cell[0] + LEFT, 0.5 * MARGIN + row * cell[1] + ABOVE];
                self.draw_panel(sheet, panel, &Plot { corner, size, x: &x, y: &y })?;
            }
            legend.draw(sheet, [MARGIN + LEFT, height - legend.height - 0.5 * MARGIN])
        })
    }

    fn draw_panel(&self, sheet: &Sheet<'_, '_>, panel: &Panel, plot: &Plot<'_>) -> Result<(), DrawError> {
        let ([left, top], [width, _]) = (plot.corner, plot.size);
        for band in &self.bands {
            let corners = [[left, plot.at_y(band.high)], [left + width, plot.at_y(band.low)]];
            sheet.rectangle(corners, PALETTE[2], 0.14)?;
        }
        self.draw_axes(sheet, plot)?;
        sheet.text([left, top - 13.0], &panel.title, Lettering::new(TITLE, INK).bold())?;
        panel.series.iter().try_for_each(|series| draw_series(sheet, series, plot))
    }

    fn draw_axes(&self, sheet: &Sheet<'_, '_>, plot: &Plot<'_>) -> Result<(), DrawError> {
        let ([left, top], [width, height]) = (plot.corner, plot.size);
        let bottom = top + height;
        for (mark, text) in plot.y.marks() {
            let y = plot.at_y(mark);
            sheet.path(&[[left, y], [left + width, y]], 1.0, GRID)?;
            sheet.text([left - 7.0, y], &text, Lettering::new(SMALL, INK).ending())?;
        }
        for (mark, text) in plot.x.marks() {
            let x = plot.at_x(mark);
            sheet.path(&[[x, top], [x, bottom]], 1.0, GRID)?;
            sheet.text([x, bottom + 13.0], &text, Lettering::new(SMALL, INK).centred())?;
        }
        sheet.path(&[[left, top], [left, bottom], [left + width, bottom]], 1.2, FAINT)?;
        let below = [left + 0.5 * width, bottom + 32.0];
        sheet.text(below, self.x.label(), Lettering::new(NORMAL, INK).centred())?;
        let beside = [left - LEFT + 14.0, top + 0.5 * height];
        sheet.text(beside, self.y.label(), Lettering::new(NORMAL, INK).upwards())
    }
}

fn draw_series(sheet: &Sheet<'_, '_>, series: &Series, plot: &Plot<'_>) -> Result<(), DrawError> {
    let places: Vec<Point> = series.points.iter().map(|&point| plot.point(point)).collect();
    let drawn = |place: &Point| place.iter().all(|x| x.is_finite());
    for run in places.split(|place| !drawn(place)).filter(|run| run.len() > 1) {
        if series.dashed {
            sheet.dashes(run, 1.8, series.hue.colour())?;
        } else {
            sheet.path(run, 1.8, series.hue.colour())?;
        }
    }
    let marked = places.iter().filter(|place| series.marked && drawn(place));
    marked.into_iter().try_for_each(|&place| sheet.dot(place, 3.2, series.hue.colour()))
}
