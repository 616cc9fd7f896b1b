//! Properties of a run that no case of the evidence has: with one of them, trust is limited.

use super::facts::Facts;
use super::rules::{LONG, PENALTY};
use crate::message::{percent, short};
use crate::report::symptoms::{PENETRATION, SLIP};
use crate::report::touches::Touches;

/// Speeds over the wave speed that the evidence has: 0.4 m/s in ν = 0.45 (9.9 km/s) to 400 m/s in a bar (5.1 km/s).
pub(super) const SPEEDS: [f64; 2] = [4e-5, 0.08];
/// Courant numbers of the evidence.
pub(super) const STEPS: [f64; 2] = [0.02, 0.9];
/// Largest friction of the evidence.
pub(super) const FRICTION: f64 = 0.5;

/// Wave passages that the evidence has after a flat impact. Random bodies that touch with a corner or a curve have
/// indices up to 1.94 after 12 and 13.
const LONGEST: f64 = 10.0;
/// The fewest wave passages after the first touch that the evidence has: runs of 0.1 passages and whole steps in
/// studies/durations.py, of 0.084 at least.
const SHORTEST: f64 = 0.08;

/// Residuals of the balance in a history of another program above this share of the largest term may double the
/// estimate: contact forces are far larger than those inside the body. Histories in single precision have 1e-4, with
/// steps of 0.02 Δt_c 2e-3.
const UNBALANCED: f64 = 5e-4;

/// Impedances of neighbours in a plane body, and critical steps of the elements of a bar, that differ by more make an
/// index outside the ranges. The evidence has 2.9 and 2. studies/beyond.py has 1.23 for 30 and 2.3
/// for 100, and on bars 0.88 for 5, 0.79 for 10 and 2.4 for 51.
const IMPEDANCES: f64 = 30.0;
/// See there.
const SIZES: f64 = 5.0;
/// On finer elements along a flat contact the auxiliary solution gains energy: the index is 1.3 for 4, 1.6 for 8, 1.9
/// for 16 and 2.1 for 32 times smaller ones.
const AT_FLAT_CONTACT: f64 = 5.0;
/// Above, triangles of plane strain lock: the index is 1.3 for 0.49, 2.4 for 0.495 and 2.8 for 0.499.
const POISSON: f64 = 0.49;
/// The least E_t/E of the evidence: the plastic part becomes too large, 2.2 in a flat impact with 0.005.
const HARDENING: f64 = 0.02;
/// Rounding does not make a stated ratio larger by more than this part of it.
const STATED: f64 = 1e-6;

/// The properties of a run that no case of the evidence has.
pub(super) fn outside(facts: &Facts) -> Vec<String> {
    let mut outside = Vec::new();
    if facts.is_solid() {
        outside.push("solids, of which the evidence has few".to_string());
    }
    if let Some(ratio) = facts.speed_ratio {
        if ratio > SPEEDS[1] || (ratio > 0.0 && ratio < SPEEDS[0]) {
            outside.push(format!("an impact velocity of {} of the wave speed", short(ratio, 2)));
        } else if ratio <= 0.0 {
            outside.push("no impact velocity".to_string());
        }
    }
    // Rounding moves the last digits of a stated Courant number; a bar may have the critical step.
    let most = if facts.dimension == 1 { 1.0 } else { STEPS[1] };
    if facts.courant < STEPS[0] * 0.99 || facts.courant > most * 1.01 {
        outside.push(format!("steps of {} Δt_c", short(facts.courant, 2)));
    }
    if facts.largest_friction > FRICTION {
        outside.push(format!("friction above {FRICTION}"));
    }
    if let Some(other) = facts.acceleration.filter(|_| !facts.vibrates_with_closest()) {
        outside.push(format!("acceleration `{other}`"));
    }
    outside.extend(of_bodies(facts));
    outside.extend(at_the_start(facts));
    outside.extend(of_uneven_meshes(facts));
    outside.extend(of_durations(facts));
    if facts.is_thin() && facts.contact.touches == Touches::Edge {
        outside.push("edge contact of a thin body".to_string());
    }
    if facts.supported {
        outside.push("supports".to_string());
    }
    outside.extend(of_histories(facts));
    if let Some(ratio) = facts.linearity.yielded.filter(|ratio| *ratio < HARDENING * (1.0 - STATED)) {
        outside.push(format!("a tangent beyond yield of {} of Young's modulus", percent(ratio)));
    }
    outside
}

/// How long after the first touch no case of the evidence ends.
fn of_durations(facts: &Facts) -> Vec<String> {
    let mut outside = Vec::new();
    if facts.dimension == 2 && facts.contact.touches != Touches::None && facts.passages > LONGEST {
        outside.push(format!("{} wave passages", short(facts.passages, 2)));
    }
    if facts.has_just_begun() && facts.passages < SHORTEST {
        outside.push(format!("{} wave passages after the first touch", short(facts.passages, 2)));
    }
    if facts.corner.is_some() && facts.passages > LONG {
        outside.push(format!("{} wave passages in a corner", short(facts.passages, 2)));
    }
    outside
}

/// What no history of the evidence has.
fn of_histories(facts: &Facts) -> Vec<String> {
    let mut outside = Vec::new();
    if facts.unbalanced > UNBALANCED {
        outside.push(format!("a force balance off by {}", percent(facts.unbalanced)));
    }
    if facts.by_a_penalty {
        outside.push(PENALTY.to_string());
    } else if let Some(off) = facts.off_contact {
        outside.push(format!("contact nodes off their plane by {} of an element", short(off, 2)));
    }
    if facts.shifted {
        outside.push("contact forces of another step".to_string());
    }
    if facts.sampled {
        outside.push("samples instead of steps".to_string());
    }
    outside
}

/// How bodies touch each other where no case of the evidence has it.
fn of_bodies(facts: &Facts) -> Vec<String> {
    let touches = match facts.contact.touches {
        _ if !facts.bodies || facts.dimension == 1 => None,
        // A mean gap may be open although a corner is inside the other body.
        Touches::None if facts.slides => Some("non-matching interfaces without contact"),
        Touches::Edge | Touches::End => None,
        _ if facts.slides => None,
        _ => Some("this kind of contact between bodies"),
    };
    let edges = |value: f64| short(value, 2);
    let slip = (facts.slip > SLIP).then(|| format!("node pairs with a slip of {} edges", edges(facts.slip)));
    let penetration = (facts.penetration > PENETRATION)
        .then(|| format!("nodes inside the other body by {} of an edge", edges(facts.penetration)));
    touches.map(str::to_string).into_iter().chain(slip).chain(penetration).collect()
}

/// How the motion begins where no case of the evidence does so.
fn at_the_start(facts: &Facts) -> impl Iterator<Item = String> {
    let onset = facts.onset;
    let named = [
        (onset.load_jumps, "a sudden load"),
        (onset.velocity_jumps, "a velocity jump inside a body"),
        (onset.strained, "an initial strain"),
        (onset.pushed, "an impact driven by a traction"),
    ];
    named.into_iter().filter(|(applies, _)| *applies).map(|(_, name)| name.to_string())
}

/// Meshes and materials that are more uneven than those of the evidence.
fn of_uneven_meshes(facts: &Facts) -> impl Iterator<Item = String> {
    let (uneven, plane) = (facts.uneven, facts.dimension == 2);
    let more = |ratio: f64, most: f64| ratio > most * (1.0 + STATED);
    let long = plane && !facts.flat && uneven.longest > crate::report::poor::LONG;
    let flat = matches!(facts.contact.touches, Touches::Edge | Touches::End);
    let small = plane && flat && more(uneven.at_contact, AT_FLAT_CONTACT);
    let named = [
        (small, "elements at a flat contact smaller than the largest by a factor of", uneven.at_contact, ""),
        (more(uneven.poisson, POISSON), "plane strain with a Poisson's ratio above", POISSON, ""),
        (long, "elements", uneven.longest, "times as long as their shortest edge"),
        (plane && more(uneven.impedances, IMPEDANCES), "impedances that differ by a factor of", uneven.impedances, ""),
        (!plane && more(uneven.sizes, SIZES), "elements of a bar that differ by a factor of", uneven.sizes, ""),
    ];
    let told = |(_, before, value, after): (bool, &str, f64, &str)| {
        format!("{before} {} {after}", short(value, 2)).trim_end().to_string()
    };
    named.into_iter().filter(|(applies, ..)| *applies).map(told)
}
