//! A mesh to draw.

use percute_core::mesh::{AnyMesh, Mesh};
use percute_core::{each_dimension, ids::NodeId};

/// A mesh in the plane; a bar lies on the axis x.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// 1 (bars) or 2 (triangles).
    pub(crate) dimension: usize,
    /// Coordinates of the nodes (m).
    pub(crate) points: Vec<[f64; 2]>,
    /// Nodes of the elements, one element after the other.
    cells: Vec<usize>,
    /// Names of the groups of edges and of elements, and their members.
    pub(crate) groups: [Vec<(String, usize)>; 2],
}

impl Body {
    /// That of a mesh.
    #[must_use]
    pub fn new<const D: usize, const N: usize>(mesh: &Mesh<D, N>) -> Self {
        let point = |p: &[f64; D]| [p[0], p.get(1).copied().unwrap_or(0.0)];
        let facets = mesh.facet_groups().iter().map(|(name, members)| (name.clone(), members.len()));
        let elements = mesh.element_groups().iter().map(|(name, members)| (name.clone(), members.len()));
        Self {
            dimension: D,
            points: mesh.points().iter().map(point).collect(),
            cells: mesh.cells().as_flattened().iter().copied().map(NodeId::index).collect(),
            groups: [facets.collect(), elements.collect()],
        }
    }

    /// That of a mesh of either dimension.
    #[must_use]
    pub fn of(mesh: &AnyMesh) -> Self {
        each_dimension!(mesh, mesh => Self::new(mesh))
    }

    /// Number of elements.
    pub(crate) fn elements(&self) -> usize {
        self.cells.len() / (self.dimension + 1)
    }

    /// Corners of an element (m).
    pub(crate) fn corners(&self, element: usize) -> impl Iterator<Item = [f64; 2]> {
        let count = self.dimension + 1;
        self.cells[element * count..(element + 1) * count].iter().map(|&node| self.points[node])
    }

    /// Corners of the bounding box (m).
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        let extreme = |pick: fn(f64, f64) -> f64| {
            [0, 1].map(|c| self.points.iter().map(|p| p[c]).reduce(pick).unwrap_or_default())
        };
        [extreme(f64::min), extreme(f64::max)]
    }

    /// Mean edge of a square with the area of an element (m), of a bar its mean length.
    pub(crate) fn mean_size(&self) -> f64 {
        let size = |e: usize| {
            let c: Vec<[f64; 2]> = self.corners(e).collect();
            let side = |k: usize| [c[k][0] - c[0][0], c[k][1] - c[0][1]];
            if self.dimension == 1 {
                return side(1)[0].abs();
            }
            let (a, b) = (side(1), side(2));
            0.5 * (a[0] * b[1] - a[1] * b[0]).abs()
        };
        let mean = (0..self.elements()).map(size).sum::<f64>() / self.elements().max(1) as f64;
        if self.dimension == 1 { mean } else { mean.sqrt() }
    }
}
