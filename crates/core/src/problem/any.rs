//! A problem of any dimension, as other crates see it.

use super::{FaceLoad, InputError, Model, Place, Problem, Statement, statement};
use crate::border::{Vector, padded, vectors};
use crate::cell::CellKind;
use crate::contact::{AnyContactConfiguration, AnyObstacle, ContactFace, ContactNode, Frame, Interface};
use crate::ids::{FaceId, NodeId};
use crate::mesh::{Mesh, Numbering};
use std::any::Any;
use std::ops::Deref;
use std::sync::Arc;

/// A checked problem of any dimension, shared. Fields are in rows, as [`border`](crate::border) says.
#[derive(Clone, Debug)]
pub enum AnyProblem {
    /// Of a bar.
    D1(Arc<Problem<1>>),
    /// Of a plane body.
    D2(Arc<Problem<2>>),
    /// Of a solid.
    D3(Arc<Problem<3>>),
}

/// A reference to a problem of any dimension; simulation and estimate take one.
#[derive(Clone, Copy, Debug)]
pub enum ProblemRef<'p> {
    /// Of a bar.
    D1(&'p Problem<1>),
    /// Of a plane body.
    D2(&'p Problem<2>),
    /// Of a solid.
    D3(&'p Problem<3>),
}

/// Does the same with a problem in each dimension.
#[macro_export]
macro_rules! on_problem {
    ($reference:expr, $problem:pat => $body:expr) => {
        match $reference {
            $crate::problem::ProblemRef::D1($problem) => $body,
            $crate::problem::ProblemRef::D2($problem) => $body,
            $crate::problem::ProblemRef::D3($problem) => $body,
        }
    };
}

impl<'p> From<&'p AnyProblem> for ProblemRef<'p> {
    fn from(any: &'p AnyProblem) -> Self {
        match any {
            AnyProblem::D1(problem) => Self::D1(problem),
            AnyProblem::D2(problem) => Self::D2(problem),
            AnyProblem::D3(problem) => Self::D3(problem),
        }
    }
}

impl<'p, const D: usize> From<&'p Problem<D>> for ProblemRef<'p> {
    fn from(problem: &'p Problem<D>) -> Self {
        let any = problem as &dyn Any;
        let plane = || any.downcast_ref().map(Self::D2);
        let found = any.downcast_ref().map(Self::D1).or_else(plane).or_else(|| any.downcast_ref().map(Self::D3));
        let Some(found) = found else { unreachable!("problems are of bars, triangles or tetrahedra") };
        found
    }
}

impl<'p> ProblemRef<'p> {
    /// The problem with its dimension; none if it has another one.
    #[must_use]
    pub fn typed<const D: usize>(self) -> Option<&'p Problem<D>> {
        on_problem!(self, problem => (problem as &dyn Any).downcast_ref())
    }
}

impl From<Problem<1>> for AnyProblem {
    fn from(problem: Problem<1>) -> Self {
        Self::D1(Arc::new(problem))
    }
}

impl From<Problem<2>> for AnyProblem {
    fn from(problem: Problem<2>) -> Self {
        Self::D2(Arc::new(problem))
    }
}

impl From<Problem<3>> for AnyProblem {
    fn from(problem: Problem<3>) -> Self {
        Self::D3(Arc::new(problem))
    }
}

/// A face of the contact surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyContactFace<'p> {
    /// The face of the mesh.
    pub face: FaceId,
    /// Its nodes, as positions in the contact surface.
    pub nodes: &'p [usize],
    /// Its area (m²).
    pub area: f64,
    /// Which obstacle it may touch.
    pub obstacle: usize,
}

/// A traction on one face.
#[derive(Clone, Copy, Debug)]
pub struct AnyFaceLoad<'p> {
    /// The face.
    pub face: FaceId,
    /// Factor at each of its nodes.
    pub profile: &'p [f64],
    /// Its table among [`Model::traction_tables`].
    pub table: usize,
}

impl Deref for AnyProblem {
    type Target = Model;

    #[inline]
    fn deref(&self) -> &Model {
        on_problem!(ProblemRef::from(self), problem => problem)
    }
}

impl AnyProblem {
    /// Checks what is stated and builds the problem.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn new(mesh: &Arc<Mesh>, stated: &Statement) -> Result<Self, InputError> {
        match mesh.kind() {
            CellKind::Bar => statement::build::<1>(mesh, stated).map(Self::from),
            CellKind::Triangle => statement::build::<2>(mesh, stated).map(Self::from),
            CellKind::Tetrahedron => statement::build::<3>(mesh, stated).map(Self::from),
        }
    }

    /// 1 for bars, 2 for plane bodies, 3 for solids.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.mesh().dimension()
    }

    /// The two obstacles of each interface: [`Problem::sides_of_interfaces`].
    #[must_use]
    pub fn sides_of_interfaces(&self) -> Vec<[usize; 2]> {
        on_problem!(ProblemRef::from(self), problem => problem.sides_of_interfaces().collect())
    }

    /// u₀ at the nodes (m), in rows.
    #[must_use]
    pub fn initial_displacement(&self) -> &[f64] {
        on_problem!(ProblemRef::from(self), problem => problem.initial_displacement().as_flattened())
    }

    /// v₀ at the nodes (m/s), in rows.
    #[must_use]
    pub fn initial_velocity(&self) -> &[f64] {
        on_problem!(ProblemRef::from(self), problem => problem.initial_velocity().as_flattened())
    }

    /// Tractions on faces.
    #[must_use]
    pub fn face_loads(&self) -> Vec<AnyFaceLoad<'_>> {
        fn of<const D: usize>(load: &FaceLoad<D>) -> AnyFaceLoad<'_> {
            AnyFaceLoad { face: load.face, profile: &load.profile, table: load.table }
        }
        on_problem!(ProblemRef::from(self), problem => problem.face_loads().iter().map(of).collect())
    }

    /// Forces of the tractions and body forces at an instant (N), in rows.
    #[must_use]
    pub fn external_forces(&self, t: f64) -> Vec<f64> {
        on_problem!(ProblemRef::from(self), problem => {
            let mut force = vec![[0.0; _]; problem.mesh().node_count()];
            problem.external_forces(t, &mut force);
            force.into_flattened()
        })
    }

    /// Whether any traction or body force acts.
    #[must_use]
    pub fn is_loaded(&self) -> bool {
        on_problem!(ProblemRef::from(self), problem => problem.is_loaded())
    }

    /// Number of obstacles.
    #[must_use]
    pub fn obstacle_count(&self) -> usize {
        on_problem!(ProblemRef::from(self), problem => problem.obstacles().len())
    }

    /// An obstacle.
    #[must_use]
    pub fn obstacle(&self, obstacle: usize) -> AnyObstacle {
        on_problem!(ProblemRef::from(self), problem => problem.obstacles()[obstacle].clone().into())
    }

    /// All obstacles.
    pub fn obstacles(&self) -> impl ExactSizeIterator<Item = AnyObstacle> + '_ {
        (0..self.obstacle_count()).map(|obstacle| self.obstacle(obstacle))
    }

    /// Whether an obstacle is a plane or the first side of two surfaces that may touch.
    #[must_use]
    pub fn leads_interface(&self, obstacle: usize) -> bool {
        on_problem!(ProblemRef::from(self), problem => problem.leads_interface(obstacle))
    }

    /// The other one of the two obstacles of an interface: [`Problem::partner_obstacle`].
    #[must_use]
    pub fn partner_obstacle(&self, obstacle: usize) -> Option<usize> {
        on_problem!(ProblemRef::from(self), problem => problem.partner_obstacle(obstacle))
    }

    /// The obstacle on whose nodes contact acts: [`Problem::slave_of`].
    #[must_use]
    pub fn slave_of(&self, obstacle: usize) -> usize {
        on_problem!(ProblemRef::from(self), problem => problem.slave_of(obstacle))
    }

    /// The two surfaces that may touch of which an obstacle is one; none for a plane.
    #[must_use]
    pub fn interface_of(&self, obstacle: usize) -> Option<&Interface> {
        on_problem!(ProblemRef::from(self), problem => problem.interface_of(obstacle))
    }

    /// Where an obstacle is stated.
    #[must_use]
    pub fn place_of_obstacle(&self, obstacle: usize) -> Place {
        on_problem!(ProblemRef::from(self), problem => problem.place_of_obstacle(obstacle))
    }

    /// The pairs of nodes of two bodies that face each other, of each interface with such pairs.
    #[must_use]
    pub fn facing_nodes(&self) -> Vec<Vec<[NodeId; 2]>> {
        on_problem!(ProblemRef::from(self), problem => problem.facing_nodes())
    }

    /// The nodes of the contact surface, in its order: rows of reactions and touching status.
    #[must_use]
    pub fn contact_nodes(&self) -> &[ContactNode] {
        on_problem!(ProblemRef::from(self), problem => problem.surface().nodes())
    }

    /// The faces of the contact surface.
    #[must_use]
    pub fn contact_faces(&self) -> Vec<AnyContactFace<'_>> {
        fn of<const D: usize>(face: &ContactFace<D>) -> AnyContactFace<'_> {
            let &ContactFace { face, ref nodes, area, obstacle } = face;
            AnyContactFace { face, nodes, area, obstacle }
        }
        on_problem!(ProblemRef::from(self), problem => problem.surface().faces().iter().map(of).collect())
    }

    /// The place of a node of the contact surface in the undeformed body (m).
    #[must_use]
    pub fn contact_point(&self, at: usize) -> Vector {
        on_problem!(ProblemRef::from(self), problem => padded(problem.surface().point(at)))
    }

    /// ℓ_k of each node of the contact surface (m²), eq. \[45\].
    #[must_use]
    pub fn tributary_areas(&self) -> Vec<f64> {
        on_problem!(ProblemRef::from(self), problem => problem.surface().tributary_areas())
    }

    /// Number of interfaces whose nodes do not face each other.
    #[must_use]
    pub fn non_matching_count(&self) -> usize {
        on_problem!(ProblemRef::from(self), problem => problem.surface().non_matching().len())
    }

    /// Of a node of the contact surface, the interface whose nodes do not face each other.
    #[must_use]
    pub fn non_matching_of(&self, at: usize) -> Option<usize> {
        on_problem!(ProblemRef::from(self), problem => problem.surface().non_matching_of(at))
    }

    /// The positions in the contact surface of the two sides of an interface whose nodes do not face each other: slave
    /// and master.
    #[must_use]
    pub fn sides_of_non_matching(&self, non_matching: usize) -> [Vec<usize>; 2] {
        on_problem!(ProblemRef::from(self), problem => {
            let sides = &problem.surface().non_matching()[non_matching];
            [sides.slave(), sides.master()].map(|side| (0..side.len()).map(|node| side.position(node)).collect())
        })
    }

    /// Whether a node of the contact surface is on the slave of an interface whose nodes do not face each other.
    #[must_use]
    pub fn is_slave(&self, at: usize) -> bool {
        on_problem!(ProblemRef::from(self), problem => {
            problem.surface().non_matching().iter().any(|sides| sides.slave().node_at(at).is_some())
        })
    }

    /// Whether the contact condition of a node is its own: [`crate::contact::ContactSurface::leads`].
    #[must_use]
    pub fn leads(&self, at: usize) -> bool {
        on_problem!(ProblemRef::from(self), problem => problem.surface().leads(at))
    }

    /// The mass that a contact force moves (kg): [`crate::contact::ContactSurface::moved_mass`].
    #[must_use]
    pub fn moved_mass(&self, at: usize) -> f64 {
        on_problem!(ProblemRef::from(self), problem => problem.surface().moved_mass(at, problem.mass()))
    }

    /// The frame of a node of the contact surface.
    #[must_use]
    pub fn frame(&self, at: usize) -> Frame<3> {
        self.obstacle(self.contact_nodes()[at].obstacle).frame()
    }

    /// What the nodes of the contact surface face with these displacements (m), in rows.
    #[must_use]
    pub fn configuration(&self, displacement: &[f64]) -> AnyContactConfiguration<'_> {
        match self {
            Self::D1(problem) => AnyContactConfiguration::D1(problem.surface().configuration(vectors(displacement))),
            Self::D2(problem) => AnyContactConfiguration::D2(problem.surface().configuration(vectors(displacement))),
            Self::D3(problem) => AnyContactConfiguration::D3(problem.surface().configuration(vectors(displacement))),
        }
    }

    /// Gap (m) and normal velocity (m/s) of all nodes of the contact surface at the start.
    #[must_use]
    pub fn starts_of_contact(&self) -> Vec<(f64, f64)> {
        on_problem!(ProblemRef::from(self), problem => problem.starts_of_contact())
    }

    /// The candidate node of an obstacle with the smallest gap at the start: [`Problem::nearest`].
    #[must_use]
    pub fn nearest(&self, obstacle: usize) -> Option<(usize, f64)> {
        on_problem!(ProblemRef::from(self), problem => problem.nearest(obstacle))
    }

    /// The smallest gap of the candidate nodes of an obstacle at the start (m).
    #[must_use]
    pub fn initial_gap(&self, obstacle: usize) -> f64 {
        on_problem!(ProblemRef::from(self), problem => problem.initial_gap(obstacle))
    }

    /// Which components of a face are supported.
    #[must_use]
    pub fn supported(&self, face: FaceId) -> &[bool] {
        on_problem!(ProblemRef::from(self), problem => &problem.supported[face.index()])
    }

    /// Whether each node of the contact surface is on a line of symmetry: [`Problem::on_lines_of_symmetry`].
    #[must_use]
    pub fn on_lines_of_symmetry(&self) -> Vec<bool> {
        on_problem!(ProblemRef::from(self), problem => problem.on_lines_of_symmetry())
    }

    /// Normal speeds below this count as zero at the start (m/s).
    #[must_use]
    pub fn speed_tolerance(&self) -> f64 {
        on_problem!(ProblemRef::from(self), problem => problem.speed_tolerance())
    }

    /// Refuses a body that starts on a plane and moves into it.
    ///
    /// # Errors
    /// As [`Problem::check_planes`].
    pub fn check_planes(&self) -> Result<(), InputError> {
        on_problem!(ProblemRef::from(self), problem => problem.check_planes())
    }

    /// The problem with planes moved away that a body is on and moves into: [`Problem::with_planes_moved`].
    #[must_use]
    pub fn with_planes_moved(&self, step: f64) -> Option<Self> {
        on_problem!(ProblemRef::from(self), problem => problem.with_planes_moved(step).map(Self::from))
    }

    /// The problem under other numbers of nodes and elements: [`Problem::renumbered`].
    #[must_use]
    pub fn renumbered(&self, numbering: &Numbering) -> Self {
        on_problem!(ProblemRef::from(self), problem => problem.renumbered(numbering).into())
    }
}
