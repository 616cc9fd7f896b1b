//! Nested finer meshes, for true errors.

use crate::image::Parts;
use percute_core::mesh::{MeshError, TriangleMesh};
use std::collections::BTreeMap;

/// The mesh with each triangle cut into four by the middles of its edges. The nodes keep their numbers, element e becomes
/// the elements 4 e to 4 e + 3, and groups name the same edges and elements as before.
///
/// # Errors
/// None that the mesh did not have.
pub fn refined(mesh: &TriangleMesh) -> Result<TriangleMesh, MeshError> {
    let mut parts = Parts::of(mesh);
    let mut middles = BTreeMap::new();
    let points = &mut parts.points;
    let mut middle = |a: usize, b: usize| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let (p, q) = (points[a], points[b]);
            points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
            points.len() - 1
        })
    };
    parts.cells = parts
        .cells
        .iter()
        .flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        })
        .collect();
    for edges in parts.facet_groups.values_mut() {
        *edges = edges.iter().flat_map(|&[a, b]| [[a, middle(a, b)], [middle(a, b), b]]).collect();
    }
    for elements in parts.element_groups.values_mut() {
        *elements = elements.iter().flat_map(|e| 4 * e..4 * e + 4).collect();
    }
    parts.mesh()
}
