//! Meshes and materials that are more uneven than those of the evidence: long elements, elements of very different
//! sizes, and materials of very different impedance beside each other.

use crate::report::poor::{LONG, aspect};
use percute_core::dynamics::time_step_of_element;
use percute_core::ids::ElementId;
use percute_core::material::{Elastic, Law};
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;

/// The part of the squared mean error in long elements from which on they matter: without it, the estimate would be
/// smaller by 5 %.
const SHARE: f64 = 0.1;

/// How uneven mesh and materials are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uneven {
    /// The longest edge over the shortest one of an element, at most, where long elements have much of the error; 1 for
    /// others.
    pub(super) longest: f64,
    /// The largest of the critical steps of the elements alone over the smallest one: their sizes, in times of waves.
    pub(super) sizes: f64,
    /// The largest ratio of the impedances, with thickness or section, of two elements that share a facet.
    pub(super) impedances: f64,
}

impl Uneven {
    /// `by_element` has the contribution of each element to the mean error.
    pub(super) fn new<const D: usize, const N: usize>(problem: &Problem<D, N>, by_element: &[f64]) -> Self {
        let steps = || (0..by_element.len()).map(|e| time_step_of_element(problem, ElementId::new(e)));
        let sizes = steps().fold(0.0, f64::max) / steps().fold(f64::INFINITY, f64::min);
        Self { longest: longest(problem.mesh(), by_element), sizes, impedances: impedances(problem) }
    }
}

/// The longest edge over the shortest one of a long element, if they matter.
fn longest<const D: usize, const N: usize>(mesh: &Mesh<D, N>, by_element: &[f64]) -> f64 {
    let (mut most, mut of_long, mut total) = (1.0_f64, 0.0, 0.0);
    for (element, error) in by_element.iter().enumerate() {
        let ratio = aspect(mesh, element);
        total += error * error;
        if ratio > LONG {
            (most, of_long) = (most.max(ratio), of_long + error * error);
        }
    }
    if of_long > SHARE * total { most } else { 1.0 }
}

/// The largest ratio of the impedances of two elements that share a facet.
fn impedances<const D: usize, const N: usize>(problem: &Problem<D, N>) -> f64 {
    let impedance = |law: &Elastic| law.density() * law.wave_speed() * law.extent();
    let each: Vec<f64> = problem.materials().iter().map(impedance).collect();
    let of = |element: ElementId| each[usize::from(problem.element_material()[element.index()])];
    let inner = problem.mesh().facets().iter().filter_map(|facet| Some((of(facet.owner), of(facet.neighbour?))));
    inner.map(|(a, b)| a.max(b) / a.min(b)).fold(1.0, f64::max)
}
