//! Numbers that look like those of other units.

use super::{Place, PlausibilityWarning, at, plausibility_warning};
use crate::load::BodyForce;
use crate::material::{Elastic, Hypothesis, Law};
use crate::message::short;
use crate::problem::Problem;
use std::ops::RangeInclusive;

/// Less dense than any solid but foams (kg/m³).
const LIGHT: f64 = 10.0;
/// Denser than osmium, 22 600 kg/m³.
const HEAVY: f64 = 25e3;
/// Densities of most solids (kg/m³).
const SOLIDS: [f64; 2] = [100.0, 25e3];
/// Softer than rubber (Pa).
const SOFT: f64 = 1e6;
/// Stiffer than diamond, 1.2e12 Pa.
const STIFF: f64 = 1.3e12;
/// Waves in a jelly are slower (m/s).
const SLOW: f64 = 10.0;
/// Waves in diamond run at 18 000 m/s.
const FAST: f64 = 2e4;
/// Larger than all but a few bodies that strike something: piles have tens of metres.
pub(super) const LARGE: f64 = 60.0;
/// Wider and higher than plane bodies that strike something: ships and buildings apart.
const BROAD: f64 = 5.0;
/// If the start is refused, a body above this size is more likely in millimetres: its steps are too long.
pub(super) const LARGE_IF_REFUSED: f64 = 1.0;
/// A bar so many times as wide as it is long, or a plane body so many times as thick as it is large, is more likely one
/// in other units.
const WIDE: f64 = 10.0;
const THICK: f64 = 100.0;
/// A coefficient of friction above this is more likely a percentage.
const ROUGH: f64 = 2.0;
/// From here on triangles in plane strain and tetrahedra are far too stiff.
const INCOMPRESSIBLE: f64 = 0.49;

pub(super) fn plausibility_warnings<const D: usize>(problem: &Problem<D>) -> Vec<PlausibilityWarning> {
    let size = problem.mesh().size();
    // An import warning of the mesh file names the key that corrects it.
    let reported = problem.mesh().import_warnings().iter().any(|import_warning| import_warning.name == "large_mesh");
    let broad = narrowest(problem.mesh().points_in::<D>()) > BROAD && D == 2;
    let large = if broad { size_of_body(size, 0.0) } else { size_of_body(size, LARGE) };
    let mut all: Vec<PlausibilityWarning> = large.filter(|_| !reported).into_iter().collect();
    for (index, material) in problem.materials().iter().enumerate() {
        all.extend([density(material, index), stiffness(material, size, index)].into_iter().flatten().take(1));
        all.extend(extent(material, size, index));
        all.extend(locking(material, index));
        all.extend(yielding(material, index));
    }
    let lightest = problem.materials().iter().map(|material| material.density()).fold(f64::INFINITY, f64::min);
    let forces = problem.conditions().body_forces.iter().enumerate();
    all.extend(forces.filter_map(|(index, force)| weight(force, lightest, index)));
    all.extend(problem.obstacles().iter().enumerate().filter(|(index, _)| problem.leads_interface(*index)).filter_map(
        |(index, obstacle)| {
            let Place { table, index, .. } = problem.place_of_obstacle(index);
            friction(obstacle.law().friction(), at(table, index, "friction"))
        },
    ));
    all
}

fn units(table: &'static str, index: Option<usize>, key: &'static str, message: String) -> Option<PlausibilityWarning> {
    let brief = match key {
        "" => format!("{table}: did you mix units?"),
        key => format!("{table}, {key}: did you mix units?"),
    };
    Some(plausibility_warning(at(table, index, key), "units", brief, message))
}

/// The least extent of points along an axis (m).
fn narrowest<const D: usize>(points: &[[f64; D]]) -> f64 {
    let extent = |c: usize| {
        let ends =
            points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[c]), high.max(p[c])]);
        ends[1] - ends[0]
    };
    (0..D).map(extent).fold(f64::INFINITY, f64::min)
}

pub(super) fn size_of_body(size: f64, large: f64) -> Option<PlausibilityWarning> {
    if size <= large {
        return None;
    }
    let (shown, metres) = (short(size), short(1e-3 * size));
    let message = format!(
        "the body is {shown} m large; lengths are in metres: if these are millimetres, make it {metres} m (a mesh from \
             a file: `scale` 1e-3)"
    );
    units("mesh", None, "", message)
}

fn density(material: &Elastic, index: usize) -> Option<PlausibilityWarning> {
    let density = material.density();
    if is_normalised(material) || (LIGHT..=HEAVY).contains(&density) {
        return None;
    }
    let shown = short(density);
    let looks = |(unit, factor): &(&str, f64)| {
        let meant = factor * density;
        let likely = (SOLIDS[0]..=SOLIDS[1]).contains(&meant);
        likely.then(|| {
            format!("is {shown} kg/m³, not the density of a solid; if it is in {unit}, write {}", short(meant))
        })
    };
    let others = [("g/cm³", 1e3), ("kg/mm³", 1e9), ("t/mm³", 1e12)];
    let message = others.iter().find_map(looks).unwrap_or_else(|| {
        format!("is {shown} kg/m³; solids have between {} and {}: is it in kg/m³?", short(SOLIDS[0]), short(SOLIDS[1]))
    });
    units("material", Some(index), "density", message)
}

/// Whether the numbers are such as examples in books have: a density of 1, and waves that a pencil can follow.
fn is_normalised(material: &Elastic) -> bool {
    material.density() == 1.0 && material.young() <= 1e4
}

fn stiffness(material: &Elastic, size: f64, index: usize) -> Option<PlausibilityWarning> {
    // Along a bar: waves in a plane body that hardly changes its volume are as fast as you like.
    let (young, speed) = (material.young(), (material.young() / material.density()).sqrt());
    if is_normalised(material) {
        return None;
    }
    let (shown, waves) = (short(young), short(speed));
    let message = if young < SOFT && (size > 1.0 || speed < SLOW) {
        let (unit, meant) = if young < 1300.0 { ("GPa", 1e9 * young) } else { ("MPa", 1e6 * young) };
        // No solid but a few ceramics is stiffer.
        let advice = if meant <= 6e11 {
            format!("If it is in {unit}, write {}", short(meant))
        } else {
            "It is in Pa".to_string()
        };
        format!(
            "is {shown} Pa, softer than rubber, in a body of {} m (waves run at {waves} m/s): did you mix units? \
             {advice}",
            short(size)
        )
    } else if young > STIFF {
        format!("is {shown} Pa, stiffer than diamond (1.2e12 Pa): is it in Pa?")
    } else if speed > FAST {
        let density = short(material.density());
        format!(
            "is {shown} Pa; with a density of {density} kg/m³ waves run at {waves} m/s, faster than in any material \
             (diamond: 18000 m/s): did you mix units? They are Pa and kg/m³"
        )
    } else {
        return None;
    };
    units("material", Some(index), "young", message)
}

fn extent(material: &Elastic, size: f64, index: usize) -> Option<PlausibilityWarning> {
    let (extent, length) = (material.extent(), short(size));
    let shown = short(extent);
    if material.hypothesis() == Hypothesis::Bar {
        // 1 is often a section that does not matter.
        if extent.sqrt() <= WIDE * size || extent == 1.0 {
            return None;
        }
        let metres = short(1e-6 * extent);
        let message = format!(
            "is {shown} m², far wider than the bar's length of {length} m; sections are in m²: if it is in mm², write \
             {metres}"
        );
        return units("material", Some(index), "section", message);
    }
    // 1 is the default, for energies per metre.
    if extent <= THICK * size || extent == 1.0 {
        return None;
    }
    let metres = short(1e-3 * extent);
    let message = format!("is {shown} m, far more than the body's size of {length} m; if it is in mm, write {metres}");
    units("material", Some(index), "thickness", message)
}

fn locking(material: &Elastic, index: usize) -> Option<PlausibilityWarning> {
    let poisson = material.poisson();
    let elements = match material.hypothesis() {
        Hypothesis::PlaneStrain => "triangles in plane strain",
        Hypothesis::Solid => "tetrahedra",
        Hypothesis::Bar | Hypothesis::PlaneStress => return None,
    };
    if poisson <= INCOMPRESSIBLE {
        return None;
    }
    let message = format!(
        "is {poisson}: linear {elements} lock for a nearly incompressible material; \
         results are reliable up to {INCOMPRESSIBLE}"
    );
    Some(plausibility_warning(
        at("material", Some(index), "poisson"),
        "locking",
        "material, poisson: elements will lock",
        message,
    ))
}

/// Metals yield at 1e-4 to 0.03 of Young's modulus, polymers below 0.1.
const YIELDS: RangeInclusive<f64> = 1e-5..=0.1;

fn yielding(material: &Elastic, index: usize) -> Option<PlausibilityWarning> {
    let stress = material.yield_stress()?;
    let ratio = stress / material.young();
    let message = format!(
        "is {} Pa, {} of Young's modulus; metals yield at 1e-4 to 0.03 of it: is it in Pa?",
        short(stress),
        short(ratio)
    );
    if YIELDS.contains(&ratio) { None } else { units("material", Some(index), "yield_stress", message) }
}

/// Accelerations of gravity in the two digits in which they are written (m/s²).
const GRAVITY: [f64; 2] = [9.75, 10.0];

fn weight(force: &BodyForce, density: f64, index: usize) -> Option<PlausibilityWarning> {
    let largest = force.value.value().iter().flatten().fold(0.0_f64, |m, f| m.max(f.abs()));
    // In what is lighter than water by as much, this may be a force.
    if !(GRAVITY[0]..=GRAVITY[1]).contains(&largest) || density < 10.0 * GRAVITY[1] {
        return None;
    }
    let (shown, weight) = (short(largest), short(density * largest));
    let message = format!(
        "reaches {shown} N/m³, the number of g in m/s²; a weight is density times g, here {weight} N/m³: did you leave \
         out the density?"
    );
    units("body_force", Some(index), "value", message)
}

fn friction(friction: f64, place: Place) -> Option<PlausibilityWarning> {
    if friction <= ROUGH {
        return None;
    }
    let message = format!(
        "is {}, far above that of any materials; the coefficient has no unit: if it is in percent, write {}",
        short(friction),
        short(0.01 * friction)
    );
    Some(plausibility_warning(place, "friction", "friction above 2: in percent?", message))
}
