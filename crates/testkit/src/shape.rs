//! Quality of the triangles.

use percute_core::ids::ElementId;
use percute_core::mesh::Mesh;

/// Smallest angle of any triangle (degrees).
#[must_use]
pub fn smallest_angle(mesh: &Mesh) -> f64 {
    let elements = (0..mesh.element_count()).map(ElementId::new);
    elements.map(|e| smallest_of(&mesh.corners::<2, 3>(e))).fold(f64::INFINITY, f64::min)
}

/// Smallest angle of one triangle (degrees).
pub(crate) fn smallest_of(corners: &[[f64; 2]; 3]) -> f64 {
    let angle = |k: usize| {
        let (p, a, b) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
        let (a, b) = ([a[0] - p[0], a[1] - p[1]], [b[0] - p[0], b[1] - p[1]]);
        (a[0] * b[1] - a[1] * b[0]).abs().atan2(a[0] * b[0] + a[1] * b[1])
    };
    (0..3).map(angle).fold(f64::INFINITY, f64::min).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known triangles; atan2 is right to a few units in the last place.
    #[test]
    fn known_angles() {
        let close = |corners: &[[f64; 2]; 3], degrees: f64| (smallest_of(corners) - degrees).abs() < 1e-12;
        assert!(close(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], 45.0));
        assert!(close(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()]], 60.0));
        // Obtuse: 120° at the apex leaves 30° and 30°.
        assert!(close(&[[-(3.0_f64.sqrt()), 0.0], [3.0_f64.sqrt(), 0.0], [0.0, 1.0]], 30.0));
    }
}
