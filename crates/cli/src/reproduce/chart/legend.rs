//! A legend of curves, in rows.

use super::sheet::{Lettering, Point, SMALL, Sheet};
use crate::picture::DrawError;
use crate::picture::canvas::INK;
use plotters::style::RGBColor;

/// Length of the sample of a curve, distance between two entries, height of a row (pixels).
const SAMPLE: f64 = 24.0;
const GAP: f64 = 18.0;
const ROW: f64 = 19.0;

/// What a curve looks like.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) name: String,
    pub(super) colour: RGBColor,
    pub(super) dashed: bool,
    pub(super) marked: bool,
}

/// Entries with their places, which may be drawn later.
pub(super) struct Legend {
    entries: Vec<(Look, Point)>,
    /// Height that it needs (pixels).
    pub(super) height: f64,
}

impl Legend {
    /// Arranges the looks of different names within a width (pixels).
    pub(super) fn new(looks: impl Iterator<Item = Look>, width: f64) -> Self {
        let mut entries: Vec<(Look, Point)> = Vec::new();
        let mut at = [0.0, 0.0];
        for look in looks {
            if look.name.is_empty() || entries.iter().any(|(other, _)| other.name == look.name) {
                continue;
            }
            let needed = SAMPLE + 6.0 + Lettering::new(SMALL, INK).width(&look.name);
            if at[0] > 0.0 && at[0] + needed > width {
                at = [0.0, at[1] + ROW];
            }
            let place = at;
            at[0] += needed + GAP;
            entries.push((look, place));
        }
        let height = if entries.is_empty() { 0.0 } else { at[1] + ROW };
        Self { entries, height }
    }

    /// Draws it with its upper left corner at a point.
    pub(super) fn draw(&self, sheet: &Sheet<'_, '_>, corner: Point) -> Result<(), DrawError> {
        for (look, at) in &self.entries {
            let [x, y] = [corner[0] + at[0], corner[1] + at[1] + 0.5 * ROW];
            let line = [[x, y], [x + SAMPLE, y]];
            if look.dashed {
                sheet.dashes(&line, 2.0, look.colour)?;
            } else {
                sheet.path(&line, 2.0, look.colour)?;
            }
            if look.marked {
                sheet.dot([x + 0.5 * SAMPLE, y], 3.2, look.colour)?;
            }
            sheet.text([x + SAMPLE + 6.0, y], &look.name, Lettering::new(SMALL, INK))?;
        }
        Ok(())
    }
}
