//! How well a piecewise stress of a tetrahedron satisfies its equations.

use super::quadratic::{
    OUTER, OUTER_SHARES, area_normal, barycentric_gradients, centroid, corners, inner_faces, load_share,
    outward_normal, quadratic_gradients,
};
use super::reference::{COEFFICIENTS, at, component};
use crate::residual::worse;
use crate::stress::{Loading, StressResiduals};

/// A stress that is quadratic on each of the four sub-tetrahedra.
#[derive(Clone, Debug)]
pub(super) struct ExactStress {
    /// Corners of the tetrahedron (m).
    pub(super) points: [[f64; 3]; 4],
    /// Stress at the nodes of the sub-tetrahedra (Pa).
    pub(super) values: [f64; COEFFICIENTS],
}

impl ExactStress {
    pub(super) fn residuals<const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        let largest = self.values.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        StressResiduals {
            divergence: self.divergence_residual(largest, loading, floor),
            edges: self.outer_residual(largest, loading, floor),
            inner: self.inner_residual(largest, floor),
        }
    }

    /// div σ − (Γ_DA − f_d) at the corners of the sub-tetrahedra: it is linear on each.
    fn divergence_residual<const D: usize, const N: usize>(
        &self,
        largest: f64,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> f64 {
        let (mut miss, mut scale, middle) = (0.0_f64, 0.0_f64, centroid(&self.points));
        let most_area = (0..4).fold(0.0_f64, |most, k| most.max(size(&outward_normal(k, &self.points))));
        for sub in 0..4 {
            let barycentric = barycentric_gradients(&corners(sub, &self.points, middle));
            let steepest = barycentric.iter().fold(0.0_f64, |m, gradient| m.max(size(gradient)));
            scale = scale.max(steepest * largest.max(floor / most_area));
            for corner in 0..4 {
                let mut balance = [0.0; 3];
                for (node, gradient) in quadratic_gradients(corner, &barycentric).iter().enumerate() {
                    let part = self.traction(sub, node, gradient);
                    (0..3).for_each(|c| balance[c] += part[c]);
                }
                for (c, balance) in balance.iter_mut().enumerate() {
                    for (i, volume) in loading.volume.iter().enumerate() {
                        *balance -= load_share(sub, corner, i) * volume[c];
                        scale = scale.max(volume[c].abs());
                    }
                    miss = worse(miss, balance.abs());
                }
            }
        }
        miss / scale.max(f64::MIN_POSITIVE)
    }

    /// |f|(σn − F̂) at the corners of each face and the middles between them.
    fn outer_residual<const D: usize, const N: usize>(&self, largest: f64, loading: &Loading<D, N>, floor: f64) -> f64 {
        let (mut miss, mut scale) = (0.0_f64, floor);
        for (sub, traction) in loading.traction.iter().enumerate() {
            let normal = outward_normal(sub, &self.points);
            scale = scale.max(largest * size(&normal));
            for (node, shares) in OUTER.into_iter().zip(OUTER_SHARES) {
                let found = self.traction(sub, node, &normal);
                for c in 0..3 {
                    let wanted: f64 = shares.iter().zip(traction).map(|(share, t)| share * t[c]).sum();
                    miss = worse(miss, (found[c] - wanted).abs());
                    scale = scale.max(wanted.abs());
                }
            }
        }
        miss / scale.max(f64::MIN_POSITIVE)
    }

    /// Jumps of |f|σn at the nodes of the inner faces.
    fn inner_residual(&self, largest: f64, floor: f64) -> f64 {
        let (mut miss, mut scale, middle) = (0.0_f64, floor, centroid(&self.points));
        for face in inner_faces() {
            let [a, b] = face.ends.map(|node| self.points[node]);
            let (normal, [(one, nodes), (other, others)]) = (area_normal([a, b, middle]), face.sides);
            scale = scale.max(largest * size(&normal));
            for (node, opposite) in nodes.into_iter().zip(others) {
                let (here, there) = (self.traction(one, node, &normal), self.traction(other, opposite, &normal));
                (0..3).for_each(|c| miss = worse(miss, (here[c] - there[c]).abs()));
            }
        }
        miss / scale.max(f64::MIN_POSITIVE)
    }

    /// σ n at a node of a sub-tetrahedron.
    fn traction(&self, sub: usize, node: usize, normal: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| (0..3).map(|b| self.values[at(sub, node, component(a, b))] * normal[b]).sum())
    }
}

/// The largest component.
fn size(vector: &[f64; 3]) -> f64 {
    vector.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
}
