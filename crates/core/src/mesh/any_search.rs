//! Bisection of a mesh and the search for points in it, in either dimension.

use super::any::AnyMesh;
use super::{Bisection, Locator, MeshError};
use crate::border::{Vector, cut, vectors};
use crate::ids::{ElementId, NodeId};

/// Bisection of a mesh of either dimension.
#[derive(Clone, Debug)]
pub enum AnyBisection {
    /// Of a bar.
    D1(Bisection<1, 2>),
    /// Of a plane body.
    D2(Bisection<2, 3>),
}

impl AnyBisection {
    /// As [`Bisection::new`].
    #[must_use]
    pub fn new(mesh: &AnyMesh, interfaces: &[Vec<[NodeId; 2]>]) -> Self {
        match mesh {
            AnyMesh::D1(mesh) => Self::D1(Bisection::new(mesh.clone(), interfaces)),
            AnyMesh::D2(mesh) => Self::D2(Bisection::new(mesh.clone(), interfaces)),
        }
    }

    /// The mesh so far.
    #[must_use]
    pub fn mesh(&self) -> AnyMesh {
        match self {
            Self::D1(bisection) => AnyMesh::D1(bisection.mesh().clone()),
            Self::D2(bisection) => AnyMesh::D2(bisection.mesh().clone()),
        }
    }

    /// Cuts chosen elements in two: [`Bisection::cut`].
    ///
    /// # Errors
    /// Too many elements.
    pub fn cut(&mut self, chosen: impl Fn(ElementId) -> bool) -> Result<(), MeshError> {
        match self {
            Self::D1(bisection) => bisection.cut(chosen),
            Self::D2(bisection) => bisection.cut(chosen),
        }
    }
}

/// Finds the element of a point in a mesh of either dimension.
#[derive(Clone, Debug)]
pub enum AnyLocator<'m> {
    /// In a bar.
    D1(Locator<'m, 1, 2>),
    /// In a plane body.
    D2(Locator<'m, 2, 3>),
}

impl<'m> AnyLocator<'m> {
    /// Of all elements of a mesh.
    #[must_use]
    pub fn new(mesh: &'m AnyMesh) -> Self {
        match mesh {
            AnyMesh::D1(mesh) => Self::D1(Locator::new(mesh)),
            AnyMesh::D2(mesh) => Self::D2(Locator::new(mesh)),
        }
    }

    /// Of each body.
    #[must_use]
    pub fn of_bodies(mesh: &'m AnyMesh) -> Vec<Self> {
        match mesh {
            AnyMesh::D1(mesh) => Locator::of_bodies(mesh).into_iter().map(Self::D1).collect(),
            AnyMesh::D2(mesh) => Locator::of_bodies(mesh).into_iter().map(Self::D2).collect(),
        }
    }

    /// The element that contains a point.
    #[must_use]
    pub fn element_at(&self, point: &Vector) -> Option<ElementId> {
        match self {
            Self::D1(locator) => locator.element_at(&cut(point)),
            Self::D2(locator) => locator.element_at(&cut(point)),
        }
    }

    /// The element next to a point.
    #[must_use]
    pub fn element_near(&self, point: &Vector) -> ElementId {
        match self {
            Self::D1(locator) => locator.element_near(&cut(point)),
            Self::D2(locator) => locator.element_near(&cut(point)),
        }
    }

    /// A nodal field at points, both in rows: [`Locator::values_at`].
    #[must_use]
    pub fn values_at(&self, nodal: &[f64], points: &[f64]) -> Vec<f64> {
        match self {
            Self::D1(locator) => locator.values_at(vectors(nodal), vectors(points)).into_flattened(),
            Self::D2(locator) => locator.values_at(vectors(nodal), vectors(points)).into_flattened(),
        }
    }
}
