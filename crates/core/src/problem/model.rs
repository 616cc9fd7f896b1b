//! What a problem has in any dimension.

use super::{BodyLoad, Conditions, MovedPlane, Place, PrescribedComponent};
use crate::ids::{ElementId, FaceId};
use crate::load::Table;
use crate::material::{Elastic, Law, VonMises};
use crate::mesh::Mesh;
use crate::units::Units;
use std::sync::{Arc, OnceLock};

/// Mesh, materials, masses, supports and tables of a problem: all of it that does not depend on the dimension.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) mesh: Arc<Mesh>,
    pub(super) stated: Conditions,
    pub(super) materials: Vec<Elastic>,
    pub(super) element_material: Vec<u16>,
    pub(super) mass: Vec<f64>,
    pub(super) prescribed: Vec<PrescribedComponent>,
    pub(super) motions: Vec<Table>,
    pub(super) traction_tables: Vec<Table>,
    pub(super) body_loads: Vec<BodyLoad>,
    pub(super) element_body_loads: Vec<Vec<u16>>,
    /// Where each of the interfaces is stated.
    pub(super) contacts: Vec<Place>,
    pub(super) moved_planes: Vec<MovedPlane>,
    /// Δt_c (s), once it is known.
    pub(super) critical_step: OnceLock<f64>,
}

impl Model {
    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// What was stated, to be written down; mesh, obstacles and initial fields are beside it.
    #[must_use]
    pub fn conditions(&self) -> &Conditions {
        &self.stated
    }

    /// The material of an element.
    #[inline]
    #[must_use]
    pub fn material(&self, element: ElementId) -> &Elastic {
        &self.materials[usize::from(self.element_material[element.index()])]
    }

    /// Whether a body may turn and strain by any amount.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.materials.iter().any(Elastic::is_finite)
    }

    /// Whether a material yields.
    #[must_use]
    pub fn yields(&self) -> bool {
        self.materials.iter().any(|material| material.hardening().is_some())
    }

    /// The laws of all materials, of which some may yield.
    #[must_use]
    pub fn yielding_laws(&self) -> Vec<VonMises> {
        self.materials.iter().map(VonMises::new).collect()
    }

    /// Internal variables of an element.
    #[must_use]
    pub fn variables(&self) -> usize {
        if self.yields() { VonMises::count(self.mesh.dimension()) } else { 0 }
    }

    /// All materials.
    #[must_use]
    pub fn materials(&self) -> &[Elastic] {
        &self.materials
    }

    /// Units of forces, energies and masses: per metre of thickness where that is 1 m, as it is unless it is given.
    #[must_use]
    pub fn units(&self) -> Units {
        Units { per_metre: self.mesh.dimension() == 2 && self.materials.iter().all(|law| law.extent() == 1.0) }
    }

    /// Which of [`Model::materials`] each element has.
    #[must_use]
    pub fn element_material(&self) -> &[u16] {
        &self.element_material
    }

    /// Lumped mass of each node (kg), eq. \[35\]: each element gives ρ|E|/(D+1) to each of its nodes.
    #[must_use]
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// All prescribed components of nodes, eq. \[4\], by node.
    #[must_use]
    pub fn prescribed(&self) -> &[PrescribedComponent] {
        &self.prescribed
    }

    /// Velocity tables of moving supports (m/s).
    #[must_use]
    pub fn motions(&self) -> &[Table] {
        &self.motions
    }

    /// Velocity of a prescribed component at an instant (m/s).
    #[must_use]
    pub fn prescribed_velocity(&self, which: &PrescribedComponent, t: f64) -> f64 {
        which.motion.map_or(0.0, |m| self.motions[m].at(t)[0])
    }

    /// Tables of the tractions (Pa).
    #[must_use]
    pub fn traction_tables(&self) -> &[Table] {
        &self.traction_tables
    }

    /// Body forces.
    #[must_use]
    pub fn body_loads(&self) -> &[BodyLoad] {
        &self.body_loads
    }

    /// Δt_c (s), made at first use.
    pub(crate) fn critical_step(&self, make: impl FnOnce() -> f64) -> f64 {
        *self.critical_step.get_or_init(make)
    }

    /// Volume of an element with section or thickness (m³).
    #[must_use]
    pub fn volume(&self, element: ElementId) -> f64 {
        self.mesh.volume(element) * self.material(element).extent()
    }

    /// Area of a boundary face with section or thickness (m²).
    #[must_use]
    pub fn face_area(&self, face: FaceId) -> f64 {
        let owner = self.mesh.face(face).owner;
        self.mesh.face_normal(face).1 * self.material(owner).extent()
    }

    /// Distances below this count as touching (m): 1e-12 of the body's size, so that landing
    /// exactly on an obstacle does not depend on rounding.
    #[must_use]
    pub fn contact_tolerance(&self) -> f64 {
        1e-12 * self.mesh.size()
    }

    /// How far the loads and motions that are solved, with their values at the instants joined by
    /// straight lines, are from the tables: the largest relative difference.
    #[must_use]
    pub fn resampling_error(&self, instants: &[f64]) -> f64 {
        let motions = self.motions.iter().map(|t| t.resampling_error(instants));
        let tractions = self.traction_tables.iter().map(|t| t.resampling_error(instants));
        let forces = self.body_loads.iter().map(|l| l.value.resampling_error(instants));
        motions.chain(tractions).chain(forces).fold(0.0, f64::max)
    }

    /// The planes that [`Problem::with_planes_moved`](super::Problem::with_planes_moved) has moved.
    #[must_use]
    pub fn moved_planes(&self) -> &[MovedPlane] {
        &self.moved_planes
    }
}
