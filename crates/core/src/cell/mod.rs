//! The elements: all that depends on the dimension.
//!
//! [`Cell`] is written once for each kind: [`Bar`], [`Triangle`] and [`Tetrahedron`]. A mesh stores its
//! [`CellKind`]; code that exists for some kinds only matches on it, so that a new kind does not compile before each of
//! these matches has its case.

mod bar;
mod tetrahedron;
mod triangle;

use std::any::Any;
use std::fmt::Debug;

/// The element of dimension `D` with `N` nodes, if [`Cell`] is written for it.
#[derive(Clone, Copy, Debug)]
pub struct Element<const D: usize, const N: usize>;

/// The 2-node bar.
pub type Bar = Element<1, 2>;
/// The 3-node triangle.
pub type Triangle = Element<2, 3>;
/// The 4-node tetrahedron.
pub type Tetrahedron = Element<3, 4>;

/// The kind of the elements of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// A line of two nodes.
    Bar,
    /// A plane triangle of three nodes.
    Triangle,
    /// A tetrahedron of four nodes.
    Tetrahedron,
}

impl CellKind {
    /// Of its space.
    #[inline]
    #[must_use]
    pub const fn dimension(self) -> usize {
        match self {
            Self::Bar => 1,
            Self::Triangle => 2,
            Self::Tetrahedron => 3,
        }
    }

    /// Number of its nodes.
    #[inline]
    #[must_use]
    pub const fn nodes(self) -> usize {
        match self {
            Self::Bar => 2,
            Self::Triangle => 3,
            Self::Tetrahedron => 4,
        }
    }
}

/// The element of this dimension with so many nodes.
///
/// # Panics
/// If [`Cell`] is not written for it.
#[inline]
#[must_use]
pub fn cell<const D: usize, const N: usize>() -> &'static dyn Cell<D, N> {
    const BAR: &dyn Cell<1, 2> = &Element;
    const TRIANGLE: &dyn Cell<2, 3> = &Element;
    const TETRAHEDRON: &dyn Cell<3, 4> = &Element;
    let all: [&dyn Any; 3] = [&BAR, &TRIANGLE, &TETRAHEDRON];
    let Some(found) = all.into_iter().find_map(|one| one.downcast_ref()) else {
        unreachable!("no element of dimension {D} with {N} nodes")
    };
    *found
}

/// Corners of a child in a refined element: a pair of equal nodes is that node, a pair of different nodes the middle
/// between them.
pub type Child<const N: usize> = [[usize; 2]; N];

/// Weight of three points of a triangle, and their two equal weights of nodes and the other one.
const TRIANGLE_POINTS: [(f64, f64, f64); 2] = [
    (0.223_381_589_678_011, 0.445_948_490_915_965, 0.108_103_018_168_070),
    (0.109_951_743_655_322, 0.091_576_213_509_771, 0.816_847_572_980_458),
];

/// Mean over a face of a quantity, given at the weights of the face's nodes: exact if it is quadratic on each piece
/// on which the linear `switch` with these nodal values keeps its sign. On a line, two Gauss points on each side of the
/// place where the sign changes. On a triangle six points, exact up to degree 4 without a change of sign: D. A.
/// Dunavant, High degree efficient symmetrical Gaussian quadrature rules for the triangle, Int. J. Numer. Meth. Engng
/// 21 (1985).
pub fn face_mean<const D: usize>(switch: &[f64; D], quantity: impl Fn(&[f64; D]) -> f64) -> f64 {
    let (first, last) = (switch[0], switch[D - 1]);
    if D == 1 {
        return quantity(&[1.0; D]);
    }
    if D == 3 {
        return TRIANGLE_POINTS
            .iter()
            .map(|(weight, near, far)| {
                let at = |k: usize| quantity(&std::array::from_fn(|i| if i == k { *far } else { *near }));
                weight * (at(0) + at(1) + at(2))
            })
            .sum();
    }
    let turn = if first * last < 0.0 { first / (first - last) } else { 1.0 };
    let gauss = 0.5 / 3.0_f64.sqrt();
    let mut mean = 0.0;
    for (from, to) in [(0.0, turn), (turn, 1.0)] {
        for at in [0.5 - gauss, 0.5 + gauss] {
            let s = from + at * (to - from);
            mean += 0.5 * (to - from) * quantity(&std::array::from_fn(|k| if k == 0 { 1.0 - s } else { s }));
        }
    }
    mean
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Bar {}
    impl Sealed for super::Triangle {}
    impl Sealed for super::Tetrahedron {}
}

/// One kind of element. Face k lies opposite to node k.
pub trait Cell<const D: usize, const N: usize>: sealed::Sealed + Debug + Send + Sync {
    /// Its kind.
    fn kind(&self) -> CellKind;

    /// Length (m), area (m²) or volume (m³), negative if the corners are in the wrong order.
    fn signed_volume(&self, points: &[[f64; D]; N]) -> f64;

    /// ∇φ_k (1/m) of a node other than the first, in an element of this volume.
    fn gradient(&self, points: &[[f64; D]; N], volume: f64, k: usize) -> [f64; D];

    /// Directions, of any length, one of which separates two elements if no line from corner to corner does.
    fn separating_directions(&self, a: &[[f64; D]; N], b: &[[f64; D]; N]) -> Vec<[f64; D]>;

    /// For each node, the first and the last face of the element at it, in counterclockwise order around the node; a
    /// bar has one of them, and a tetrahedron none, as no order goes around a node of a solid.
    fn faces_around(&self) -> [[Option<usize>; 2]; N];

    /// The part of a small circle or sphere around a point that an element has: an angle (rad) or solid angle (sr). The
    /// point is where the shape functions of these nodes alone are not 0. In a bar elements have equal parts, 1.
    fn angle_around(&self, points: &[[f64; D]; N], nodes: &[usize]) -> f64;

    /// The elements that an element is cut into by the middles of its edges.
    fn children(&self) -> &'static [Child<N>];

    /// The faces that a face is cut into by the middles of its edges.
    fn face_children(&self) -> &'static [Child<D>];

    /// Whether a point is in the element with these corners, positively oriented: with the point in place of a corner,
    /// no signed volume is below `least` (m, m² or m³).
    fn encloses(&self, corners: &[[f64; D]; N], point: &[f64; D], least: f64) -> bool {
        (0..N).all(|k| {
            let mut part = *corners;
            part[k] = *point;
            self.signed_volume(&part) >= least
        })
    }

    /// Volume and gradients of the element with these corners, positively oriented.
    fn geometry(&self, points: &[[f64; D]; N]) -> CellGeometry<D, N> {
        let volume = self.signed_volume(points);
        let mut gradients = [[0.0; D]; N];
        for k in 1..N {
            gradients[k] = self.gradient(points, volume, k);
        }
        for c in 0..D {
            gradients[0][c] = -(1..N).map(|k| gradients[k][c]).sum::<f64>();
        }
        CellGeometry { volume, gradients }
    }
}

/// Volume and shape-function gradients of a P1 simplex.
#[derive(Clone, Copy, Debug)]
pub struct CellGeometry<const D: usize, const N: usize> {
    /// Length (m), area (m²) or volume (m³), without section or thickness.
    pub volume: f64,
    /// ∇φ_i of each node (1/m); they sum to zero.
    pub gradients: [[f64; D]; N],
}

impl<const D: usize, const N: usize> CellGeometry<D, N> {
    /// Outward unit normal and measure of the face opposite to local node `k`: −∇φ_k/|∇φ_k| and D·|E|·|∇φ_k|.
    #[must_use]
    pub fn face_normal(&self, k: usize) -> ([f64; D], f64) {
        let norm = self.gradients[k].iter().map(|g| g * g).sum::<f64>().sqrt();
        (self.gradients[k].map(|g| -g / norm), D as f64 * self.volume * norm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_reproduce_a_linear_field() {
        let points = [[0.1, 0.2], [1.3, 0.4], [0.3, 0.9]];
        let cell = Triangle {}.geometry(&points);
        let value = |p: &[f64; 2]| 3.0 + 2.0 * p[0] - 5.0 * p[1];
        for (c, expected) in [2.0, -5.0].into_iter().enumerate() {
            let slope: f64 = (0..3).map(|i| value(&points[i]) * cell.gradients[i][c]).sum();
            assert!((slope - expected).abs() < 1e-13, "{slope} against {expected}");
        }
    }

    #[test]
    fn normals_close_the_boundary() {
        let cell = Triangle {}.geometry(&[[0.0, 0.0], [2.0, 0.1], [0.3, 1.7]]);
        for c in 0..2 {
            let sum: f64 = (0..3).map(|k| cell.face_normal(k)).map(|(n, length)| n[c] * length).sum();
            assert!(sum.abs() < 1e-14);
        }
        let bar = Bar {}.geometry(&[[1.0], [3.0]]);
        assert_eq!(bar.face_normal(0), ([1.0], 1.0));
        assert_eq!(bar.face_normal(1), ([-1.0], 1.0));
    }
}
