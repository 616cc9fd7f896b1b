//! How far bodies strain and turn, and how far stress goes: strains and rotations are small by assumption, and the law
//! is linear.

mod flow;
mod permanent;
mod recorder;

pub use flow::StoredFlow;
pub(crate) use recorder::DeformationRecorder;

use crate::flight::NextTouch;
use serde::Serialize;

/// The deformation of bodies and the stress in materials, at each eighth instant and the last one; at each instant
/// while a material with a yield stress has not yielded.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Deformation {
    /// The bodies, in the order of their first nodes.
    pub bodies: Vec<BodyDeformation>,
    /// The materials, in their order.
    pub materials: Vec<MaterialStress>,
    /// Of all materials with a yield stress together; none without one.
    pub yielding: Option<OverallYielding>,
    /// The first point of a single body that would reach a plane by turning, if the run went on.
    #[serde(skip)]
    pub next_touch: Option<NextTouch>,
}

/// How far a body strains and turns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyDeformation {
    /// Its name: that of the group of all its elements, or "body 0".
    pub name: String,
    /// Its largest mean rotation, counterclockwise (rad): Σm x×u / Σm|x|², x from the centre of mass; 0 of a bar.
    pub rotation: f64,
    /// The instant of this rotation (s).
    pub time_of_rotation: f64,
    /// Its angular velocity at the last instant, counterclockwise (rad/s), that of the rigid motion which fits best; 0
    /// of a bar.
    pub angular_velocity: f64,
    /// The principal strain of an element, in the plane, that is largest without its sign.
    pub strain: Extreme,
    /// The mean strain (xx, yy and xy; xx of a bar) that the body would keep if it were at rest and free, and did not
    /// yield again. None of a body that did not yield, has several materials or supports.
    pub permanent_strain: Option<Vec<f64>>,
}

/// The stress in the elements of a material.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MaterialStress {
    /// Its group of elements; none if it is that of all.
    pub group: Option<String>,
    /// Young's modulus (Pa).
    pub young: f64,
    /// The largest von Mises stress of an element (Pa).
    pub von_mises: Extreme,
    /// Where it was above the yield stress; none without one.
    pub yielding: Option<Yielding>,
}

/// Where and when a material yielded or, if its law is elastic, the von Mises stress was above the yield stress.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Yielding {
    /// The yield stress (Pa).
    pub yield_stress: f64,
    /// The largest von Mises stress over it.
    pub stress_ratio: f64,
    /// The part of the volume of the material that yielded, or in which the stress was above it at some instant.
    pub share: f64,
    /// The first of these instants (s).
    pub first: Option<f64>,
    /// The element that yielded there; of several, the one with the largest plastic strain or stress.
    pub first_place: Option<ElementPlace>,
    /// Of a law with plasticity.
    pub plastic: Option<PlasticFlow>,
}

/// What plastic flow did in a material.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlasticFlow {
    /// E_t/E, the slope of the uniaxial curve beyond the yield stress over Young's modulus.
    pub tangent_ratio: f64,
    /// The largest equivalent plastic strain p of an element.
    pub equivalent_strain: Extreme,
    /// The mean of p over the volume of the material, at the last instant.
    pub mean_equivalent_strain: f64,
}

/// What all materials with a yield stress did together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OverallYielding {
    /// The part of their volume that yielded, or in which the stress was above the yield stress at some instant.
    pub share: f64,
    /// The largest von Mises stress over the yield stress.
    pub stress_ratio: f64,
    /// The largest equivalent plastic strain; none without a law with plasticity.
    pub equivalent_strain: Option<f64>,
}

/// An element with its place.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ElementPlace {
    /// The element.
    pub element: usize,
    /// Its centroid (m).
    pub centroid: Vec<f64>,
}

/// A largest value with its place.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The element.
    pub element: usize,
    /// Its centroid (m).
    pub centroid: Vec<f64>,
    /// The instant (s).
    pub time: f64,
}

impl Extreme {
    /// Takes in a value; the first of equal ones stays.
    fn take(&mut self, value: f64, element: usize, time: f64) {
        if value.abs() > self.value.abs() {
            (self.value, self.element, self.time) = (value, element, time);
        }
    }
}

impl Deformation {
    /// The largest principal strain of all bodies.
    #[must_use]
    pub fn strain(&self) -> Extreme {
        let strains = self.bodies.iter().map(|body| &body.strain);
        strains
            .reduce(|most, next| if next.value.abs() > most.value.abs() { next } else { most })
            .cloned()
            .unwrap_or_default()
    }
}
