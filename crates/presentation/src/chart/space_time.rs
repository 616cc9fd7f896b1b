//! Pressure along the surface over time.

use super::{SIZE, Surface};
use crate::axes::{Look, Plot, colour_bar};
use crate::png::{DrawError, raster};
use crate::scale::{Scale, prefixed, viridis};
use crate::svg::Svg;

/// Room around the plot: left, top, right with the colours, below (pixels).
const ROOM: [f64; 4] = [76.0, 14.0, 128.0, 50.0];
/// Rows of pixels along the surface.
const ROWS: usize = 240;

/// Draws the pressure over time and position along the surface; without pressure, nothing is drawn.
pub(crate) fn space_time(surface: &Surface) -> Result<Svg, DrawError> {
    let most = surface.pressure.iter().flatten().copied().fold(0.0, f64::max);
    let (to_pascal, pascal) = prefixed("Pa", most);
    let length = surface.places.last().copied().unwrap_or(1.0);
    let ((to_metre, metre), (to_second, second)) = (prefixed("m", length), prefixed("s", surface.time[1]));
    let [left, top, right, below] = ROOM;
    let plot = Plot {
        corner: [left, top],
        size: [SIZE[0] - left - right, SIZE[1] - top - below],
        x: Scale::linear(surface.time[0] * to_second, surface.time[1] * to_second),
        y: Scale::linear(0.0, length * to_metre),
    };
    let mut svg = Svg::new(SIZE);
    let opposite = [0, 1].map(|c| plot.corner[c] + plot.size[c]);
    svg.image("cells", &raster(surface.pressure[0].len(), &rows(surface, most))?, plot.corner, opposite);
    let labels = (format!("t ({second})"), format!("along the surface ({metre})"));
    plot.axes(&mut svg, &Look { x: &labels.0, y: &labels.1, marks: [7, 5], whole: false, grid: [false; 2] });
    let bar = [opposite[0] + 20.0, top];
    let label = format!("pressure ({pascal})");
    colour_bar(&mut svg, bar, [16.0, plot.size[1]], &Scale::linear(0.0, most * to_pascal), (&label, false));
    Ok(svg)
}

/// Pixels from the far end of the surface to its start: each shows the nearest node.
fn rows(surface: &Surface, most: f64) -> Vec<Vec<Option<[u8; 3]>>> {
    let length = surface.places.last().copied().unwrap_or(1.0);
    let row = |k: usize| {
        let place = length * (1.0 - (k as f64 + 0.5) / ROWS as f64);
        let after = surface.places.partition_point(|&p| p < place).min(surface.places.len() - 1);
        let before = after.saturating_sub(1);
        let nearest = if place - surface.places[before] < surface.places[after] - place { before } else { after };
        surface.pressure[nearest].iter().map(|&p| (p > 0.0).then(|| viridis(p / most))).collect()
    };
    (0..ROWS).map(row).collect()
}
