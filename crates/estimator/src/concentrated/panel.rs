//! A sub-triangle of a cut star with the map of its stress.

use super::cut_star::SubTriangle;
use crate::stress::{Loading, MONOMIALS, TriangleStress};
use nalgebra::{Matrix3, SMatrix};
use percute_core::material::LinearLaw;

/// Loads of a sub-triangle: |e|F̂ at both nodes of three sides, two components each.
pub(super) const LOADS: usize = 12;

/// A square matrix of the loads of a sub-triangle.
pub(super) type Square = SMatrix<f64, LOADS, LOADS>;

/// A sub-triangle. Loads and displacements are side by side in the order of [`SubTriangle::sides`], and on each side in
/// the direction of its edge. The displacement of a side is the dual of its loads: its product with them is their work.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) triangle: SubTriangle,
    pub(super) map: TriangleStress,
    /// From displacements to loads, of which no resultant or moment is left: the stress needs no displacement inside.
    pub(super) stiffness: Square,
    /// Two forces, and the moment about the first corner over the size.
    pub(super) resultants: SMatrix<f64, 3, LOADS>,
    /// ∫mτ of unit loads for each monomial m about the node, rows (monomial, component 11, 22, 12).
    pub(super) moments: SMatrix<f64, { 3 * MONOMIALS }, LOADS>,
}

impl Panel {
    /// A sub-triangle with a weight of its energy ∫τ:K⁻¹τ.
    pub(super) fn new(triangle: SubTriangle, law: &impl LinearLaw, weight: f64) -> Self {
        let map = TriangleStress::new(&triangle.corners, law);
        let order = order(&triangle);
        let mut form = Square::zeros();
        for (column, &load) in order.iter().enumerate() {
            let unit: [f64; LOADS] = std::array::from_fn(|k| f64::from(u8::from(k == load)));
            let slope = map.traction_slope(&tractions(&unit));
            for (row, &k) in order.iter().enumerate() {
                form[(row, column)] = weight * slope[k / 4][k / 2 % 2][k % 2];
            }
        }
        let resultants = resultants(&triangle.corners);
        let resultants = SMatrix::from_fn(|row, column| resultants[(row, order[column])]);
        let stiffness = stiffness(&form, &resultants);
        let mut moments = SMatrix::<f64, { 3 * MONOMIALS }, LOADS>::zeros();
        for (column, &load) in order.iter().enumerate() {
            let unit = std::array::from_fn(|k| f64::from(u8::from(k == load)));
            let of_unit = map.piecewise(&tractions(&unit)).moments();
            moments.column_mut(column).copy_from_slice(of_unit.as_flattened());
        }
        Self { triangle, map, stiffness, resultants, moments }
    }

    /// From loads to those of one side with the same resultants.
    pub(super) fn to_side(&self, side: usize) -> SMatrix<f64, 4, LOADS> {
        let own = self.resultants.fixed_columns::<4>(4 * side);
        let gram: Matrix3<f64> = own * own.transpose();
        own.transpose() * gram.try_inverse().unwrap_or_else(Matrix3::zeros) * self.resultants
    }

    /// The loading by one column of loads.
    pub(super) fn loading(&self, loads: &[f64]) -> Loading<2, 3> {
        let mut by_face = [0.0; LOADS];
        order(&self.triangle).into_iter().zip(loads).for_each(|(k, load)| by_face[k] = *load);
        tractions(&by_face)
    }
}

/// The numbers of the loads among those of the faces.
fn order(triangle: &SubTriangle) -> [usize; LOADS] {
    let sides = triangle.sides();
    std::array::from_fn(|k| {
        let (face, reversed) = sides[k / 4];
        4 * face + 2 * ((k / 2 % 2) ^ usize::from(reversed)) + k % 2
    })
}

/// The inverse of the form of the energy among the loads in equilibrium.
fn stiffness(form: &Square, resultants: &SMatrix<f64, 3, LOADS>) -> Square {
    let gram: Matrix3<f64> = resultants * resultants.transpose();
    // Sub-triangles are not degenerate.
    let rigid = resultants.transpose() * gram.try_inverse().unwrap_or_else(Matrix3::zeros) * resultants;
    let kept = Square::identity() - rigid;
    let definite = kept * form * kept + rigid * (form.trace() / LOADS as f64);
    let inverse = definite.cholesky().map_or_else(Square::zeros, |factor| factor.inverse());
    let stiffness = kept * inverse * kept;
    0.5 * (stiffness + stiffness.transpose())
}

/// A loading by these tractions alone.
pub(super) fn tractions(loads: &[f64; LOADS]) -> Loading<2, 3> {
    let traction = std::array::from_fn(|k| std::array::from_fn(|p| [loads[4 * k + 2 * p], loads[4 * k + 2 * p + 1]]));
    Loading { traction, volume: [[0.0; 2]; 3] }
}

/// The resultants of the loads on the faces of a triangle: two forces, and the moment about its first corner over its
/// size.
fn resultants(corners: &[[f64; 2]; 3]) -> SMatrix<f64, 3, LOADS> {
    let size = (0..3).map(|k| (corners[k][0] - corners[(k + 1) % 3][0]).hypot(corners[k][1] - corners[(k + 1) % 3][1]));
    let size = size.fold(0.0, f64::max);
    let mut rows = SMatrix::zeros();
    for k in 0..3 {
        let node = |p: usize| corners[(k + 1 + p) % 3];
        for p in 0..2 {
            let arm: [f64; 2] =
                std::array::from_fn(|c| (node(p)[c] / 3.0 + node(1 - p)[c] / 6.0 - 0.5 * corners[0][c]) / size);
            let column = 4 * k + 2 * p;
            rows[(0, column)] = 0.5;
            rows[(1, column + 1)] = 0.5;
            rows[(2, column)] = -arm[1];
            rows[(2, column + 1)] = arm[0];
        }
    }
    rows
}
