//! Charts: quantities over time, pressure along the surface over time, convergence.

mod convergence;
mod over_time;
mod space_time;
mod surface;

pub use convergence::convergence;
pub(crate) use over_time::{Line, OverTime};
pub(crate) use space_time::space_time;
pub use surface::Surface;

use crate::axes::Plot;
use crate::scale::Scale;
use crate::svg::{Anchor, Svg};

/// Size of a chart, and room around its plot: left, top, right, below (pixels).
const SIZE: [f64; 2] = [720.0, 308.0];
const ROOM: [f64; 4] = [76.0, 42.0, 20.0, 50.0];

/// Mean width of a letter of a legend, length of a sample (pixels).
const LETTER: f64 = 6.9;
const SAMPLE: f64 = 26.0;

/// The plot of a chart of the usual size.
fn plot(x: Scale, y: Scale) -> Plot {
    let [left, top, right, below] = ROOM;
    Plot { corner: [left, top], size: [SIZE[0] - left - right, SIZE[1] - top - below], x, y }
}

/// Draws names beside samples of their lines, in a row above the plot; `top` is that of its room.
fn legend(svg: &mut Svg, top: f64, names: &[&str]) {
    let mut x = ROOM[0];
    for (k, name) in names.iter().enumerate() {
        svg.line(&format!("s{k}"), [x, top + 12.0], [x + SAMPLE, top + 12.0]);
        svg.text("label", [x + SAMPLE + 6.0, top + 16.5], Anchor::Start, false, name);
        x += SAMPLE + 6.0 + LETTER * name.chars().count() as f64 + 18.0;
    }
}
