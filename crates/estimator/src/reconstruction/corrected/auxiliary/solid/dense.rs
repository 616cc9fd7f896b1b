//! Matrices of a small solid, by the definitions of strains and means.

use crate::element::elements;
use nalgebra::{DMatrix, DVector};
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::{Law, LinearLaw};
use percute_core::problem::Problem;
use std::collections::BTreeMap;

/// The pairs of axes of the strains, of which shear strains are twice the components.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];

/// β.
const NODES: f64 = 0.2;

/// A plane of symmetry across an axis at a place (m).
pub(super) type MirrorPlane = (usize, f64);

/// Rows and columns are components of nodes.
pub(super) struct DenseSolid {
    pub(super) mass: DVector<f64>,
    /// 1/m, 0 on prescribed components.
    pub(super) inverse_mass: DMatrix<f64>,
    pub(super) stiffness: DMatrix<f64>,
    /// K_s.
    pub(super) smoothed: DMatrix<f64>,
    /// μ.
    pub(super) lumping: DMatrix<f64>,
}

impl DenseSolid {
    pub(super) fn new(problem: &Problem<3>, mirrors: &[MirrorPlane]) -> Self {
        let (size, elements) = (3 * problem.mesh().node_count(), elements::<3, 4>(problem));
        let (strains, means) = (strains(problem), means(problem, mirrors));
        let mut stress = DMatrix::zeros(6 * elements.len(), 6 * elements.len());
        let mut consistent = DMatrix::zeros(size, size);
        for (e, element) in elements.iter().enumerate() {
            let law = problem.material(ElementId::new(e));
            let (lambda, shear) = law.moduli();
            for k in 0..6 {
                (0..3).filter(|_| k < 3).for_each(|l| stress[(6 * e + k, 6 * e + l)] = element.volume * lambda);
                stress[(6 * e + k, 6 * e + k)] += element.volume * if k < 3 { 2.0 * shear } else { shear };
            }
            for (a, b, c) in (0..4).flat_map(|a| (0..4).flat_map(move |b| (0..3).map(move |c| (a, b, c)))) {
                let (row, column) = (3 * element.nodes[a].index() + c, 3 * element.nodes[b].index() + c);
                let part = if a == b { 0.1 } else { 0.05 };
                consistent[(row, column)] += part * law.density() * element.volume;
            }
        }
        let mass = DVector::from_fn(size, |i, _| problem.mass()[i / 3]);
        let mut inverse_mass = DMatrix::from_diagonal(&mass.map(|m| 1.0 / m));
        for p in problem.prescribed() {
            let i = 3 * p.node.index() + p.component;
            inverse_mass[(i, i)] = 0.0;
        }
        let lumping = &inverse_mass * (DMatrix::from_diagonal(&mass) - consistent);
        let slopes = strains.transpose() * &stress;
        let (stiffness, smoothed) = (&slopes * &strains, slopes * means * strains);
        Self { mass, inverse_mass, stiffness, smoothed, lumping }
    }

    /// The operator −a of displacements without forces, damping apart, with p(μ) − Δt²/12 M⁻¹K.
    pub(super) fn acceleration(&self, [first, second, third]: [f64; 3], square: f64) -> DMatrix<f64> {
        let (mu, size) = (&self.lumping, self.mass.len());
        let free = &self.inverse_mass * DMatrix::from_diagonal(&self.mass);
        let p = DMatrix::identity(size, size) + mu * first + mu * mu * second + mu * mu * mu * third;
        &free
            * (p - &self.inverse_mass * &self.stiffness * (square / 12.0))
            * &self.inverse_mass
            * &self.smoothed
            * free
    }

    /// Largest absolute eigenvalue of a step of Δt with damping ζΔt_c (s), of displacements and velocities.
    pub(super) fn radius(&self, mass: [f64; 3], step: f64, damping: f64) -> f64 {
        let size = self.mass.len();
        let operator = self.acceleration(mass, step * step) * (step * step);
        let damping = &self.inverse_mass * (&self.stiffness - &self.smoothed) * (step * damping);
        let (one, mut all) = (DMatrix::identity(size, size), DMatrix::zeros(2 * size, 2 * size));
        let kept = &one - damping;
        all.view_mut((0, 0), (size, size)).copy_from(&(&one - &operator));
        all.view_mut((0, size), (size, size)).copy_from(&kept);
        all.view_mut((size, 0), (size, size)).copy_from(&-operator);
        all.view_mut((size, size), (size, size)).copy_from(&kept);
        all.complex_eigenvalues().iter().fold(0.0, |largest, value| largest.max(value.norm()))
    }
}

/// The strains of elements of displacements.
fn strains(problem: &Problem<3>) -> DMatrix<f64> {
    let elements = elements::<3, 4>(problem);
    let mut strains = DMatrix::zeros(6 * elements.len(), 3 * problem.mesh().node_count());
    for (e, element) in elements.iter().enumerate() {
        for (node, gradient) in element.nodes.iter().zip(&element.gradients) {
            for (k, [a, b]) in PAIRS.into_iter().enumerate() {
                strains[(6 * e + k, 3 * node.index() + a)] += gradient[b] / element.volume;
                if a != b {
                    strains[(6 * e + k, 3 * node.index() + b)] += gradient[a] / element.volume;
                }
            }
        }
    }
    strains
}

/// The smoothed strains of elements of their strains.
fn means(problem: &Problem<3>, mirrors: &[MirrorPlane]) -> DMatrix<f64> {
    let (mesh, count) = (problem.mesh(), problem.mesh().element_count());
    let mut patches: BTreeMap<(Vec<NodeId>, u16), Vec<usize>> = BTreeMap::new();
    for e in 0..count {
        let (mut cell, law) = (mesh.nodes_of::<4>()[e], problem.element_material()[e]);
        cell.sort();
        for i in 0..4 {
            patches.entry((vec![cell[i]], law)).or_default().push(e);
            (0..i).for_each(|j| patches.entry((vec![cell[j], cell[i]], law)).or_default().push(e));
        }
    }
    let mut means = DMatrix::zeros(6 * count, 6 * count);
    for ((nodes, _), of) in &patches {
        let weight = if nodes.len() == 1 { NODES / 4.0 } else { (1.0 - NODES) / 6.0 };
        let in_plane = |(axis, place): &MirrorPlane| {
            nodes.iter().all(|node| (mesh.points_in::<3>()[node.index()][*axis] - place).abs() < 1e-12)
        };
        let across: Vec<usize> = mirrors.iter().filter(|plane| in_plane(plane)).map(|plane| plane.0).collect();
        let volume = |e: &usize| problem.volume(ElementId::new(*e));
        let whole: f64 = of.iter().map(volume).sum();
        for (to, from) in of.iter().flat_map(|to| of.iter().map(move |from| (to, from))) {
            for (k, [a, b]) in PAIRS.into_iter().enumerate() {
                if a == b || !(across.contains(&a) || across.contains(&b)) {
                    means[(6 * to + k, 6 * from + k)] += weight * volume(from) / whole;
                }
            }
        }
    }
    means
}
