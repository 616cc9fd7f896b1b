//! The modes of a face, and wrenches through it.
//!
//! All changes of the moments of a face have three modes of their own, opposite forces along its edges, and the six
//! components of a wrench that rings of elements around its edges put through it. A wrench has the traction of least L²
//! norm, R/A + ω × (x − c) with the couple about the centroid c: it depends on neither numbering nor material. Its
//! moments are R/3 + (S⁻¹C) × r_p, with S = Σ(|r_p|² − r_p r_pᵀ) of the corners r_p from the centroid.

use nalgebra::Matrix3;
use percute_core::simd::lanes::Value;

/// A vector of numbers.
pub(super) type Vector<T> = [T; 3];

/// A resultant and a couple.
pub(super) type Wrench<T> = [Vector<T>; 2];

/// The edges of a face by the places of their nodes; edge t is opposite to the node at place t.
pub(super) const EDGES: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// The geometry of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct FaceModes {
    /// From the centroid to the nodes (m).
    arms: [[f64; 3]; 3],
    /// S⁻¹ (1/m²).
    inverse: [[f64; 3]; 3],
    /// Unit vectors along the edges.
    along: [[f64; 3]; 3],
    /// Whether it has modes of its own.
    pub(super) is_free: bool,
}

/// a × b.
#[inline(always)]
pub(super) fn cross<A, B, T>(a: &[A; 3], b: &[B; 3]) -> [T; 3]
where
    A: Copy + std::ops::Mul<B, Output = T>,
    B: Copy,
    T: std::ops::Sub<Output = T>,
{
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl FaceModes {
    /// Of a face with these nodes (m).
    pub(super) fn new(points: &[[f64; 3]; 3], is_free: bool) -> Self {
        let arms: [[f64; 3]; 3] = std::array::from_fn(|p| {
            std::array::from_fn(|c| points.iter().map(|q| points[p][c] - q[c]).sum::<f64>() / 3.0)
        });
        let square: f64 = arms.iter().flatten().map(|x| x * x).sum();
        let sum = |a: usize, b: usize| arms.iter().map(|r| r[a] * r[b]).sum::<f64>();
        let matrix = Matrix3::from_fn(|a, b| if a == b { square - sum(a, b) } else { -sum(a, b) });
        // Faces have an area.
        let inverse = matrix.try_inverse().unwrap_or_else(Matrix3::zeros);
        let along = EDGES.map(|[p, q]| {
            let side: [f64; 3] = std::array::from_fn(|c| points[q][c] - points[p][c]);
            let length = side.iter().map(|x| x * x).sum::<f64>().sqrt();
            side.map(|x| x / length)
        });
        Self { arms, inverse: std::array::from_fn(|a| std::array::from_fn(|b| inverse[(a, b)])), along, is_free }
    }

    /// The length of an edge (m).
    pub(super) fn length(&self, edge: usize) -> f64 {
        let [p, q] = EDGES[edge];
        (0..3).map(|c| (self.arms[q][c] - self.arms[p][c]).powi(2)).sum::<f64>().sqrt()
    }

    /// Adds a wrench about the middle of an edge, of which the couple is in units of `length` (m), to one about the
    /// centroid. The middle is at −½ of the arm of the opposite node.
    #[inline(always)]
    pub(super) fn add_wrench<T: Value>(
        &self,
        edge: usize,
        length: f64,
        [force, couple]: &Wrench<T>,
        to: &mut Wrench<T>,
    ) {
        let turned: [T; 3] = cross(force, &self.arms[edge]);
        for c in 0..3 {
            to[0][c] += force[c];
            to[1][c] += couple[c] * length + turned[c] * 0.5;
        }
    }

    /// The slope in a wrench about the middle of an edge, from that in one about the centroid.
    #[inline(always)]
    pub(super) fn slope_at_edge<T: Value>(&self, edge: usize, length: f64, [force, couple]: &Wrench<T>) -> Wrench<T> {
        let mut slope = [*force, *couple];
        let turned: [T; 3] = cross(couple, &self.arms[edge]);
        for c in 0..3 {
            slope[0][c] -= turned[c] * 0.5;
            slope[1][c] = couple[c] * length;
        }
        slope
    }

    /// S⁻¹ of a vector.
    #[inline(always)]
    pub(super) fn relax<T: Value>(&self, vector: &Vector<T>) -> Vector<T> {
        let mut product = [vector[0].zero(); 3];
        for a in 0..3 {
            for b in 0..3 {
                product[a] += vector[b] * self.inverse[a][b];
            }
        }
        product
    }

    /// The moments at place `p` of a wrench, of which the couple has been relaxed, and of the modes of the face.
    #[inline(always)]
    pub(super) fn moment<T: Value>(&self, p: usize, [force, turn]: &Wrench<T>, own: &Vector<T>) -> Vector<T> {
        let mut moment: [T; 3] = cross(turn, &self.arms[p]);
        // The edge that begins at the node, and the one that ends there.
        let (begins, ends) = ((p + 2) % 3, (p + 1) % 3);
        for c in 0..3 {
            moment[c] += force[c] * (1.0 / 3.0) + own[begins] * self.along[begins][c] - own[ends] * self.along[ends][c];
        }
        moment
    }

    /// The slopes in a wrench about the centroid and in the modes of the face, from those in its moments.
    #[inline(always)]
    pub(super) fn slopes<T: Value>(&self, moments: &[Vector<T>; 3]) -> (Wrench<T>, Vector<T>) {
        let zero = moments[0][0].zero();
        let (mut force, mut turn, mut own) = ([zero; 3], [zero; 3], [zero; 3]);
        for p in 0..3 {
            let turned: [T; 3] = cross(&moments[p], &self.arms[p]);
            for c in 0..3 {
                force[c] += moments[p][c] * (1.0 / 3.0);
                turn[c] -= turned[c];
            }
        }
        for (t, [p, q]) in EDGES.into_iter().enumerate() {
            for c in 0..3 {
                own[t] += (moments[p][c] - moments[q][c]) * self.along[t][c];
            }
        }
        ([force, self.relax(&turn)], own)
    }
}
