//! The elements of bad shape that have most of an error: those to repair.

use super::flat::{self, angles};
use percute_core::ids::ElementId;
use percute_core::mesh::Mesh;
use serde::Serialize;

/// Elements whose longest edge is more than so many times as long as the shortest one are long. The evidence has up to
/// 2.9, a trapezoid; studies/beyond.py has indices of 1.2 at 3.0, 1.3 at 4.1 and 4.2 at 13.
pub(super) const LONG: f64 = 3.0;
/// So many are named.
const NAMED: usize = 3;

/// An element that is nearly flat, or long.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PoorElement {
    /// Its number.
    pub element: usize,
    /// Its centroid (m).
    pub centroid: Vec<f64>,
    /// Its longest edge over its shortest one.
    pub aspect: f64,
    /// Its smallest angle (degrees).
    pub smallest_angle: f64,
    /// Its largest angle (degrees).
    pub largest_angle: f64,
    /// Its part of the squared mean error.
    pub share: f64,
}

/// Those with the largest parts of the squared mean error, largest first; `by_element` has the contribution of each.
pub(super) fn poor_elements(mesh: &Mesh, by_element: &[f64]) -> Vec<PoorElement> {
    let total: f64 = by_element.iter().map(|error| error * error).sum();
    if mesh.dimension() != 2 || total <= 0.0 {
        return Vec::new();
    }
    let poor = |element: usize| {
        let (aspect, angles) = (aspect(mesh, element), angles(mesh, element));
        let smallest_angle = angles.iter().copied().fold(f64::INFINITY, f64::min);
        let largest_angle = angles.iter().copied().fold(0.0, f64::max);
        let centroid = mesh.centroid(ElementId::new(element))[..2].to_vec();
        let share = by_element[element] * by_element[element] / total;
        let is_poor = aspect > LONG || largest_angle > flat::ANGLE;
        is_poor.then_some(PoorElement { element, centroid, aspect, smallest_angle, largest_angle, share })
    };
    let mut all: Vec<PoorElement> = (0..by_element.len()).filter_map(poor).collect();
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all.truncate(NAMED);
    all
}

/// The longest edge of an element over its shortest one.
pub(super) fn aspect(mesh: &Mesh, element: usize) -> f64 {
    let points = mesh.cell_points(ElementId::new(element));
    let between = |a: usize, b: usize| (0..3).map(|c| (points[a][c] - points[b][c]).powi(2)).sum::<f64>().sqrt();
    let count = points.len();
    let edges = || (0..count).flat_map(|b| (0..b).map(move |a| (a, b))).map(|(a, b)| between(a, b));
    edges().fold(0.0, f64::max) / edges().fold(f64::INFINITY, f64::min)
}
