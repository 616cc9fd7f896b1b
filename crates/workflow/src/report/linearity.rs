//! What small strains, small rotations and the linear law suppose, and what a run does.
//!
//! studies/finite.py compares with the motion of finite strains: see docs/verdict.md.

use crate::deformation::{BodyDeformation, Deformation, Extreme, MaterialStress, PlasticFlow, Yielding};
use crate::message::{percent, short, signed_percent, trimmed, vector};
use percute_core::problem::SMALL_ROTATION;

/// Principal strains above the first limit trust, above the second one trust is low: a linear strain neglects half of
/// the square of the gradient, which is 1 and 5 % of these.
pub(super) const STRAIN: [f64; 2] = [0.02, 0.1];
/// Rotations (rad) that do the same: their growth θ²/2 is 1.3e-3 and 2 %, the latter as much as a large strain.
const ROTATION: [f64; 2] = [SMALL_ROTATION, 0.1];
/// The growth θ²/2 of a body that turns is an error of its shape, and of its gaps, of this part of its largest strain.
const OF_STRAIN: f64 = 0.1;
/// Rotations below this (rad) do not count, whatever the strain: their growth is 5e-7, below what strain gauges
/// resolve.
const LEAST: f64 = 1e-3;
/// A von Mises stress above this part of Young's modulus is beyond the law of a material without a stated yield stress.
/// Metals yield below it: aluminium alloys at 0.1 to 0.8 % of their modulus, steels at 0.1 to 0.9, titanium at 0.9.
const OF_YOUNG: f64 = 0.01;
/// Materials of a smaller modulus (Pa) are no metals: polymers and rubber bear more.
const METALS: f64 = 1e10;

/// Parts of a strain below this part of the largest are rounding of sums over its elements.
const ROUNDING: f64 = 1e-9;

/// How far a run is from what the linear theory supposes.
#[derive(Clone, Debug)]
pub(super) struct Linearity {
    /// The largest principal strain.
    pub(super) strain: Extreme,
    /// The body that turns too far.
    pub(super) turned: Option<Turned>,
    /// The stress that is beyond the linear law, in a sentence.
    pub(super) stress: Option<String>,
    /// Whether the kinematics are finite: any strain and rotation is within the theory.
    pub(super) finite: bool,
    /// The least E_t/E of the materials that yielded, by a law with plasticity.
    pub(super) yielded: Option<f64>,
    /// Whether a material has such a law: the kinematics cannot be finite then.
    pub(super) plastic: bool,
}

/// A strain or a rotation that is not small: it limits trust.
#[derive(Clone, Debug)]
pub(super) struct Departure {
    /// Its name and value.
    pub(super) named: String,
    /// Whether it is so far from small that trust is low.
    pub(super) is_far: bool,
    /// The reason for low trust.
    pub(super) reason: String,
}

/// A body that turns too far.
#[derive(Clone, Debug)]
pub(super) struct Turned {
    /// "the body", or its name.
    pub(super) subject: String,
    /// The largest rotation (rad).
    pub(super) angle: f64,
    /// Its instant (s).
    pub(super) time: f64,
    /// The largest strain.
    pub(super) strain: f64,
}

impl Linearity {
    pub(super) fn new(deformation: &Deformation, finite: bool) -> Self {
        let several = deformation.bodies.len() > 1;
        let turned = |body: &BodyDeformation| {
            let (angle, strain) = (body.rotation.abs(), body.strain.value.abs());
            let subject = if several { format!("{:?}", body.name) } else { "the body".to_string() };
            let too_far = angle > ROTATION[0] || (angle > LEAST && growth(angle) > OF_STRAIN * strain);
            too_far.then_some(Turned { subject, angle, time: body.time_of_rotation, strain })
        };
        let bodies = deformation.bodies.iter().filter(|_| !finite);
        let turned = bodies.filter_map(turned).max_by(|a, b| a.angle.total_cmp(&b.angle));
        let materials = &deformation.materials;
        let stress = stress(materials, finite).or_else(|| flow(deformation));
        let plastic =
            materials.iter().any(|material| material.yielding.as_ref().is_some_and(|found| found.plastic.is_some()));
        let yielded = flows(materials).map(|(_, _, flow)| flow.tangent_ratio).reduce(f64::min);
        Self { strain: deformation.strain(), turned, stress, finite, yielded, plastic }
    }

    /// The strains and the rotation that are not small.
    pub(super) fn departures(&self) -> Vec<Departure> {
        let strain = self.is_strained(0).then(|| Departure {
            named: format!("strains of up to {}", self.shown_strain()),
            is_far: self.is_strained(1),
            reason: format!("strains of up to {} are not small, as the theory supposes", self.shown_strain()),
        });
        let turned = self.turned.as_ref().map(|Turned { subject, angle, .. }| Departure {
            named: format!("a rotation of {} rad", short(*angle, 2)),
            is_far: *angle > ROTATION[1],
            reason: format!("{subject} turns by {} rad, and small rotations are supposed", short(*angle, 2)),
        });
        strain.into_iter().chain(turned).collect()
    }

    /// Whether the largest strain is above a limit: that of limited trust, 0, or that of low trust, 1.
    pub(super) fn is_strained(&self, limit: usize) -> bool {
        !self.finite && self.strain.value.abs() > STRAIN[limit]
    }

    fn shown_strain(&self) -> String {
        percent(self.strain.value.abs())
    }
}

/// "the body", or the group of a material.
fn place(material: &MaterialStress) -> String {
    material.group.as_ref().map_or_else(|| "the body".to_string(), |group| format!("group {group:?}"))
}

/// The materials that yielded, by a law with plasticity.
fn flows(materials: &[MaterialStress]) -> impl Iterator<Item = (&MaterialStress, &Yielding, &PlasticFlow)> {
    materials.iter().filter_map(|material| {
        let yielding = material.yielding.as_ref().filter(|yielding| yielding.share > 0.0)?;
        Some((material, yielding, yielding.plastic.as_ref()?))
    })
}

/// That with the largest plastic strain.
pub(super) fn largest_flow(materials: &[MaterialStress]) -> Option<(&MaterialStress, &Yielding, &PlasticFlow)> {
    flows(materials).max_by(|a, b| a.2.equivalent_strain.value.total_cmp(&b.2.equivalent_strain.value))
}

/// The plastic flow of the material with the largest plastic strain, and the strain that it leaves, in a sentence.
fn flow(deformation: &Deformation) -> Option<String> {
    let (material, yielding, PlasticFlow { equivalent_strain: strain, .. }) = largest_flow(&deformation.materials)?;
    Some(format!(
        "{} of {} yielded, first at {}; the plastic strain is at most {}, in {}{}.",
        percent(yielding.share),
        place(material),
        first(yielding),
        percent(strain.value),
        element(strain.element, &strain.centroid),
        kept(&deformation.bodies)
    ))
}

/// The first instant and element beyond the yield stress.
fn first(yielding: &Yielding) -> String {
    let time = trimmed(yielding.first.unwrap_or_default(), 4);
    let place = yielding.first_place.as_ref();
    place.map_or_else(|| format!("{time} s"), |at| format!("{time} s in {}", element(at.element, &at.centroid)))
}

/// An element with its centroid (m).
pub(super) fn element(number: usize, centroid: &[f64]) -> String {
    format!("element {number} at {} m", vector(centroid, 3))
}

/// The mean strain that remains of the body with the largest, behind a semicolon.
fn kept(bodies: &[BodyDeformation]) -> String {
    let largest = |strain: &[f64]| strain.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
    let kept = bodies.iter().filter_map(|body| Some((body, body.permanent_strain.as_ref()?)));
    let Some((body, strain)) = kept.max_by(|a, b| largest(a.1).total_cmp(&largest(b.1))) else { return String::new() };
    let subject = if bodies.len() > 1 { format!("{:?}", body.name) } else { "the body".to_string() };
    let least = ROUNDING * largest(strain);
    let told =
        |(along, part): (&str, f64)| format!("{} {along}", signed_percent(if part.abs() > least { part } else { 0.0 }));
    let parts = match strain[..] {
        [xx, yy, xy] => [("along x", xx), ("along y", yy), ("in shear", xy)].map(told).join(", "),
        _ => told(("along it", strain[0])),
    };
    format!("; free and at rest, {subject} would keep a mean strain of {parts}")
}

/// 1/cos θ − 1 ≈ θ²/2: by how much a body grows whose nodes leave their arcs along tangents.
pub(super) fn growth(angle: f64) -> f64 {
    0.5 * angle * angle
}

/// The stress that is farthest beyond the linear law, in a sentence.
fn stress(materials: &[MaterialStress], finite: bool) -> Option<String> {
    let law = if finite { "elastic" } else { "linear" };
    let yields = materials.iter().filter_map(|material| {
        let beyond = |yielding: &&Yielding| yielding.share > 0.0 && yielding.plastic.is_none();
        let yielding = material.yielding.as_ref().filter(beyond)?;
        Some((yielding.share, yielding, material))
    });
    let largest =
        |of: &Extreme| format!("{} Pa in element {} at {} s", short(of.value, 3), of.element, trimmed(of.time, 4));
    if let Some((share, yielding, material)) = yields.max_by(|a, b| a.0.total_cmp(&b.0)) {
        return Some(format!(
            "The law is {law}, but the von Mises stress is above the yield stress of {} Pa in {} of {}, first at {}; \
             it is at most {}.",
            short(yielding.yield_stress, 3),
            percent(share),
            place(material),
            first(yielding),
            largest(&material.von_mises)
        ));
    }
    let ratio = |material: &MaterialStress| material.von_mises.value / material.young;
    let is_stiff = |material: &&MaterialStress| material.yielding.is_none() && material.young > METALS;
    let unstated = materials.iter().filter(is_stiff).filter(|material| ratio(material) > OF_YOUNG);
    let worst = unstated.max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
    Some(format!(
        "The law is {law}, but a von Mises stress of {} is {} of Young's modulus, and metals yield below 1 %.",
        largest(&worst.von_mises),
        percent(ratio(worst))
    ))
}
