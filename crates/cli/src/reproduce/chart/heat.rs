//! Heat maps: a value for each cell of a grid, in one or several panels with one bar of colours.

use super::colours::{Colours, ROOM};
use super::sheet::{GRID, Lettering, NORMAL, Point, SMALL, Sheet, TITLE, sheet};
use crate::picture::DrawError;
use crate::picture::canvas::INK;
use percute_workflow::message::short;

/// Size of a grid, for one, two and three columns (pixels).
const PLOTS: [[f64; 2]; 3] = [[560.0, 340.0], [300.0, 220.0], [195.0, 165.0]];
/// Room left of, above and below a grid, and beside all (pixels).
const LEFT: f64 = 58.0;
const ABOVE: f64 = 30.0;
const BELOW: f64 = 50.0;
const MARGIN: f64 = 16.0;
/// The least size of a cell in which its value is written (pixels).
const WRITTEN: [f64; 2] = [27.0, 14.0];

/// Heat maps in panels, on one grid.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMaps {
    /// Name and unit along the horizontal side, and the text of each column.
    pub x: (String, Vec<String>),
    /// Name and unit along the vertical side, and the text of each row, from below.
    pub y: (String, Vec<String>),
    /// The panels, row by row.
    pub maps: Vec<HeatMap>,
    /// Panels beside each other, 1 to 3.
    pub columns: usize,
    /// Colours of all panels.
    pub colours: Colours,
}

/// One map.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// What stands above it.
    pub title: String,
    /// A value for each cell, row by row from below; NaN where there is none.
    pub values: Vec<f64>,
}

impl HeatMaps {
    /// Draws the panels.
    ///
    /// # Errors
    /// What the drawing library reports.
    pub fn svg(&self) -> Result<String, DrawError> {
        let columns = self.columns.clamp(1, PLOTS.len());
        let size = PLOTS[columns - 1];
        let rows = self.maps.len().div_ceil(columns);
        let cell = [LEFT + size[0], ABOVE + size[1] + BELOW];
        let width = columns as f64 * cell[0] + 24.0 + ROOM + 2.0 * MARGIN;
        let height = rows as f64 * cell[1] + MARGIN;
        sheet([width, height], |sheet| {
            for (k, map) in self.maps.iter().enumerate() {
                let [column, row] = [k % columns, k / columns].map(|i| i as f64);
                let corner = [MARGIN + column * cell[0] + LEFT, 0.5 * MARGIN + row * cell[1] + ABOVE];
                self.draw_map(sheet, map, corner, size)?;
            }
            let bar = [MARGIN + columns as f64 * cell[0] + 24.0, 0.5 * MARGIN + ABOVE];
            self.colours.draw(sheet, bar, (height - BELOW - ABOVE - MARGIN).min(1.4 * size[1]))
        })
    }

    fn draw_map(&self, sheet: &Sheet<'_, '_>, map: &HeatMap, corner: Point, size: [f64; 2]) -> Result<(), DrawError> {
        let [nx, ny] = [self.x.1.len().max(1), self.y.1.len().max(1)];
        let [left, top] = corner;
        let [w, h] = [size[0] / nx as f64, size[1] / ny as f64];
        sheet.rectangle([corner, [left + size[0], top + size[1]]], GRID, 1.0)?;
        for (k, &value) in map.values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let [x, y] = [left + w * (k % nx) as f64, top + h * (ny - 1 - (k / nx).min(ny - 1)) as f64];
            sheet.rectangle([[x, y], [x + w, y + h]], self.colours.of(value), 1.0)?;
            if w >= WRITTEN[0] && h >= WRITTEN[1] {
                let letters = Lettering::new(SMALL.min(0.34 * w), self.colours.ink(value)).centred();
                sheet.text([x + 0.5 * w, y + 0.5 * h], &short(value, 2).replace('-', "−"), letters)?;
            }
        }
        sheet.text([left, top - 13.0], &map.title, Lettering::new(TITLE, INK).bold())?;
        self.draw_axes(sheet, corner, size)
    }

    fn draw_axes(&self, sheet: &Sheet<'_, '_>, [left, top]: Point, size: [f64; 2]) -> Result<(), DrawError> {
        let letters = Lettering::new(SMALL, INK);
        let w = size[0] / self.x.1.len().max(1) as f64;
        let widest = self.x.1.iter().map(|text| letters.width(text)).fold(0.0, f64::max);
        // Where there is no room for all, every second or third is written.
        let every = ((widest + 4.0) / w).ceil().max(1.0) as usize;
        for (k, text) in self.x.1.iter().enumerate().step_by(every) {
            sheet.text([left + w * (k as f64 + 0.5), top + size[1] + 13.0], text, letters.centred())?;
        }
        let h = size[1] / self.y.1.len().max(1) as f64;
        let every = (13.0 / h).ceil().max(1.0) as usize;
        for (k, text) in self.y.1.iter().enumerate().step_by(every) {
            sheet.text([left - 7.0, top + size[1] - h * (k as f64 + 0.5)], text, letters.ending())?;
        }
        let below = [left + 0.5 * size[0], top + size[1] + 32.0];
        sheet.text(below, &self.x.0, Lettering::new(NORMAL, INK).centred())?;
        let beside = [left - LEFT + 14.0, top + 0.5 * size[1]];
        sheet.text(beside, &self.y.0, Lettering::new(NORMAL, INK).upwards())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn maps(columns: usize, count: usize) -> HeatMaps {
        let map = |k: usize| HeatMap {
            title: format!("map {k}"),
            values: (0..12).map(|i| if i == 5 { f64::NAN } else { 0.3 * 1.2_f64.powi(i + k as i32) }).collect(),
        };
        HeatMaps {
            x: ("elements".to_string(), ["10", "20", "50", "100"].map(String::from).to_vec()),
            y: ("Δt/Δt_c".to_string(), ["0.5", "0.7", "0.9"].map(String::from).to_vec()),
            maps: (0..count).map(map).collect(),
            columns,
            colours: Colours::around_one("effectivity", 4.0),
        }
    }

    #[test]
    fn each_cell_has_its_value_and_a_missing_one_none() {
        let svg = maps(1, 1).svg().unwrap();
        let values: Vec<&str> =
            svg.split("</text>").filter_map(|piece| piece.rsplit(">\n").next()).map(str::trim).collect();
        // 0.3 · 1.2⁴ = 0.622…, 0.3 · 1.2⁵ is left out, 0.3 · 1.2⁶ = 0.895….
        assert!(values.contains(&"0.62") && !values.contains(&"0.75") && values.contains(&"0.90"), "{values:?}");
        // Ground, grid behind the map, 11 cells, and the shades of the bar.
        assert_eq!(svg.matches("<rect ").count(), 2 + 11 + 96);
    }

    #[test]
    fn maps_stand_in_rows_and_columns() {
        let width = |columns| {
            let svg = maps(columns, 6).svg().unwrap();
            svg.split("width=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap()
        };
        assert!(width(1) < width(2) && width(2) < 1000.0 && width(3) < 1000.0);
    }
}
