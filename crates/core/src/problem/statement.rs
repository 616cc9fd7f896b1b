//! A problem of either dimension as it is stated.

use super::{Contact, Initial, InputError, Problem};
use crate::border::{Vector, cut, vectors};
use crate::contact::AnyObstacle;
use crate::load::{BodyForce, Support, Traction};
use crate::material::Elastic;
use crate::mesh::Mesh;
use std::sync::Arc;

/// All that a problem takes beside its mesh; [`AnyProblem::new`](super::AnyProblem::new) checks it.
#[derive(Clone, Debug, Default)]
pub struct Statement {
    /// Materials, each with its group of elements; `None` means all.
    pub materials: Vec<(Option<String>, Elastic)>,
    /// Rigid planes.
    pub obstacles: Vec<AnyObstacle>,
    /// Contacts between bodies.
    pub contacts: Vec<Contact>,
    /// Whether all bodies that could touch each other may do so.
    pub automatic_contact: bool,
    /// Whether a body may start on a plane and move into it: the plane is moved away before a simulation.
    pub planes_to_be_moved: bool,
    /// Supports.
    pub supports: Vec<Support>,
    /// Tractions.
    pub tractions: Vec<Traction>,
    /// Body forces.
    pub body_forces: Vec<BodyForce>,
    /// Acceleration of gravity (m/s²).
    pub gravity: Option<Vector>,
    /// u₀ (m): a row for all nodes, or one for each; nothing for 0.
    pub displacement: Vec<f64>,
    /// v₀ (m/s), likewise.
    pub velocity: Vec<f64>,
}

/// Builds the problem on a mesh of its dimension.
pub(super) fn build<const D: usize>(mesh: &Arc<Mesh>, stated: &Statement) -> Result<Problem<D>, InputError> {
    let mut builder = Problem::builder(mesh.clone());
    for (group, law) in &stated.materials {
        builder = match group {
            Some(group) => builder.material_of(group, *law),
            None => builder.material(*law),
        };
    }
    let planes = stated.obstacles.iter().filter_map(AnyObstacle::typed);
    builder = planes.fold(builder, |builder, plane| builder.obstacle(plane.clone()));
    builder = stated.contacts.iter().fold(builder, |builder, contact| builder.contact(contact.clone()));
    builder = stated.supports.iter().fold(builder, |builder, support| builder.support(support.clone()));
    builder = stated.tractions.iter().fold(builder, |builder, traction| builder.traction(traction.clone()));
    builder = stated.body_forces.iter().fold(builder, |builder, force| builder.body_force(force.clone()));
    if let Some(gravity) = &stated.gravity {
        builder = builder.gravity(cut(gravity));
    }
    if stated.automatic_contact {
        builder = builder.automatic_contact();
    }
    if stated.planes_to_be_moved {
        builder = builder.planes_to_be_moved();
    }
    builder.initial_displacement(initial(&stated.displacement)).initial_velocity(initial(&stated.velocity)).build()
}

/// A mesh has two nodes or more: one row is for all.
fn initial<const D: usize>(rows: &[f64]) -> Initial<D> {
    match vectors(rows) {
        [] => Initial::Uniform([0.0; D]),
        [row] => Initial::Uniform(*row),
        rows => Initial::Nodal(rows.to_vec()),
    }
}
