//! Elements that are nearly flat, where they make most of an estimate.
//!
//! Next to an angle near 180° admissible stress costs far more than the error of the simulation. The table of
//! `docs/verdict.md`, by studies/flat_elements.py, has circles and ellipses mapped from squares,
//! and blocks with a node that was moved almost onto the opposite edge: where elements with an angle above 150° and
//! those around them have less than 0.35 of the squared mean error, the estimate is up to 4.6 times the true error;
//! where they have more, it is up to 5.6 times that. Random bodies have 0.97 to 1.25.

use percute_core::border::Vector;
use percute_core::cell::CellKind;
use percute_core::dynamics::time_step_of_element;
use percute_core::ids::ElementId;
use percute_core::mesh::Mesh;
use percute_core::problem::AnyProblem;

/// Elements with a larger angle (degrees) are nearly flat.
pub(super) const ANGLE: f64 = 150.0;
/// The part of the squared mean error in them and around them from which on they spoil the estimate.
const SHARE: f64 = 0.35;
/// So many of them are named.
const NAMED: usize = 3;

/// The effect of nearly flat elements.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FlatElements {
    /// How many there are.
    pub(super) count: usize,
    /// The flattest, each with its largest angle (degrees) and its part of the squared mean error.
    pub(super) flattest: Vec<(usize, f64, f64)>,
    /// The part of the squared mean error in them all and in the elements that share a node with them.
    pub(super) share: f64,
    /// The critical step without them is at least this (s), by the bound of each of the others alone.
    pub(super) step_without: f64,
}

impl FlatElements {
    /// None unless they spoil the estimate; `by_element` has the contribution of each element.
    pub(super) fn new(problem: &AnyProblem, by_element: &[f64]) -> Option<Self> {
        let mesh = problem.mesh();
        match mesh.kind() {
            CellKind::Bar | CellKind::Tetrahedron => return None,
            CellKind::Triangle => {}
        }
        let largest = |e: usize| angles(mesh, e).into_iter().fold(0.0, f64::max);
        let angles = (0..mesh.element_count()).map(|e| (e, largest(e)));
        let mut flat: Vec<(usize, f64)> = angles.filter(|(_, angle)| *angle > ANGLE).collect();
        let total: f64 = by_element.iter().map(|e| e * e).sum();
        if flat.is_empty() || total <= 0.0 {
            return None;
        }
        let around = around(mesh, &flat);
        let part = |chosen: &dyn Fn(usize) -> bool| -> f64 {
            by_element.iter().enumerate().filter(|(e, _)| chosen(*e)).map(|(_, error)| error * error).sum::<f64>()
                / total
        };
        let share = part(&|e| around[e]);
        if share < SHARE {
            return None;
        }
        let mut others = vec![true; mesh.element_count()];
        flat.iter().for_each(|(e, _)| others[*e] = false);
        let others = others.iter().enumerate().filter(|(_, other)| **other).map(|(e, _)| ElementId::new(e));
        let step_without = others.map(|e| time_step_of_element(problem, e)).fold(f64::INFINITY, f64::min);
        flat.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        let flattest = flat.iter().take(NAMED).map(|&(e, angle)| (e, angle, by_element[e] * by_element[e] / total));
        Some(Self { count: flat.len(), flattest: flattest.collect(), share, step_without })
    }
}

/// The elements that share a node with some.
fn around(mesh: &Mesh, some: &[(usize, f64)]) -> Vec<bool> {
    let mut around = vec![false; mesh.element_count()];
    for node in some.iter().flat_map(|(e, _)| mesh.cell(ElementId::new(*e))) {
        mesh.elements_around(*node).iter().for_each(|element| around[element.index()] = true);
    }
    around
}

/// The angles of a triangle (degrees).
pub(super) fn angles(mesh: &Mesh, element: usize) -> [f64; 3] {
    let (points, n) = (mesh.cell_points(ElementId::new(element)), mesh.nodes_of_element());
    std::array::from_fn(|k| {
        let side = |to: usize| -> Vector { std::array::from_fn(|c| points[(k + to) % n][c] - points[k % n][c]) };
        let (a, b) = (side(1), side(2));
        (a[0] * b[1] - a[1] * b[0]).abs().atan2((0..3).map(|c| a[c] * b[c]).sum()).to_degrees()
    })
}
