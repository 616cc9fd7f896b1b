//! Volumes, gradients and normals of one simplex.

/// Volume and shape-function gradients of a P1 simplex.
#[derive(Clone, Copy, Debug)]
pub struct CellGeometry<const D: usize, const N: usize> {
    /// Length (m) in 1D, area (m²) in 2D; without section or thickness.
    pub volume: f64,
    /// ∇φ_i of each node (1/m); they sum to zero.
    pub gradients: [[f64; D]; N],
}

impl<const D: usize, const N: usize> CellGeometry<D, N> {
    /// Geometry of the simplex with these corners, positively oriented.
    #[must_use]
    pub fn new(points: &[[f64; D]; N]) -> Self {
        let volume = signed_volume(points);
        let mut gradients = [[0.0; D]; N];
        if D == 1 {
            gradients[1][0] = 1.0 / volume;
        } else {
            for k in 1..N {
                // Opposite edge turned by a quarter, over twice the area.
                let (a, b) = (&points[(k + 1) % N], &points[(k + 2) % N]);
                gradients[k][0] = (a[1] - b[1]) / (2.0 * volume);
                gradients[k][1] = (b[0] - a[0]) / (2.0 * volume);
            }
        }
        for c in 0..D {
            gradients[0][c] = -(1..N).map(|k| gradients[k][c]).sum::<f64>();
        }
        Self { volume, gradients }
    }

    /// Outward unit normal and measure of the facet opposite to local node `k`: −∇φ_k/|∇φ_k|
    /// and D·|E|·|∇φ_k|.
    #[must_use]
    pub fn facet_normal(&self, k: usize) -> ([f64; D], f64) {
        let norm = self.gradients[k].iter().map(|g| g * g).sum::<f64>().sqrt();
        (self.gradients[k].map(|g| -g / norm), D as f64 * self.volume * norm)
    }
}

/// Length or area, negative if the corners are in the wrong order.
pub(super) fn signed_volume<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> f64 {
    if D == 1 {
        return points[1][0] - points[0][0];
    }
    let edge = |k: usize, c: usize| points[k][c] - points[0][c];
    0.5 * (edge(1, 0) * edge(2, 1) - edge(2, 0) * edge(1, 1))
}

/// Largest distance between two corners.
pub(super) fn diameter<const D: usize, const N: usize>(points: &[[f64; D]; N]) -> f64 {
    let mut largest: f64 = 0.0;
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
            largest = largest.max(square.sqrt());
        }
    }
    largest
}

/// Diagonal of the box that encloses the points.
pub(super) fn bounding_box_diagonal<const D: usize>(points: &[[f64; D]]) -> f64 {
    let extent = |c: usize| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[c]), high.max(p[c])));
        (high - low) * (high - low)
    };
    (0..D).map(extent).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_reproduce_a_linear_field() {
        let points = [[0.1, 0.2], [1.3, 0.4], [0.3, 0.9]];
        let cell = CellGeometry::new(&points);
        let value = |p: &[f64; 2]| 3.0 + 2.0 * p[0] - 5.0 * p[1];
        for (c, expected) in [2.0, -5.0].into_iter().enumerate() {
            let slope: f64 = (0..3).map(|i| value(&points[i]) * cell.gradients[i][c]).sum();
            assert!((slope - expected).abs() < 1e-13, "{slope} against {expected}");
        }
    }

    #[test]
    fn normals_close_the_boundary() {
        let cell = CellGeometry::new(&[[0.0, 0.0], [2.0, 0.1], [0.3, 1.7]]);
        for c in 0..2 {
            let sum: f64 = (0..3).map(|k| cell.facet_normal(k)).map(|(n, length)| n[c] * length).sum();
            assert!(sum.abs() < 1e-14);
        }
        let bar = CellGeometry::new(&[[1.0], [3.0]]);
        assert_eq!(bar.facet_normal(0), ([1.0], 1.0));
        assert_eq!(bar.facet_normal(1), ([-1.0], 1.0));
    }
}
