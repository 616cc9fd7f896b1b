//! How well edges are aligned with an interface.

use crate::border::Vector;
use crate::contact::dot;
use crate::ids::FaceId;
use crate::mesh::Mesh;

/// An edge is at least this well aligned with the interface: the cosine of its normal and the common one.
pub(super) const FACES: f64 = 0.5;
/// Edges that are found are better aligned, so that rounding does not refuse them.
pub(super) const FOUND: f64 = FACES + 1e-9;

/// A vector of length 1.
pub(super) fn unit<const D: usize>(vector: &[f64; D]) -> [f64; D] {
    let length = dot(vector, vector).sqrt();
    vector.map(|x| x / length)
}

/// Σ of outward normals times areas of faces (m or 1).
pub(super) fn outward(mesh: &Mesh, faces: &[FaceId]) -> Vector {
    let mut sum = [0.0; 3];
    for &face in faces {
        let (normal, area) = mesh.face_normal(face);
        (0..3).for_each(|c| sum[c] += area * normal[c]);
    }
    sum
}
