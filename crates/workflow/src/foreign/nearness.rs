//! How near to its plane a node is in contact: lengths below which a gap is none.

use super::balance::norm;
use super::window::Held;
use percute_core::border::Vector;
use percute_core::ids::ElementId;
use percute_core::problem::AnyProblem;

/// Rounding of a number relative to its size, in double and in single precision.
const ROUNDING: [f64; 2] = [f64::EPSILON, f32::EPSILON as f64];
/// Roundings of displacements add up in their second difference, and in the sums over the elements of a node.
pub(super) const ADDED: f64 = 16.0;
/// A node within this share of an element of its plane can be in contact. The gaps of percute's histories under a force
/// are below 1e-12 of an element, those of points in single precision below 3e-6.
pub(super) const NEAR: f64 = 1e-5;

/// The lengths of a problem that gaps are compared with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness {
    /// Size of the elements that may touch a plane (m), of all elements without planes: their shortest edge.
    pub(super) element: f64,
    contact: f64,
}

impl Nearness {
    pub(super) fn new(problem: &AnyProblem) -> Self {
        Self { element: element_size(problem), contact: problem.contact_tolerance() }
    }

    /// Gaps up to this (m) are none, with such a rounding of displacements (m).
    pub(super) fn tolerance(&self, unsure: f64) -> f64 {
        self.contact.max(ADDED * unsure).max(NEAR * self.element)
    }
}

/// Rounding of displacements (m): that of single precision if all of them are such numbers.
pub(super) fn rounding(values: &[Vector]) -> f64 {
    let single = values.iter().flatten().all(|&x| f64::from(x as f32) == x);
    ROUNDING[usize::from(single)] * size(values)
}

/// The largest rounding of the displacements of some steps (m).
pub(super) fn unsure<'h>(held: impl IntoIterator<Item = Option<&'h Held>>) -> f64 {
    held.into_iter().flatten().map(|held| rounding(&held.displacement)).fold(0.0, f64::max)
}

/// The largest component.
fn size(values: &[Vector]) -> f64 {
    values.iter().flatten().fold(0.0, |most, x| most.max(x.abs()))
}

fn element_size(problem: &AnyProblem) -> f64 {
    let mesh = problem.mesh();
    let edge = |element: ElementId| {
        let points = mesh.cell_points(element);
        let count = points.len();
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
        let length = |(i, j): (usize, usize)| norm(&std::array::from_fn::<_, 3, _>(|c| points[i][c] - points[j][c]));
        pairs.map(length).fold(f64::INFINITY, f64::min)
    };
    let near = problem.contact_faces().into_iter().map(|f| mesh.face(f.face).owner);
    let smallest = near.map(edge).fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { smallest } else { mesh.size() }
}
