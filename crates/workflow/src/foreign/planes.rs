//! Planes at another place, with another normal or with other friction than in the history.

use super::diagnosis::Diagnosis;
use super::limits::CONE;
use crate::message::{percent, trimmed, vector};

/// A plane at another place: nodes under force, or where a force is missing, are at the same distance from it, or at
/// one that grows along it.
pub(super) fn place(diagnosis: &Diagnosis<'_>, missing: bool) -> Option<String> {
    let (k, [gap, slope]) = diagnosis.evidence.contact.offset(missing)?;
    let which = which(diagnosis, k);
    if slope != 0.0 {
        let place = trimmed(gap.abs(), 4);
        let side = if gap > 0.0 { "above" } else { "below" };
        let normal = diagnosis.problem.obstacle(k).frame();
        let turned = turned(&normal.normal()[..diagnosis.problem.dimension()], slope.atan());
        return Some(format!(
            "{} of {which} is off by {} rad: the gaps of nodes under force grow along it; it should be \
             {turned}, and the nodes are {place} m {side} {which} on average",
            told(diagnosis, k, "normal"),
            trimmed(slope.atan().abs(), 4)
        ));
    }
    let side = if gap > 0.0 { "above" } else { "below" };
    let (away, turn) = (trimmed(gap.abs(), 4), of_friction(diagnosis));
    Some(format!(
        "{} of {which} is off by {away} m: nodes under force are {away} m {side} it on average; move it by {} m along \
         its normal{turn}",
        told(diagnosis, k, "point"),
        trimmed(gap, 4)
    ))
}

/// A normal that is turned by an angle (rad), counterclockwise.
fn turned(normal: &[f64], angle: f64) -> String {
    let (sin, cos) = angle.sin_cos();
    let n: Vec<f64> = match normal {
        &[x, y] => vec![cos * x - sin * y, sin * x + cos * y],
        other => other.to_vec(),
    };
    // The sums of squares lose half of the digits.
    let clean: Vec<f64> = n.into_iter().map(|x| if x.abs() < 1e-8 { 0.0 } else { x }).collect();
    vector(&clean, 6)
}

/// Friction that does not fit either, as with another normal: the gaps of one or two nodes do not tell the two apart.
fn of_friction(diagnosis: &Diagnosis<'_>) -> String {
    let misfit = diagnosis.found.slip.filter(|misfit| *misfit > CONE);
    misfit.map_or(String::new(), |misfit| {
        format!(". Or its `normal` is off: where nodes slide, the friction is off by {}, too", percent(misfit))
    })
}

/// The key of a plane, or the same of a surface.
fn told(diagnosis: &Diagnosis<'_>, k: usize, key: &str) -> String {
    match diagnosis.problem.obstacle(k).is_plane() {
        true => format!("the `{key}`"),
        false if key == "point" => "the place (`origin` of its body)".to_string(),
        false => "the direction (`rotation` of its body)".to_string(),
    }
}

/// A plane, for messages.
fn which(diagnosis: &Diagnosis<'_>, k: usize) -> String {
    let obstacle = diagnosis.problem.obstacle(k);
    match obstacle.group().filter(|_| !obstacle.is_plane()) {
        Some(group) => format!("the surface that faces \"{group}\""),
        None if diagnosis.problem.obstacle_count() > 1 => format!("plane {k} (from 0)"),
        None => "the plane".to_string(),
    }
}

/// Another coefficient of friction, or something else.
pub(super) fn friction(diagnosis: &Diagnosis<'_>, other: &str) -> String {
    let told = diagnosis.evidence.contact.friction().map_or(String::new(), |(k, friction)| {
        let stated = diagnosis.problem.obstacle(k).law().friction();
        format!(
            ": where nodes slide on {}, |R_t|/R_n is {} on average, not {}",
            which(diagnosis, k),
            trimmed(friction, 4),
            trimmed(stated, 4)
        )
    });
    format!("`friction` {other}is not that of the history{told}")
}
