//! Values on the elements of plane meshes, in panels of one scale with one bar of colours.

use super::colours::{Colours, ROOM};
use super::sheet::{GRID, Lettering, Point, SMALL, Sheet, TITLE, sheet};
use crate::picture::DrawError;
use crate::picture::canvas::{FAINT, INK};

/// Width of a map, for one, two and three columns (pixels).
const WIDTHS: [f64; 3] = [560.0, 360.0, 240.0];
/// A map is at most this much higher than wide.
const HIGHEST: f64 = 1.2;
/// Room above a map, between maps, and beside all (pixels).
const ABOVE: f64 = 26.0;
const BETWEEN: f64 = 16.0;
const MARGIN: f64 = 16.0;
/// Room for the length that shows the scale (pixels).
const BELOW: f64 = 34.0;
/// Room around the bodies, as a part of their width.
const AROUND: f64 = 0.04;

/// Maps in panels, all of the same part of space.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMaps {
    /// The panels, row by row.
    pub maps: Vec<MeshMap>,
    /// Panels beside each other, 1 to 3.
    pub columns: usize,
    /// Colours of all panels.
    pub colours: Colours,
    /// A plane that is drawn in all panels: a point (m) and the unit normal towards the body.
    pub plane: Option<[[f64; 2]; 2]>,
}

/// One map.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshMap {
    /// What stands above it.
    pub title: String,
    /// Where the nodes are (m).
    pub points: Vec<[f64; 2]>,
    /// The nodes of each triangle.
    pub cells: Vec<[usize; 3]>,
    /// A value for each triangle.
    pub values: Vec<f64>,
}

/// The part of space that is shown, and how large.
struct Window {
    low: [f64; 2],
    high: [f64; 2],
    scale: f64,
}

impl Window {
    fn size(&self) -> [f64; 2] {
        [0, 1].map(|c| self.scale * (self.high[c] - self.low[c]))
    }

    /// Where a point is, in a panel with this corner.
    fn place(&self, [left, top]: Point, point: [f64; 2]) -> Point {
        [left + self.scale * (point[0] - self.low[0]), top + self.scale * (self.high[1] - point[1])]
    }
}

impl MeshMaps {
    /// Draws the panels.
    ///
    /// # Errors
    /// What the drawing library reports.
    pub fn svg(&self) -> Result<String, DrawError> {
        let columns = self.columns.clamp(1, WIDTHS.len());
        let window = self.window(WIDTHS[columns - 1]);
        let size = window.size();
        let rows = self.maps.len().div_ceil(columns);
        let cell = [size[0] + BETWEEN, ABOVE + size[1] + BETWEEN];
        let width = columns as f64 * cell[0] + 10.0 + ROOM + 2.0 * MARGIN;
        let height = rows as f64 * cell[1] + BELOW + MARGIN;
        sheet([width, height], |sheet| {
            for (k, map) in self.maps.iter().enumerate() {
                let [column, row] = [k % columns, k / columns].map(|i| i as f64);
                let corner = [MARGIN + column * cell[0], 0.5 * MARGIN + row * cell[1] + ABOVE];
                self.draw_map(sheet, map, &window, corner)?;
            }
            let bar = [MARGIN + columns as f64 * cell[0] + 10.0, 0.5 * MARGIN + ABOVE];
            let tall = (rows as f64 * cell[1] - ABOVE - BETWEEN).clamp(150.0, 340.0);
            self.colours.draw(sheet, bar, tall)?;
            draw_length(sheet, &window, [MARGIN, height - BELOW])
        })
    }

    fn window(&self, width: f64) -> Window {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in self.maps.iter().flat_map(|map| &map.points) {
            for c in 0..2 {
                low[c] = low[c].min(point[c]);
                high[c] = high[c].max(point[c]);
            }
        }
        let room = AROUND * (high[0] - low[0]).max(high[1] - low[1]);
        let (low, high) = (low.map(|x| x - room), high.map(|x| x + room));
        let scale = (width / (high[0] - low[0])).min(HIGHEST * width / (high[1] - low[1]));
        Window { low, high, scale }
    }

    fn draw_map(&self, sheet: &Sheet<'_, '_>, map: &MeshMap, window: &Window, corner: Point) -> Result<(), DrawError> {
        let size = window.size();
        sheet.text([corner[0], corner[1] - 11.0], &map.title, Lettering::new(TITLE, INK).bold())?;
        if let Some(plane) = self.plane {
            draw_plane(sheet, plane, window, corner)?;
        }
        for (cell, &value) in map.cells.iter().zip(&map.values) {
            let corners = cell.map(|node| window.place(corner, map.points[node]));
            sheet.polygon(&corners, self.colours.of(value))?;
        }
        let [right, bottom] = [corner[0] + size[0], corner[1] + size[1]];
        sheet.path(&[corner, [right, corner[1]], [right, bottom], [corner[0], bottom], corner], 1.0, GRID)
    }
}

/// The far side of a plane, shaded, and its line; whole only for planes that cross the window from side to side.
fn draw_plane(
    sheet: &Sheet<'_, '_>,
    [point, normal]: [[f64; 2]; 2],
    window: &Window,
    corner: Point,
) -> Result<(), DrawError> {
    let height = |x: f64| point[1] - (x - point[0]) * normal[0] / normal[1];
    let inside = |y: f64| y.clamp(window.low[1], window.high[1]);
    let ends = [window.low[0], window.high[0]].map(|x| [x, inside(height(x))]);
    let below = [window.high[0], window.low[0]].map(|x| [x, window.low[1]]);
    let place = |p: [f64; 2]| window.place(corner, p);
    sheet.polygon(&[ends[0], ends[1], below[0], below[1]].map(place), GRID)?;
    sheet.path(&ends.map(place), 1.4, FAINT)
}

/// A length that shows the scale.
fn draw_length(sheet: &Sheet<'_, '_>, window: &Window, [left, top]: Point) -> Result<(), DrawError> {
    let wanted = 0.25 * (window.high[0] - window.low[0]);
    let power = 10_f64.powf(wanted.log10().floor());
    let length = [5.0, 2.0, 1.0].map(|f| f * power).into_iter().find(|&l| l <= wanted).unwrap_or(power);
    let y = top + 0.4 * BELOW;
    let right = left + window.scale * length;
    sheet.path(&[[left, y - 4.0], [left, y], [right, y], [right, y - 4.0]], 1.4, INK)?;
    let text = format!("{} mm", super::axis::text(1e3 * length));
    sheet.text([right + 8.0, y - 1.0], &text, Lettering::new(SMALL, INK))
}
