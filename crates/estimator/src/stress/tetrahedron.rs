//! The stress of a tetrahedron: the reference macro-element, mapped, with least complementary energy.

mod forms;
mod modes;
mod moment_forms;
mod quadratic;
mod reference;
mod residuals;

use super::{Loading, StressResiduals};
pub(crate) use forms::{TetrahedronForm, TetrahedronForms};
pub(crate) use moment_forms::MomentForms;
use nalgebra::{DMatrix, Matrix3};
use percute_core::material::LinearLaw;
use quadratic::NODES;
use reference::{ALL, FREE, LOADS, Products, ReferenceTetrahedron, at, component, reference_compliance, rows};
use residuals::ExactStress;

/// The map of one tetrahedron.
#[derive(Clone, Debug)]
pub(crate) struct TetrahedronStress {
    points: [[f64; 3]; 4],
    /// B, whose columns are the edges from node 0 to the others (m).
    map: Matrix3<f64>,
    /// B⁻¹, which takes tractions to the reference tetrahedron.
    inverse: Matrix3<f64>,
    /// J = 6|E|.
    jacobian: f64,
    /// The free stresses that each load brings about.
    free: [[f64; LOADS]; FREE],
}

impl TetrahedronStress {
    pub(crate) fn new(points: &[[f64; 3]; 4], law: &impl LinearLaw) -> Self {
        let map = Matrix3::from_fn(|c, k| points[k + 1][c] - points[0][c]);
        // Elements are not degenerate.
        let (jacobian, inverse) = (map.determinant(), map.try_inverse().unwrap_or_else(Matrix3::zeros));
        let free = least_energy(&reference_compliance(&rows(&map), law.compliance::<3>()));
        Self { points: *points, map, inverse, jacobian, free }
    }

    /// Loads on the reference tetrahedron.
    fn pull_back<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [f64; LOADS] {
        let mut loads = [0.0; LOADS];
        let volume = loading.volume.iter().map(|vector| (vector, self.jacobian));
        let vectors = loading.traction.iter().flatten().map(|vector| (vector, 1.0)).chain(volume);
        for (own, (vector, scale)) in loads.chunks_exact_mut(3).zip(vectors) {
            (0..3).for_each(|c| own[c] = scale * (0..3).map(|b| self.inverse[(c, b)] * vector[b]).sum::<f64>());
        }
        loads
    }

    /// The stress that balances a loading.
    fn stress<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> ExactStress {
        let loads = self.pull_back(loading);
        let free = |i: usize| -> f64 { self.free[i].iter().zip(&loads).map(|(a, b)| a * b).sum() };
        let parts: [f64; ALL] = std::array::from_fn(|i| if i < LOADS { loads[i] } else { free(i - LOADS) });
        let mut values = ReferenceTetrahedron::get().stress(&parts);
        for stress in values.as_chunks_mut::<6>().0 {
            let own = Matrix3::from_fn(|a, b| stress[component(a, b)]);
            let mapped = self.map * own * self.map.transpose() / self.jacobian;
            (0..3).for_each(|a| (0..=a).for_each(|b| stress[component(a, b)] = mapped[(a, b)]));
        }
        ExactStress { points: self.points, values }
    }

    /// Mean of (11, 22, 33, 23, 13, 12): a quadratic integrates to a fifth of its values in the middles of the edges
    /// less a twentieth of those at the corners, and the sub-tetrahedra are of one size.
    pub(crate) fn mean<const D: usize, const N: usize>(&self, loading: &Loading<D, N>) -> [f64; 6] {
        let values = self.stress(loading).values;
        let weight = |node: usize| if node < 4 { -0.05 } else { 0.2 };
        let of = |sub: usize, c: usize| (0..NODES).map(|node| weight(node) * values[at(sub, node, c)]).sum::<f64>();
        std::array::from_fn(|c| 0.25 * (0..4).map(|sub| of(sub, c)).sum::<f64>())
    }

    pub(crate) fn residuals<const D: usize, const N: usize>(
        &self,
        loading: &Loading<D, N>,
        floor: f64,
    ) -> StressResiduals {
        self.stress(loading).residuals(loading, floor)
    }
}

/// The free stresses of each load that minimise the energy with this form.
fn least_energy(form: &Products) -> [[f64; LOADS]; FREE] {
    let rows = &ReferenceTetrahedron::get().free_products;
    let entry = |i: usize, j: usize| rows[i][j].iter().zip(form).map(|(x, y)| x * y).sum::<f64>();
    let among = DMatrix::from_fn(FREE, FREE, |i, j| entry(i, LOADS + j));
    let with_loads = DMatrix::from_fn(FREE, LOADS, |i, j| -entry(i, j));
    // Any free stresses balance nothing, so that 0 would do.
    let free = among.lu().solve(&with_loads).unwrap_or_else(|| DMatrix::zeros(FREE, LOADS));
    std::array::from_fn(|i| std::array::from_fn(|j| free[(i, j)]))
}

#[cfg(test)]
mod tests;
