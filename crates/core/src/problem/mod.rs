//! The reference problem, eq. \[3\]–\[11\], stated and checked.

mod alignment;
mod any;
mod bodies;
mod boundary;
mod builder;
mod candidates;
mod contacts;
mod distance;
mod error;
mod facing_edges;
mod gaps;
mod joined;
mod may_touch;
mod model;
mod moved_planes;
mod non_matching;
mod pairs;
mod plausibility;
mod renumber;
mod rigid_motion;
mod roles;
mod sides;
mod start_of_contact;
mod statement;
pub(crate) mod symmetry;

pub use any::{AnyContactFace, AnyFaceLoad, AnyProblem, ProblemRef};
pub use bodies::{Between, Contact};
pub use builder::{Builder, Conditions, Initial};
pub use error::{Cause, GroupOf, HeldBy, InputError, Place};
pub use model::Model;
pub use moved_planes::MovedPlane;
pub use plausibility::{
    PlausibilityWarning, RefusedStart, SMALL_ROTATION, cause_of_refused_start, plausibility_warnings,
};
pub use rigid_motion::RigidMotion;
pub use statement::Statement;

use crate::contact::{ContactConfiguration, ContactSurface, Interface, Obstacle};
use crate::ids::{ElementId, FaceId, NodeId};
use crate::load::Table;
use crate::material::VonMises;
use crate::mesh::Mesh;
use std::ops::Deref;
use std::sync::Arc;

/// One component of a node's motion that is prescribed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrescribedComponent {
    /// The node.
    pub node: NodeId,
    /// Which global component.
    pub component: usize,
    /// Its velocity table among [`Model::motions`]; `None` is at rest.
    pub motion: Option<usize>,
}

/// A traction on one face.
#[derive(Clone, Copy, Debug)]
pub struct FaceLoad<const D: usize> {
    /// The face.
    pub face: FaceId,
    /// Factor at each of the face's nodes.
    pub profile: [f64; D],
    /// The table of the traction among [`Model::traction_tables`].
    pub table: usize,
}

/// A body force on part of the mesh.
#[derive(Clone, Debug)]
pub struct BodyLoad {
    /// Force per volume over time (N/m³).
    pub value: Table,
    /// Per node, the volume on which it acts (m³).
    pub nodal_volume: Vec<(NodeId, f64)>,
}

/// An elastic body that may strike rigid obstacles, with its supports and loads, checked.
#[derive(Clone, Debug)]
pub struct Problem<const D: usize> {
    model: Model,
    initial_displacement: Vec<[f64; D]>,
    initial_velocity: Vec<[f64; D]>,
    supported: Vec<[bool; D]>,
    face_loads: Vec<FaceLoad<D>>,
    surface: ContactSurface<D>,
}

impl<const D: usize> Deref for Problem<D> {
    type Target = Model;

    #[inline]
    fn deref(&self) -> &Model {
        &self.model
    }
}

impl<const D: usize> Problem<D> {
    /// Starts the statement of a problem on a mesh.
    #[must_use]
    pub fn builder(mesh: impl Into<Arc<Mesh>>) -> Builder<D> {
        Builder::new(mesh.into())
    }

    /// The two obstacles of each interface, in the order of the interfaces: those that are no planes, two by two.
    pub fn sides_of_interfaces(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        (self.planes()..self.obstacles().len()).step_by(2).map(|side| [side, side + 1])
    }

    /// u₀ at the nodes (m), eq. \[6\].
    #[must_use]
    pub fn initial_displacement(&self) -> &[[f64; D]] {
        &self.initial_displacement
    }

    /// v₀ at the nodes (m/s), eq. \[7\].
    #[must_use]
    pub fn initial_velocity(&self) -> &[[f64; D]] {
        &self.initial_velocity
    }

    /// Which components of a face are supported.
    #[inline]
    #[must_use]
    pub fn supported(&self, face: FaceId) -> [bool; D] {
        self.supported[face.index()]
    }

    /// Tractions on faces.
    #[must_use]
    pub fn face_loads(&self) -> &[FaceLoad<D>] {
        &self.face_loads
    }

    /// Force per volume on each element at an instant (N/m³); empty if there is none anywhere.
    #[must_use]
    pub fn body_force_at(&self, t: f64) -> Vec<[f64; D]> {
        let values: Vec<_> = self.body_loads.iter().map(|load| load.value.at(t)).collect();
        let sum = |loads: &Vec<u16>| {
            let mut total = [0.0; D];
            for &load in loads {
                for c in 0..D {
                    total[c] += values[usize::from(load)][c];
                }
            }
            total
        };
        self.element_body_loads.iter().map(sum).collect()
    }

    /// ∫∫σ:ε̇_p dt (J) until these internal variables of all elements, in rows; 0 where no material yields.
    #[must_use]
    pub fn plastic_work(&self, internal: &[f64]) -> f64 {
        if internal.is_empty() {
            return 0.0;
        }
        let laws = self.yielding_laws();
        let rows = internal.chunks_exact(VonMises::count(D)).zip(self.element_material());
        let each = rows.enumerate().map(|(e, (row, &law))| {
            let [stored, dissipated] = laws[usize::from(law)].plastic_energies::<f64, D>(row);
            self.volume(ElementId::new(e)) * (stored + dissipated)
        });
        each.sum()
    }

    /// Forces of the tractions and body forces at an instant (N).
    pub fn external_forces(&self, t: f64, force: &mut [[f64; D]]) {
        force.fill([0.0; D]);
        for load in &self.face_loads {
            let area = self.face_area(load.face);
            let moments = Self::face_moments(area, &self.face_traction_at(load, t));
            let nodes = self.mesh.face_nodes::<D>(load.face);
            for (node, moment) in nodes.iter().zip(moments) {
                (0..D).for_each(|c| force[node.index()][c] += moment[c]);
            }
        }
        for load in &self.body_loads {
            let value = load.value.at(t);
            for (node, volume) in &load.nodal_volume {
                (0..D).for_each(|c| force[node.index()][c] += volume * value[c]);
            }
        }
    }

    /// Whether any traction or body force acts.
    #[must_use]
    pub fn is_loaded(&self) -> bool {
        !self.face_loads.is_empty() || !self.body_loads.is_empty()
    }

    /// The obstacles.
    #[must_use]
    pub fn obstacles(&self) -> &[Obstacle<D>] {
        self.surface.obstacles()
    }

    /// Whether an obstacle is a plane or the first side of two surfaces that may touch.
    #[must_use]
    pub fn leads_interface(&self, obstacle: usize) -> bool {
        let nodes = self.surface.nodes();
        let first = nodes.iter().position(|contact| contact.obstacle == obstacle);
        first.is_none_or(|at| self.surface.is_of_first(at))
    }

    fn planes(&self) -> usize {
        self.obstacles().iter().filter(|obstacle| obstacle.as_plane().is_some()).count()
    }

    /// Of two surfaces that may touch, each is an obstacle: the other one of the two; none for a plane.
    #[must_use]
    pub fn partner_obstacle(&self, obstacle: usize) -> Option<usize> {
        let planes = self.planes();
        obstacle.checked_sub(planes).map(|after| planes + (after ^ 1))
    }

    /// Of a non-matching interface, of which an obstacle is one side, the side on whose nodes contact acts; else the
    /// obstacle.
    #[must_use]
    pub fn slave_of(&self, obstacle: usize) -> usize {
        let first = self.surface.nodes().iter().position(|contact| contact.obstacle == obstacle);
        let is_master = |at: &usize| {
            let non_matching =
                self.surface.non_matching_of(*at).map(|non_matching| &self.surface.non_matching()[non_matching]);
            non_matching.is_some_and(|non_matching| non_matching.slave().node_at(*at).is_none())
        };
        first.filter(is_master).and_then(|_| self.partner_obstacle(obstacle)).unwrap_or(obstacle)
    }

    /// The two surfaces that may touch of which an obstacle is one; none for a plane.
    #[must_use]
    pub fn interface_of(&self, obstacle: usize) -> Option<&Interface> {
        obstacle.checked_sub(self.planes()).map(|after| &self.stated.interfaces[after / 2])
    }

    /// Where an obstacle is stated: a plane, or two surfaces of different bodies.
    #[must_use]
    pub fn place_of_obstacle(&self, obstacle: usize) -> Place {
        match obstacle.checked_sub(self.planes()) {
            None => Place { table: "obstacle", index: Some(obstacle), key: "point" },
            // Each of the two is an obstacle of the other.
            Some(after) => self.contacts[after / 2],
        }
    }

    /// The pairs of nodes of two bodies that face each other, of each interface with such pairs.
    #[must_use]
    pub fn facing_nodes(&self) -> Vec<Vec<[NodeId; 2]>> {
        let (nodes, obstacles) = (self.surface.nodes(), 0..self.surface.obstacles().len());
        let of = |obstacle: usize| {
            let contacts = nodes.iter().filter(|contact| contact.obstacle == obstacle);
            contacts.filter_map(|contact| Some([contact.node, nodes[contact.partner?].node])).collect::<Vec<_>>()
        };
        let leading = obstacles.filter(|obstacle| self.leads_interface(*obstacle));
        leading.map(of).filter(|pairs| !pairs.is_empty()).collect()
    }

    /// The part of the boundary that may touch an obstacle.
    #[must_use]
    pub fn surface(&self) -> &ContactSurface<D> {
        &self.surface
    }

    /// Gap (m), eq. \[3\], and normal velocity (m/s) of a node of the contact surface at the start.
    #[must_use]
    pub fn start_of_contact(&self, at: usize) -> (f64, f64) {
        self.start_of(at, &self.surface.configuration(&self.initial_displacement))
    }

    /// The same of all its nodes.
    #[must_use]
    pub fn starts_of_contact(&self) -> Vec<(f64, f64)> {
        let configuration = self.surface.configuration(&self.initial_displacement);
        (0..self.surface.nodes().len()).map(|at| self.start_of(at, &configuration)).collect()
    }

    fn start_of(&self, at: usize, configuration: &ContactConfiguration<'_, D>) -> (f64, f64) {
        let displacement = configuration.relative(at, &self.initial_displacement);
        let velocity = configuration.relative(at, &self.initial_velocity);
        let normal = self.surface.frame(at, &displacement).split(&velocity).0;
        (configuration.gap(at, &self.initial_displacement), normal)
    }

    /// The candidate node of an obstacle with the smallest gap at the start, as its position in the surface, and that
    /// gap (m). None without candidates, or if none of them faces anything.
    #[must_use]
    pub fn nearest(&self, obstacle: usize) -> Option<(usize, f64)> {
        let configuration = self.surface.configuration(&self.initial_displacement);
        let nodes = self.surface.nodes().iter().enumerate();
        let candidates = nodes.filter(|(_, c)| c.obstacle == obstacle && c.free);
        let gaps =
            candidates.map(|(at, _)| (at, self.start_of(at, &configuration).0)).filter(|(_, gap)| gap.is_finite());
        gaps.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The smallest gap of the candidate nodes of an obstacle at the start (m), eq. \[3\].
    #[must_use]
    pub fn initial_gap(&self, obstacle: usize) -> f64 {
        self.nearest(obstacle).map_or(f64::INFINITY, |(_, gap)| gap)
    }

    /// Normal speeds below this count as zero at the start (m/s): 1e-12 of the largest speed, so that
    /// sliding along a tilted plane does not depend on rounding.
    #[must_use]
    pub fn speed_tolerance(&self) -> f64 {
        1e-12 * self.initial_velocity.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()))
    }

    /// Moments ∫ F φ_i (N) on a face of area `area` of a density that is linear with these nodal values (Pa).
    #[inline]
    #[must_use]
    pub fn face_moments(area: f64, density: &[[f64; D]; D]) -> [[f64; D]; D] {
        let mut moments = [[0.0; D]; D];
        let factor = area / (D * (D + 1)) as f64;
        for c in 0..D {
            let sum: f64 = density.iter().map(|f| f[c]).sum();
            for i in 0..D {
                moments[i][c] = factor * (density[i][c] + sum);
            }
        }
        moments
    }

    /// The traction on a loaded face's nodes at an instant (Pa).
    #[must_use]
    pub fn face_traction_at(&self, load: &FaceLoad<D>, t: f64) -> [[f64; D]; D] {
        let value = self.traction_tables[load.table].at(t);
        load.profile.map(|factor| std::array::from_fn(|c| factor * value[c]))
    }
}
