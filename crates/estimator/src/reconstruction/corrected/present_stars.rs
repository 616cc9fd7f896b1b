//! The deformation of the stars of contact nodes of a body that turns.

use crate::deformation::Deformation;
use percute_core::element_state::displacement_gradient;
use percute_core::problem::Problem;

/// F̄⁻¹ of the mean F of the elements around each contact node, and the places of the simulation.
#[derive(Clone, Debug)]
pub(super) struct PresentStars<'a, const D: usize> {
    /// Displacements of the simulation (m).
    pub(super) displacement: &'a [[f64; D]],
    stars: Vec<Deformation<D, f64>>,
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
            Deformation::new(&mean.map(|row| row.map(|x| x / volume)))
        };
        let stars = problem.surface().nodes().iter().map(|contact| star(contact.node)).collect();
        Self { displacement, stars }
    }

    /// F̄⁻¹ of a force on a contact node.
    pub(super) fn pull_back(&self, at: usize, force: &[f64; D]) -> [f64; D] {
        let mut pulled = *force;
        self.stars[at].pull_back(&mut pulled);
        pulled
    }
}
