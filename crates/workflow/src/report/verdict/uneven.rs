//! Meshes and materials beyond those of the evidence: long elements, elements of very different sizes, materials of
//! very different impedance beside each other, and nearly incompressible ones.

use crate::report::poor::{LONG, aspect};
use percute_core::contact_results::ContactResults;
use percute_core::dynamics::time_step_of_element;
use percute_core::ids::{ElementId, FaceId};
use percute_core::material::{Elastic, Hypothesis, Law};
use percute_core::mesh::Mesh;
use percute_core::problem::AnyProblem;

/// The part of the squared mean error in long elements from which on they matter: without it, the estimate would be
/// smaller by 5 %.
const SHARE: f64 = 0.1;

/// How uneven mesh and materials are, and how incompressible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uneven {
    /// The longest edge over the shortest one of an element, at most, where long elements have much of the error; 1 for
    /// others.
    pub(super) longest: f64,
    /// The largest of the critical steps of the elements alone over the smallest one: their sizes, in times of waves.
    pub(super) sizes: f64,
    /// The size of the largest element over that of the smallest one with a node that touches; 1 without contact. A
    /// size is the way of a wave in the critical step of the element alone.
    pub(super) at_contact: f64,
    /// The largest ratio of the impedances, with thickness or section, of two elements that share a face, or of two
    /// bodies at their interface.
    pub(super) impedances: f64,
    /// The largest Poisson's ratio in plane strain; 0 without plane strain.
    pub(super) poisson: f64,
}

impl Uneven {
    /// `by_element` has the contribution of each element to the mean error.
    pub(super) fn new(problem: &AnyProblem, by_element: &[f64], results: &ContactResults) -> Self {
        let mesh = problem.mesh();
        let steps: Vec<f64> = (0..by_element.len()).map(|e| time_step_of_element(problem, ElementId::new(e))).collect();
        let size = |element: ElementId| steps[element.index()] * problem.material(element).wave_speed();
        let largest = (0..by_element.len()).map(|e| size(ElementId::new(e))).fold(0.0, f64::max);
        let touched = results.nodes.iter().zip(&results.summary).filter(|(_, summary)| summary.first_touch.is_some());
        let elements = touched.flat_map(|(point, _)| mesh.elements_around(point.node).iter().copied());
        Self {
            longest: longest(mesh, by_element),
            sizes: steps.iter().copied().fold(0.0, f64::max) / steps.iter().copied().fold(f64::INFINITY, f64::min),
            at_contact: largest / elements.map(size).fold(largest, f64::min),
            impedances: impedances(problem),
            poisson: poisson(problem),
        }
    }
}

/// The longest edge over the shortest one of a long element, if they matter.
fn longest(mesh: &Mesh, by_element: &[f64]) -> f64 {
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

/// The largest ratio of the impedances of two elements that share a face, or of two bodies at their interface.
fn impedances(problem: &AnyProblem) -> f64 {
    let impedance = |law: &Elastic| law.density() * law.wave_speed() * law.extent();
    let each: Vec<f64> = problem.materials().iter().map(impedance).collect();
    let of = |element: ElementId| each[usize::from(problem.element_material()[element.index()])];
    let mesh = problem.mesh();
    let faces = (0..mesh.face_count()).map(|face| mesh.face(FaceId::new(face)));
    let inner = faces.filter_map(|face| Some((of(face.owner), of(face.neighbour?))));
    let inner = inner.map(|(a, b)| a.max(b) / a.min(b)).fold(1.0, f64::max);
    let ends = |side: usize| {
        let faces = problem.contact_faces().into_iter().filter(|face| face.obstacle == side);
        let owners = faces.map(|face| of(mesh.face(face.face).owner));
        owners.fold([f64::INFINITY, 0.0], |[least, most], each| [least.min(each), most.max(each)])
    };
    problem.sides_of_interfaces().into_iter().map(|sides| sides.map(ends)).fold(inner, |most, [a, b]| {
        // A side without faces has no impedance.
        most.max(a[1] / b[0]).max(b[1] / a[0])
    })
}

/// The largest Poisson's ratio in plane strain; 0 without plane strain.
fn poisson(problem: &AnyProblem) -> f64 {
    let strained = problem.materials().iter().filter(|law| law.hypothesis() == Hypothesis::PlaneStrain);
    strained.map(Elastic::poisson).fold(0.0, f64::max)
}
