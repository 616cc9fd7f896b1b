//! Why a quantity does not converge: facts of geometry and contact.

use super::probe::Probe;
use crate::message::{short, vector};
use crate::report::{Report, Touches};
use percute_core::border::Vector;
use percute_core::contact::CORNER;
use percute_core::ids::NodeId;
use percute_core::mesh::Mesh;
use std::f64::consts::PI;

/// A corner is near to a probe within so many elements: the error of P1 elements at a singular stress is largest there.
const NEAR: f64 = 2.0;
/// A probe is at a corner within this part of the size of the mesh, the rounding of coordinates.
const AT: f64 = 1e-9;

/// What keeps a quantity from converging.
#[derive(Clone, Debug, PartialEq)]
pub enum Obstruction {
    /// A single node carries the largest force, at a corner.
    Corner,
    /// A single node carries it, at a curve: the contact is narrower than an element.
    Curve,
    /// The probe is at a re-entrant corner.
    ReEntrant {
        /// Its place (m).
        corner: Vec<f64>,
    },
    /// A re-entrant corner is nearer than two elements.
    NearReEntrant {
        /// Its place (m).
        corner: Vec<f64>,
        /// Its distance from the probe (m).
        distance: f64,
    },
}

/// That of the largest force.
pub(super) fn of_force(report: &Report) -> Option<Obstruction> {
    let (contact, touches) = (report.contact.as_ref()?, report.verdict.touches);
    let peak = contact.averaged_peak.filter(|_| report.problem.dimension > 1)?;
    // The average ends at the end of a step; the nodes that carry its force touch there.
    let last = contact.time.partition_point(|&time| time < peak.time).checked_sub(1)?;
    let carried_by_one = contact.total.in_contact.get(last) == Some(&1);
    match touches {
        Touches::Corner if carried_by_one => Some(Obstruction::Corner),
        Touches::Curve if carried_by_one => Some(Obstruction::Curve),
        _ => None,
    }
}

/// That of the stress or the plastic strain at a point.
pub(super) fn of_probe(probe: &Probe, mesh: &Mesh) -> Option<Obstruction> {
    let point = probe.place(mesh).filter(|_| probe.field().grows_at_corners())?;
    let away = |node: &NodeId| distance(&mesh.point(*node), &point);
    let corner = mesh.corners_above(PI + CORNER).into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))?;
    let (place, distance) = (mesh.point(corner)[..mesh.dimension()].to_vec(), away(&corner));
    if distance <= AT * mesh.size() {
        return Some(Obstruction::ReEntrant { corner: place });
    }
    (distance <= NEAR * longest_edge(mesh, corner)).then_some(Obstruction::NearReEntrant { corner: place, distance })
}

fn longest_edge(mesh: &Mesh, node: NodeId) -> f64 {
    let nodes = mesh.elements_around(node).iter().flat_map(|element| mesh.cell(*element));
    let lengths = nodes.map(|other| distance(&mesh.point(*other), &mesh.point(node)));
    lengths.fold(0.0, f64::max)
}

fn distance(a: &Vector, b: &Vector) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt()
}

impl Obstruction {
    /// Whether the quantity has no limit that elements of any size would reach.
    pub(crate) fn is_of_the_problem(&self) -> bool {
        matches!(self, Self::Corner | Self::ReEntrant { .. })
    }

    /// The reason and the way out, behind a colon.
    pub(super) fn told(&self) -> String {
        match self {
            Self::Corner => "one node carries the force; the force does not converge: round the corner".to_string(),
            Self::Curve => "one node carries the force; the contact of the curve is narrower than an element: take a \
                            mesh with smaller elements and more vertices there"
                .to_string(),
            Self::ReEntrant { corner } => {
                let place = vector(corner, 6);
                format!(
                    "the corner at {place} is re-entrant, and its stress has no limit: probe beside it, or round it"
                )
            }
            Self::NearReEntrant { corner, distance } => {
                let (place, distance) = (vector(corner, 6), short(*distance, 3));
                format!(
                    "the re-entrant corner at {place} is {distance} m from the probe, at most two elements: take more \
                     levels, or probe farther away"
                )
            }
        }
    }
}
