//! An adaptation: the error over the elements of the best mesh, and over the cost of the runs.
//! `python/percute/adaptation_pictures.py` draws the same.

use super::{Legend, ROOM, SIZE};
use crate::axes::{Look, Plot};
use crate::body::Body;
use crate::document::Document;
use crate::picture;
use crate::scale::Scale;
use crate::svg::Svg;
use percute_workflow::adapt::Adaptation;

/// Room beside the cheapest and the dearest run and around errors, as a factor.
const BESIDE: f64 = 1.3;
const AROUND: f64 = 1.15;

/// The map of the best run, and below it the relative error of each run over the cost of all runs so far, beside that
/// which was expected and the target, as an SVG document. None without a run.
///
/// # Errors
/// None that is known; whatever the serialiser reports.
#[must_use = "it is the picture"]
pub fn adaptation(adaptation: &Adaptation) -> Result<Option<String>, std::io::Error> {
    let Some(best) = &adaptation.best else { return Ok(None) };
    let Ok(document) = Document::parse(&best.report.to_stored_json()?) else { return Ok(None) };
    let map = picture::whole(&Body::new(best.problem.mesh()), &document);
    Ok(Some(map.above(&errors(adaptation)).alone()))
}

/// The errors of the runs.
fn errors(adaptation: &Adaptation) -> Svg {
    let costs = adaptation.iterations.iter().scan(0.0, |cost, run| {
        *cost += run.element_steps;
        Some(*cost)
    });
    let runs: Vec<_> = costs.zip(&adaptation.iterations).collect();
    let percent = |error: f64| 100.0 * error;
    let found: Vec<[f64; 2]> = runs.iter().map(|(cost, run)| [*cost, percent(run.error)]).collect();
    let expected = runs.iter().filter_map(|(cost, run)| Some([*cost, percent(run.predicted?)]));
    let expected: Vec<[f64; 2]> = expected.collect();
    let target = percent(adaptation.wish.target);
    let errors = || found.iter().chain(&expected).map(|[_, error]| *error).chain([target]);
    let y = Scale::logarithmic(errors().fold(f64::INFINITY, f64::min) / AROUND, errors().fold(0.0, f64::max) * AROUND);
    let [first, last] = [found.first(), found.last()].map(|run| run.map_or(1.0, |[cost, _]| *cost));
    let x = Scale::logarithmic(first / BESIDE, last * BESIDE);
    let mut svg = Svg::new(SIZE);
    let size = [SIZE[0] - ROOM[0] - ROOM[2], SIZE[1] - ROOM[1] - ROOM[3]];
    let plot = Plot { corner: [ROOM[0], ROOM[1]], size, x, y };
    let look = Look {
        x: "elements times steps, all runs so far",
        y: "relative error (%)",
        marks: [6, 5],
        whole: false,
        grid: [true; 2],
    };
    plot.axes(&mut svg, &look);
    svg.line("now", plot.at(x.low, target), plot.at(x.high, target));
    let places = |points: &[[f64; 2]]| points.iter().map(|[cost, error]| plot.at(*cost, *error)).collect::<Vec<_>>();
    svg.polyline("s0 solid", places(&found));
    places(&found).into_iter().for_each(|at| svg.circle("s0 solid", at, 3.5));
    places(&expected).into_iter().for_each(|at| svg.circle("s1 solid", at, 3.5));
    Legend::new(["relative error", "expected (the dashed line is the target)"].into_iter()).draw(&mut svg);
    svg
}
