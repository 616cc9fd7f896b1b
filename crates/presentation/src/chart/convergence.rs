//! Errors over the size of the elements.

use super::{ROOM, SIZE, legend};
use crate::axes::{Look, Plot};
use crate::scale::{Scale, prefixed};
use crate::svg::Svg;

/// A run of a series on finer and finer meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Size of the elements (m).
    pub size: f64,
    /// Estimated error (J^½).
    pub estimate: f64,
    /// True error (J^½), if it is known.
    pub error: Option<f64>,
}

/// Estimated and true error over the size of the elements, and below them their quotient, the effectivity index, on
/// logarithmic axes, as an SVG document. None without two sizes or without a positive error.
#[must_use]
pub fn convergence(levels: &[Level]) -> Option<String> {
    let sizes = || levels.iter().map(|level| level.size).filter(|size| *size > 0.0);
    let (least, most) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    let errors: Vec<f64> = levels.iter().flat_map(|l| [Some(l.estimate), l.error]).flatten().collect();
    let y = around(&errors, 1.25)?;
    if least >= most {
        return None;
    }
    let (factor, unit) = prefixed("m", most);
    let x = Scale::logarithmic(least * factor / 1.15, most * factor * 1.15);
    let mut svg = Svg::new([SIZE[0], SIZE[1] + 210.0]);
    let label = format!("h ({unit})");
    let upper = Plot { corner: [ROOM[0], ROOM[1]], size: [SIZE[0] - ROOM[0] - ROOM[2], 216.0], x, y };
    upper.axes(&mut svg, &Look { x: &label, y: "error (J^½)", marks: [8, 6], grid: [true; 2] });
    let points = |value: fn(&Level) -> Option<f64>| {
        let all = levels.iter().filter_map(move |level| Some((level.size * factor, value(level)?)));
        all.filter(|(size, value)| *size > 0.0 && *value > 0.0).collect::<Vec<_>>()
    };
    draw(&mut svg, &upper, "s0", &points(|level| Some(level.estimate)));
    draw(&mut svg, &upper, "s1", &points(|level| level.error));
    legend(&mut svg, &["estimate", "true error"]);
    let indices = points(|level| Some(level.estimate / level.error?));
    let values: Vec<f64> = indices.iter().map(|(_, index)| *index).chain([1.0]).collect();
    if let Some(y) = around(&values, 1.2).filter(|_| !indices.is_empty()) {
        let lower = Plot { corner: [ROOM[0], SIZE[1] + 14.0], size: [upper.size[0], 146.0], x, y };
        lower.axes(&mut svg, &Look { x: &label, y: "effectivity index", marks: [8, 5], grid: [true; 2] });
        svg.line("now", lower.at(x.low, 1.0), lower.at(x.high, 1.0));
        draw(&mut svg, &lower, "s5", &indices);
    }
    Some(svg.alone())
}

/// A logarithmic scale with room on both sides of positive values.
fn around(values: &[f64], room: f64) -> Option<Scale> {
    let positive = || values.iter().copied().filter(|v| *v > 0.0 && v.is_finite());
    let (low, high) = (positive().reduce(f64::min)?, positive().reduce(f64::max)?);
    Some(Scale::logarithmic(low / room, high * room))
}

fn draw(svg: &mut Svg, plot: &Plot, class: &str, points: &[(f64, f64)]) {
    let places: Vec<_> = points.iter().map(|&(x, y)| plot.at(x, y)).collect();
    places.iter().for_each(|&at| svg.circle(class, at, 3.5));
    svg.polyline(class, places);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_and_their_quotient_are_drawn() {
        let level = |size: f64, error| Level { size, estimate: 30.0 * size.sqrt(), error };
        let levels = [level(4e-3, Some(1.5)), level(2e-3, Some(1.1)), level(1e-3, None)];
        let svg = convergence(&levels).unwrap();
        // Three estimates, two true errors, two quotients.
        assert_eq!(svg.matches("<circle").count(), 7);
        for word in ["h (mm)", "effectivity index", "true error"] {
            assert!(svg.contains(word), "{word}");
        }
        assert_eq!(convergence(&levels[..1]), None);
        assert_eq!(convergence(&[level(1e-3, None), level(2e-3, None)].map(|l| Level { estimate: 0.0, ..l })), None);
    }
}
