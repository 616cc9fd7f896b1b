//! Meshes from rows of numbers, as they come from files and other languages.

use super::{ElementGroups, FaceRows, Mesh, MeshError, Parts};

impl Mesh {
    /// Builds and checks a mesh of bars (dimension 1), triangles (2) or tetrahedra (3), from coordinates (m), nodes of
    /// the elements and groups, in rows: [`Mesh::new`].
    ///
    /// # Errors
    /// As [`Mesh::new`].
    ///
    /// # Panics
    /// For another dimension.
    pub fn from_rows(
        dimension: usize,
        points: &[f64],
        cells: &[usize],
        groups: (&FaceRows, &ElementGroups),
    ) -> Result<Self, MeshError> {
        Self::of(dimension, points, cells, groups, Parts::Apart)
    }

    /// The same of bodies that may touch: [`Mesh::of_bodies`].
    ///
    /// # Errors
    /// As [`Mesh::of_bodies`].
    ///
    /// # Panics
    /// For another dimension.
    pub fn bodies_from_rows(
        dimension: usize,
        points: &[f64],
        cells: &[usize],
        groups: (&FaceRows, &ElementGroups),
    ) -> Result<Self, MeshError> {
        Self::of(dimension, points, cells, groups, Parts::MayTouch)
    }

    pub(super) fn of(
        dimension: usize,
        points: &[f64],
        cells: &[usize],
        groups: (&FaceRows, &ElementGroups),
        parts: Parts,
    ) -> Result<Self, MeshError> {
        match dimension {
            1 => Self::checked::<1, 2>(points.as_chunks().0.to_vec(), cells.as_chunks().0, groups, parts),
            2 => Self::checked::<2, 3>(points.as_chunks().0.to_vec(), cells.as_chunks().0, groups, parts),
            3 => Self::checked::<3, 4>(points.as_chunks().0.to_vec(), cells.as_chunks().0, groups, parts),
            other => unreachable!("a mesh of dimension {other}"),
        }
    }
}
