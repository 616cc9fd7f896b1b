//! A plot with axes.

use crate::scale::{Scale, tick, viridis};
use crate::svg::{Anchor, Svg};

/// Length of the marks at the axes (pixels).
const MARK: f64 = 5.0;

/// A rectangle of a picture with two scales.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plot {
    /// Upper left corner (pixels).
    pub(crate) corner: [f64; 2],
    /// Width and height (pixels).
    pub(crate) size: [f64; 2],
    pub(crate) x: Scale,
    pub(crate) y: Scale,
}

/// The look of the axes.
pub(crate) struct Look<'a> {
    pub(crate) x: &'a str,
    pub(crate) y: &'a str,
    /// Numbers of marks.
    pub(crate) marks: [usize; 2],
    /// Whether y has marks at whole numbers only.
    pub(crate) whole: bool,
    /// Whether lines cross the plot at the marks of y, and of x.
    pub(crate) grid: [bool; 2],
}

impl Plot {
    /// The place of a value (pixels).
    pub(crate) fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let [left, top] = self.corner;
        [left + self.x.fraction(x) * self.size[0], top + (1.0 - self.y.fraction(y)) * self.size[1]]
    }

    /// Draws axes on the left and below.
    pub(crate) fn axes(&self, svg: &mut Svg, look: &Look<'_>) {
        let ([left, top], [width, height]) = (self.corner, self.size);
        let (right, bottom) = (left + width, top + height);
        for x in self.x.ticks(look.marks[0]) {
            let [at, _] = self.at(x, self.y.low);
            if look.grid[1] {
                svg.line("grid", [at, top], [at, bottom]);
            }
            svg.line("axis", [at, bottom], [at, bottom + MARK]);
            svg.text("label", [at, bottom + MARK + 13.0], Anchor::Middle, false, &tick(x));
        }
        for y in self.y.ticks(look.marks[1]).into_iter().filter(|y| !look.whole || y.fract() == 0.0) {
            let [_, at] = self.at(self.x.low, y);
            if look.grid[0] {
                svg.line("grid", [left, at], [right, at]);
            }
            svg.line("axis", [left - MARK, at], [left, at]);
            svg.text("label", [left - MARK - 4.0, at + 4.5], Anchor::End, false, &tick(y));
        }
        svg.line("axis", [left, bottom], [right, bottom]);
        svg.line("axis", [left, top], [left, bottom]);
        svg.text("label", [left + 0.5 * width, bottom + 38.0], Anchor::Middle, false, look.x);
        svg.text("label", [left - 52.0, top + 0.5 * height], Anchor::Middle, true, look.y);
    }
}

/// Draws a bar of colours with marks on its right; `less` says that values below a logarithmic scale have its lowest
/// colour.
pub(crate) fn colour_bar(svg: &mut Svg, corner: [f64; 2], size: [f64; 2], scale: &Scale, (label, less): (&str, bool)) {
    const SHADES: usize = 64;
    let ([left, top], [width, height]) = (corner, size);
    let place = |fraction: f64| top + (1.0 - fraction) * height;
    svg.begin("class=\"mesh\"");
    for i in 0..SHADES {
        let [low, high] = [i, i + 1].map(|k| k as f64 / SHADES as f64);
        let [a, b] = [place(low), place(high)];
        let right = left + width;
        svg.polygon(viridis(0.5 * (low + high)), [[left, a], [right, a], [right, b], [left, b]]);
    }
    svg.end();
    let mut mark = |at: f64, text: &str| {
        svg.line("axis", [left + width, at], [left + width + MARK, at]);
        svg.text("label", [left + width + MARK + 4.0, at + 4.5], Anchor::Start, false, text);
    };
    for (value, label) in scale.marks((height / 40.0) as usize, less) {
        mark(place(scale.fraction(value)), &label);
    }
    let kind = if scale.logarithmic { ", logarithmic" } else { "" };
    svg.text("label", [left + width + 80.0, top + 0.5 * height], Anchor::Middle, true, &format!("{label}{kind}"));
}
