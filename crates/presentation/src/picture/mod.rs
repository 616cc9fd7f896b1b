//! Pictures of the error of each element.

mod bar;
mod frame;
mod plane_body;

use crate::body::Body;
use crate::deformed::Deformed;
use crate::document::Document;
use crate::png::{DrawError, rendered};
use crate::scale::quantity;
use crate::svg::{Anchor, Svg};
use percute_workflow::message::{percent, short};

/// Room above the plot for two lines, left of and below it for axes, and at free sides (pixels).
const HEAD: f64 = 62.0;
const AXIS_LEFT: f64 = 78.0;
const AXIS_BELOW: f64 = 52.0;
const MARGIN: f64 = 16.0;
/// Room for the meaning of the outline.
const LEGEND: f64 = 24.0;

/// The error e_E of each element (eq. \[20\]) as an SVG document: on the mesh of a plane body, along a bar.
#[must_use]
pub fn svg(body: &Body, document: &Document) -> String {
    whole(body, document).alone()
}

/// The same, to be drawn beside others.
pub(crate) fn whole(body: &Body, document: &Document) -> Svg {
    let shown = Shown::new(body, document, HEAD);
    let mut svg = shown.sized();
    head(&mut svg, document);
    shown.draw(&mut svg, Elements::Vectors, 0);
    svg
}

/// The same as a PNG.
///
/// # Errors
/// No memory for the pixels.
pub fn png(body: &Body, document: &Document) -> Result<Vec<u8>, DrawError> {
    rendered(&svg(body, document))
}

/// How elements are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Elements {
    /// A polygon each.
    Vectors,
    /// All as one PNG.
    Pixels,
}

/// Above this number of triangles the map of a page is a PNG: as polygons they would make the page larger than 1 MB.
pub(crate) const MOST_POLYGONS: usize = 6000;

/// The map of a page, without a head, with the places of the `marked` worst elements.
pub(crate) fn map(body: &Body, document: &Document, marked: usize) -> Svg {
    let shown = Shown::new(body, document, MARGIN);
    let mut svg = shown.sized();
    let elements = if body.elements() > MOST_POLYGONS { Elements::Pixels } else { Elements::Vectors };
    shown.draw(&mut svg, elements, marked);
    svg
}

/// The subject of a picture.
struct Shown<'a> {
    body: &'a Body,
    document: &'a Document,
    deformed: Option<Deformed>,
    /// Room above the plot (pixels).
    top: f64,
}

impl<'a> Shown<'a> {
    fn new(body: &'a Body, document: &'a Document, head: f64) -> Self {
        let deformed = Deformed::new(body, document);
        let top = if deformed.is_some() { head + LEGEND } else { head };
        Self { body, document, deformed, top }
    }

    fn sized(&self) -> Svg {
        Svg::new(if self.body.dimension == 1 { bar::size(self.top) } else { plane_body::size(self) })
    }

    fn draw(&self, svg: &mut Svg, elements: Elements, marked: usize) {
        match self.body.dimension {
            1 => bar::draw(svg, self.body, self.document, self.top, marked),
            _ => plane_body::draw(svg, self, elements, marked),
        }
    }
}

/// Two lines: the error of the whole, and the subject of the picture.
fn head(svg: &mut Svg, document: &Document) {
    let number = |path: &str| document.number(path).unwrap_or(f64::NAN);
    let norm = document.unit("J^½");
    let (error, relative) = (short(number("error.sup"), 4), percent(number("error.relative_sup")));
    let title = format!("Constitutive relation error {error} {norm} ({relative})");
    let cut = if document.flag("interrupted") { " (interrupted)" } else { "" };
    let name = document.name();
    let name = if name.is_empty() { name } else { name + ": " };
    let line = format!(
        "{name}contribution of each element up to t = {}{cut}; mean error {} {norm}",
        quantity(number("end"), "s", 4),
        short(number("error.mean"), 4)
    );
    svg.text("title", [MARGIN, 29.0], Anchor::Start, false, &title);
    svg.text("faint", [MARGIN, 50.0], Anchor::Start, false, &line);
}

/// The worst elements, the worst first.
fn worst(document: &Document, count: usize) -> impl Iterator<Item = &serde_json::Value> {
    document.list("worst_elements").iter().take(count)
}

/// Radius of the mark of a rank, and the least distance of two (pixels).
const MARK: f64 = 8.5;
const APART: f64 = 2.0 * MARK + 2.0;

/// Draws the ranks of elements at their places, the first place that of rank 1. A mark that would cover one before it
/// stands beside its place, with a line to it.
fn marks(svg: &mut Svg, places: &[[f64; 2]]) {
    let marks = apart(places);
    for (&place, &mark) in places.iter().zip(&marks).filter(|(place, mark)| place != mark) {
        ["halo", "outline"].iter().for_each(|class| svg.line(class, place, mark));
        svg.circle("mark", place, 2.5);
    }
    for (rank, &[x, y]) in marks.iter().enumerate() {
        svg.circle("mark", [x, y], MARK);
        svg.text("label", [x, y + 4.5], Anchor::Middle, false, &(rank + 1).to_string());
    }
}

/// Places for marks that do not cover each other: each at its own or, if there is no room, at the nearest of some
/// around it, above first.
fn apart(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    /// Directions that are tried, and the steps in them (pixels).
    const DIRECTIONS: usize = 12;
    const STEP: f64 = 0.5 * APART;
    let mut marks: Vec<[f64; 2]> = Vec::new();
    for &[x, y] in places {
        let around = (0..).map(|k| (k % DIRECTIONS, (k / DIRECTIONS + 2) as f64 * STEP)).map(|(k, distance)| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
            [x + distance * sin, y - distance * cos]
        });
        let free = |at: &[f64; 2]| marks.iter().all(|mark| (at[0] - mark[0]).hypot(at[1] - mark[1]) >= APART);
        // Far enough away there is room.
        let found = std::iter::once([x, y]).chain(around).find(free);
        marks.push(found.unwrap_or([x, y]));
    }
    marks
}

/// A plane: a point on it and its normal.
struct Plane {
    point: [f64; 2],
    normal: [f64; 2],
}

fn planes(document: &Document) -> Vec<Plane> {
    let vector = |value: &serde_json::Value| {
        let found = crate::document::numbers(value);
        [0, 1].map(|c| found.get(c).copied().unwrap_or(0.0))
    };
    let plane = |plane: &serde_json::Value| Plane { point: vector(&plane["point"]), normal: vector(&plane["normal"]) };
    // The surface of another body has no point: it is drawn with that body.
    document.list("problem.obstacles").iter().filter(|plane| !plane["point"].is_null()).map(plane).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_mark_covers_another() {
        let places = [[50.0, 50.0], [53.0, 50.0], [50.0, 50.0], [300.0, 10.0], [51.0, 48.0], [49.0, 52.0]];
        let marks = apart(&places);
        let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        for (k, &mark) in marks.iter().enumerate() {
            assert!(marks[..k].iter().all(|&other| distance(mark, other) >= 2.0 * MARK), "{marks:?}");
            assert!(distance(mark, places[k]) <= 3.0 * APART, "{marks:?}");
        }
        assert_eq!((marks[0], marks[3]), (places[0], places[3]));
    }
}
