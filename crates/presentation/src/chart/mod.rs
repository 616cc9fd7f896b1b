//! Charts: quantities over time, pressure along the surface over time, convergence, adaptation.

mod adaptation;
mod convergence;
mod envelope;
mod over_time;
mod space_time;
mod surface;

pub use adaptation::adaptation;
pub use convergence::convergence;
pub(crate) use over_time::{Line, OverTime};
pub(crate) use space_time::space_time;
pub use surface::Surface;

use crate::svg::{Anchor, Svg};

/// Size of a chart, and room around its plot: left, top, right, below (pixels).
const SIZE: [f64; 2] = [720.0, 308.0];
const ROOM: [f64; 4] = [76.0, 42.0, 20.0, 50.0];

/// Mean width of a letter of a legend, length of a sample, height of a row (pixels).
const LETTER: f64 = 6.9;
const SAMPLE: f64 = 26.0;
const ROW: f64 = 20.0;

/// A legend above a plot: names beside samples of their lines, in as many rows as they need.
struct Legend<'a> {
    /// Each name and its place.
    names: Vec<(&'a str, [f64; 2])>,
}

impl<'a> Legend<'a> {
    fn new(names: impl Iterator<Item = &'a str>) -> Self {
        let [mut x, mut y] = [ROOM[0], 0.0];
        let place = |name: &'a str| {
            let width = SAMPLE + 6.0 + LETTER * name.chars().count() as f64;
            if x > ROOM[0] && x + width > SIZE[0] - ROOM[2] {
                [x, y] = [ROOM[0], y + ROW];
            }
            let at = [x, y];
            x += width + 18.0;
            (name, at)
        };
        Self { names: names.map(place).collect() }
    }

    /// Height of the rows after the first (pixels).
    fn further(&self) -> f64 {
        self.names.last().map_or(0.0, |(_, [_, y])| *y)
    }

    fn draw(&self, svg: &mut Svg) {
        for (k, (name, [x, y])) in self.names.iter().enumerate() {
            svg.line(&format!("s{k}"), [*x, y + 12.0], [x + SAMPLE, y + 12.0]);
            svg.text("label", [x + SAMPLE + 6.0, y + 16.5], Anchor::Start, false, name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_legend_has_rows() {
        let names = ["all contacts", "plane 0", "lower.top and middle.bottom", "middle.top and upper.bottom"];
        let legend = Legend::new(names.into_iter());
        assert_eq!((legend.further(), Legend::new(names.into_iter().take(3)).further()), (ROW, 0.0));
        for (name, [x, _]) in legend.names {
            assert!(x + SAMPLE + LETTER * name.len() as f64 <= SIZE[0], "{name} at {x}");
        }
    }
}
