//! Colours of values, and their bar.

use super::axis::{Axis, Scale};
use super::sheet::{Lettering, Point, SMALL, Sheet};
use crate::picture::DrawError;
use crate::picture::canvas::INK;
use plotters::style::RGBColor;
use plotters::style::colors::colormaps::{ColorMap, ViridisRGB};

/// Steps of a bar of colours.
const SHADES: usize = 96;
/// Width of the bar and of all that stands beside it (pixels).
const BAR: f64 = 14.0;
pub(super) const ROOM: f64 = 70.0;
/// From below through the middle to above.
const AROUND: [[f64; 3]; 5] =
    [[33.0, 75.0, 140.0], [120.0, 170.0, 215.0], [240.0, 238.0, 226.0], [236.0, 150.0, 90.0], [160.0, 40.0, 35.0]];

/// Which colour a value has.
#[derive(Clone, Debug, PartialEq)]
pub struct Colours {
    axis: Axis,
    low: f64,
    high: f64,
    around: bool,
}

impl Colours {
    /// From dark to light between two values, in equal steps; the label has name and unit.
    #[must_use]
    pub fn between(label: impl Into<String>, low: f64, high: f64) -> Self {
        // A scale needs some length.
        let high = if high > low { high } else { low + 1.0 };
        Self { axis: Axis::linear(label).from(low).to(high), low, high, around: false }
    }

    /// From dark to light between two positive values, in equal ratios.
    #[must_use]
    pub fn ratio(label: impl Into<String>, low: f64, high: f64) -> Self {
        let high = if high > low { high } else { 2.0 * low };
        Self { axis: Axis::log(label).from(low).to(high), low, high, around: false }
    }

    /// Blue below 1, pale at 1, red above, in equal ratios from 1/`factor` to `factor`: for effectivities.
    #[must_use]
    pub fn around_one(label: impl Into<String>, factor: f64) -> Self {
        let axis = Axis::log(label).from(1.0 / factor).to(factor);
        Self { axis, low: 1.0 / factor, high: factor, around: true }
    }

    fn scale(&self) -> Scale {
        self.axis.scale([self.low, self.high].into_iter(), false, 6)
    }

    /// The colour of a value; what is outside takes that of the end.
    pub(super) fn of(&self, value: f64) -> RGBColor {
        let place = self.scale().place(value);
        let place = if place.is_finite() { place.clamp(0.0, 1.0) } else { 0.0 };
        if !self.around {
            return ViridisRGB.get_color(place);
        }
        let at = place * (AROUND.len() - 1) as f64;
        let k = (at.floor() as usize).min(AROUND.len() - 2);
        let mixed = [0, 1, 2].map(|c| AROUND[k][c] + (at - k as f64) * (AROUND[k + 1][c] - AROUND[k][c]));
        RGBColor(mixed[0].round() as u8, mixed[1].round() as u8, mixed[2].round() as u8)
    }

    /// A colour for text on a value: black or white, neither of which the page turns around.
    pub(super) fn ink(&self, value: f64) -> RGBColor {
        let RGBColor(r, g, b) = self.of(value);
        let bright = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
        if bright > 140.0 { RGBColor(20, 20, 22) } else { RGBColor(252, 252, 252) }
    }

    /// Draws the bar with its numbers and its label in a column of [`ROOM`] pixels.
    pub(super) fn draw(&self, sheet: &Sheet<'_, '_>, [left, top]: Point, height: f64) -> Result<(), DrawError> {
        let scale = self.scale();
        for shade in 0..SHADES {
            let [low, high] = [0, 1].map(|end| (shade + end) as f64 / SHADES as f64);
            let value = scale.value(0.5 * (low + high));
            let at = |fraction: f64| top + height * (1.0 - fraction);
            sheet.rectangle([[left, at(high)], [left + BAR, at(low)]], self.of(value), 1.0)?;
        }
        for (mark, text) in scale.marks() {
            let y = top + height * (1.0 - scale.place(mark));
            sheet.path(&[[left + BAR, y], [left + BAR + 4.0, y]], 1.0, INK)?;
            sheet.text([left + BAR + 7.0, y], &text, Lettering::new(SMALL, INK))?;
        }
        let side = [left + ROOM - 8.0, top + 0.5 * height];
        sheet.text(side, self.axis.label(), Lettering::new(SMALL, INK).upwards())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_pale_and_the_ends_are_not() {
        let colours = Colours::around_one("e", 4.0);
        assert_eq!(colours.of(1.0), RGBColor(240, 238, 226));
        assert_eq!((colours.of(0.25), colours.of(9.0)), (RGBColor(33, 75, 140), RGBColor(160, 40, 35)));
        assert_eq!(colours.of(f64::NAN), colours.of(0.0));
        // Mirror images on a scale of ratios.
        let bluer = |c: RGBColor| i32::from(c.2) - i32::from(c.0);
        assert!(bluer(colours.of(0.5)) > 0 && bluer(colours.of(2.0)) < 0);
    }
}
