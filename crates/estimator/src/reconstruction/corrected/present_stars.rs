//! The deformation of the stars of contact nodes of a body that turns, and their rotation.

use crate::deformation::Deformation;
use percute_core::element_state::{displacement_gradient, stretches};
use percute_core::material::Tensor;
use percute_core::problem::Problem;

/// F̄⁻¹ of the mean F of the elements around each contact node, and the places of the simulation.
#[derive(Clone, Debug)]
pub(super) struct PresentStars<'a, const D: usize> {
    /// Displacements of the simulation (m).
    pub(super) displacement: &'a [[f64; D]],
    stars: Vec<Deformation<D, f64>>,
    /// R of F̄ = RU.
    rotations: Vec<Tensor<D>>,
    /// The principal value of U − 1 that is largest without its sign.
    strains: Vec<f64>,
}

impl<'a, const D: usize> PresentStars<'a, D> {
    /// From the displacements of the simulation and those that are balanced (m).
    pub(super) fn new(problem: &Problem<D>, displacement: &'a [[f64; D]], balanced: &[[f64; D]]) -> Self {
        let mesh = problem.mesh();
        let star = |node| {
            let (mut mean, mut volume) = ([[0.0; D]; D], 0.0);
            for &element in mesh.stars().star(node).elements {
                let (own, gradient) = (problem.volume(element), displacement_gradient(mesh, element, balanced));
                volume += own;
                (0..D).for_each(|a| (0..D).for_each(|b| mean[a][b] += own * gradient[a][b]));
            }
            mean.map(|row| row.map(|x| x / volume))
        };
        let means = problem.surface().nodes().iter().map(|contact| star(contact.node));
        let means: Vec<_> = means.collect();
        Self {
            displacement,
            stars: means.iter().map(Deformation::new).collect(),
            rotations: means.iter().map(rotation).collect(),
            strains: means.iter().map(strain).collect(),
        }
    }

    /// The rotation of the star of a contact node.
    pub(super) fn rotation(&self, at: usize) -> &Tensor<D> {
        &self.rotations[at]
    }

    /// The principal value of U − 1 of a star that is largest without its sign.
    pub(super) fn strain(&self, at: usize) -> f64 {
        self.strains[at]
    }

    /// R v.
    pub(super) fn turn(&self, at: usize, vector: &[f64; D]) -> [f64; D] {
        self.rotations[at].map(|row| row.iter().zip(vector).map(|(r, v)| r * v).sum())
    }

    /// Rᵀ v.
    pub(super) fn turn_back(&self, at: usize, vector: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|c| (0..D).map(|d| self.rotations[at][d][c] * vector[d]).sum())
    }

    /// F̄⁻¹ of a force on a contact node.
    pub(super) fn pull_back(&self, at: usize, force: &[f64; D]) -> [f64; D] {
        let mut pulled = *force;
        self.stars[at].pull_back(&mut pulled);
        pulled
    }
}

/// R of F = 1 + H = RU: in the plane, with the angle of (F₁₁ + F₂₂, F₂₁ − F₁₂).
fn rotation<const D: usize>(gradient: &Tensor<D>) -> Tensor<D> {
    let mut rotation = [[1.0; D]; D];
    if D == 2 {
        let (sum, difference) = (2.0 + gradient[0][0] + gradient[1][1], gradient[1][0] - gradient[0][1]);
        let length = sum.hypot(difference);
        let (cosine, sine) = (sum / length, difference / length);
        (rotation[0][0], rotation[1][1], rotation[1][0], rotation[0][1]) = (cosine, cosine, sine, -sine);
    }
    rotation
}

/// The principal value of U − 1 that is largest without its sign.
fn strain<const D: usize>(gradient: &Tensor<D>) -> f64 {
    let stretches = if D == 1 { [1.0 + gradient[0][0]; 2] } else { stretches(gradient) };
    stretches.into_iter().map(|stretch| (stretch - 1.0).abs()).fold(0.0, f64::max)
}
